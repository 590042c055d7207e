"""A cluster loses workers, its scheduler, its network: the files are those of -w 1, byte for byte.

Schedulers and workers are Dask's own commands, on the loopback.
"""

import json
import random
import re
import sys
import threading
import time

import pytest

from clusters import (
    Cable,
    Cluster,
    certificates,
    free_port,
    frozen,
    port_of,
    registered,
    shortened,
    slowed,
    until,
)
from running import experiment, finish, one_sentence, same, start

pytest.importorskip("distributed")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals"),
]

GENERATION = re.compile(r"generation (\d+) ")
POPULATIONS = re.compile(r"S5(Fit)?G\d+\.npy")
LIMIT = 900
"""Seconds that a disturbed run may take."""

# Generations of some tenths of a second each, so that faults meet them in the middle.
EXPERIMENTS = {
    "acrobot": (100, {"samplesize": 3000, "episodes": 3, "saveeach": 0, "maxmsteps": 9000}),
    "discrim": (30, {"samplesize": 700, "saveeach": 0, "maxmsteps": 9000}),
    "predprey": (12, {"popsize": 8, "selsize": 4, "samplesize": 16, "maxsteps": 200}),
    "hopper": (30, {"samplesize": 40, "saveeach": 0, "maxsteps": 200}),
}
"""By their file in data/experiments: generations, and what is changed."""


class Evolving:
    """`botschool es` on a cluster, and how far it has come."""

    def __init__(self, ini, folder, where, generations, *arguments, **options) -> None:
        self.arguments = (
            *("es", "-f", ini, "-s", 5, "-o", folder, "--generations", generations),
            *("--cluster", where, *arguments),
        )
        self._options = options
        self.begin()

    def begin(self, *more) -> None:
        """Starts it; again after it has ended, with `--resume`."""
        self.process = start(*self.arguments, *more, **self._options)
        self.generation = 0
        self._watchdog = threading.Timer(LIMIT, self.process.kill)
        self._watchdog.daemon = True
        self._watchdog.start()

    def reach(self, generation: int) -> bool:
        """Reads until so many generations are done; false if it has ended before."""
        while self.generation < generation:
            line = self.process.stdout.readline()
            if not line:
                return False
            if found := GENERATION.search(line):
                self.generation = int(found[1])
        return True

    def finish(self):
        """(exit code, the rest of standard output, standard error)."""
        try:
            out = self.process.stdout.read()  # communicate() loses what readline() has read ahead
            code, rest, errors = finish(self.process, LIMIT)
            return code, out + rest, errors
        finally:
            self._watchdog.cancel()

    def done(self) -> None:
        """Waits for its end, which must be a success, and not this machine's alone."""
        code, out, errors = self.finish()
        assert code == 0, errors
        assert "\nworker t" in f"\n{out}", out


@pytest.fixture(scope="module")
def undisturbed(tmp_path_factory):
    """Gives experiment file, generations, and the folder of its run with `-w 1`; each run once."""
    made = {}

    def run(name):
        if name not in made:
            if name == "hopper":
                pytest.importorskip("pybullet_envs_gymnasium")
            folder = tmp_path_factory.mktemp(name)
            generations, changes = EXPERIMENTS[name]
            ini = shortened(name, folder, **changes)
            made[name] = ini, generations, folder / "w1"
            arguments = ("-s", 5, "--generations", generations, "-w", 1, "-o", folder / "w1")
            code, _, errors = finish(start("es", "-f", ini, *arguments), LIMIT)
            assert code == 0, errors
        return made[name]

    return run


def test_the_probe_of_a_worker_has_an_environment_of_its_own(monkeypatch, tmp_path):
    """It breaks episodes off, which PyBullet's next one in the same world can show."""
    from botschool import problems
    from botschool.cluster import worker
    from botschool.config import to_dict

    asked = []

    def of(given, made=problems.of):
        problem = made(given)
        evaluate = problem.evaluate
        problem.evaluate = lambda *rest: (asked.append(problem), evaluate(*rest))[1]
        return problem

    own = json.dumps(to_dict(experiment(tmp_path, "CartPole-v1", "OpenAI-ES")))
    monkeypatch.setattr(problems, "of", of)
    worker._made.cache_clear()
    worker.hello({"experiment": own, "files": {}})
    evaluates, _ = worker._made(own)
    assert asked and evaluates not in asked


long = pytest.mark.long  # what is short is in test_cluster.py and test_cluster_files.py


# each experiment, on each kind of cluster

every_experiment = pytest.mark.parametrize("name", EXPERIMENTS)


@long
@every_experiment
@pytest.mark.parametrize("workers", [2, 4])
def test_local_workers_do_not_show(name, workers, undisturbed, tmp_path):
    ini, generations, whole = undisturbed(name)
    Evolving(ini, tmp_path / "run", f"local:{workers}", generations).done()
    assert same(whole, tmp_path / "run")


@long
@every_experiment
def test_workers_that_come_and_go_by_tls_do_not_show(name, undisturbed, tmp_path):
    ini, generations, whole = undisturbed(name)
    tls = certificates(tmp_path / "tls")
    with Cluster(tmp_path / "cluster", tls) as cluster:
        cluster.start_workers(1)
        evolving = Evolving(
            ini, tmp_path / "run", cluster.address, generations, env=cluster.environment
        )
        changes = 0
        for generation in range(2, generations, generations // 6):
            if not evolving.reach(generation):
                break
            with frozen(evolving.process):  # it would be done before they are there
                came = registered(cluster.start_worker(threads=1 + changes % 2))
            [first, *_] = cluster.workers
            assert first is not came
            first.stop()
            changes += 1
        evolving.done()
        assert changes >= 4
    assert same(whole, tmp_path / "run")


KILLED_WORKERS, KILLED_SCHEDULERS = 20, 5


@long
@every_experiment
def test_kills_do_not_show(name, undisturbed, tmp_path):
    """20 times `kill -9` of a worker and 5 times of the scheduler, at random moments."""
    ini, generations, whole = undisturbed(name)
    chance = random.Random(name)
    faults = ["worker"] * KILLED_WORKERS + ["scheduler"] * KILLED_SCHEDULERS
    chance.shuffle(faults)
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(2)
        evolving = Evolving(ini, tmp_path / "run", cluster.address, generations)
        for number, fault in enumerate(faults):
            at = 1 + number * (generations - 2) // len(faults)
            assert evolving.reach(at), f"ended before fault {number}, a {fault}"
            time.sleep(chance.uniform(0, 0.3))
            if fault == "worker":
                chance.choice(cluster.workers).kill()
                with frozen(evolving.process):  # else it would be done too soon
                    cluster.start_workers(1)
            else:
                kill_scheduler(cluster, evolving, gives_up=number % 2 == 0)
        evolving.done()
    for each in (tmp_path / "run").iterdir():
        if POPULATIONS.fullmatch(each.name) and not (whole / each.name).exists():
            each.unlink()  # a co-evolution that is stopped keeps those of that generation, too
    assert same(whole, tmp_path / "run")


def kill_scheduler(cluster, evolving, gives_up) -> None:
    """The run waits for it, or is ended, and resumed when it is there again."""
    cluster.scheduler.kill()
    if gives_up:
        evolving.process.terminate()
        code, _, errors = evolving.finish()
        assert code == 130, errors
    for worker in cluster.workers:
        worker.kill()
    cluster.start_scheduler()
    cluster.start_workers(2)
    if gives_up:
        evolving.begin("--resume")


@long
def test_a_scheduler_that_does_not_come_back(undisturbed, tmp_path):
    """One sentence and a whole checkpoint, with which this machine goes on alone."""
    ini, generations, whole = undisturbed("acrobot")
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(1)
        where = cluster.address, generations, "--patience", 0.1
        evolving = Evolving(ini, tmp_path / "run", *where)
        assert evolving.reach(3)
        cluster.scheduler.kill()
        code, _, errors = evolving.finish()
        one_sentence(code, errors, ["scheduler", cluster.address, "--resume"])
    arguments = ("-s", 5, "--generations", generations, "-o", tmp_path / "run", "--resume")
    code, _, errors = finish(start("es", "-f", ini, *arguments), LIMIT)
    assert code == 0, errors
    assert same(whole, tmp_path / "run")


# one kind of fault each, on Acrobot


@pytest.fixture
def evolving_on(undisturbed, tmp_path):
    """Starts a run of Acrobot on a cluster; at the end its files must be the undisturbed ones."""
    ini, generations, whole = undisturbed("acrobot")

    def begin(where, **options):
        return Evolving(ini, tmp_path / "run", where, generations, **options)

    yield begin
    assert same(whole, tmp_path / "run")


@long
def test_a_worker_that_stands_still(evolving_on, tmp_path):
    """It answers no more but keeps its connections, as a machine whose memory is full."""
    with Cluster(tmp_path / "cluster") as cluster:
        first, _ = cluster.start_workers(2)
        evolving = evolving_on(cluster.address)
        assert evolving.reach(3)
        with frozen(first.process):
            evolving.done()


@long
def test_a_worker_that_stood_still_goes_on(evolving_on, tmp_path):
    """What it finishes late is what another one has finished before."""
    with Cluster(tmp_path / "cluster", **IMPATIENT) as cluster:
        first, _ = cluster.start_workers(2)
        evolving = evolving_on(cluster.address, env=cluster.environment)
        for generation in (3, 20):
            assert evolving.reach(generation)
            assert evolving.process.poll() is None  # it goes on, so this one is missed
            with frozen(first.process):
                time.sleep(8)
        evolving.done()


IMPATIENT = {"DASK_DISTRIBUTED__SCHEDULER__WORKER_TTL": "5s"}
"""Dask gives a worker up after five minutes; here after five seconds."""


@long
def test_a_slow_worker(evolving_on, tmp_path):
    """It has a tenth of its time."""
    with Cluster(tmp_path / "cluster") as cluster:
        first, _ = cluster.start_workers(2)
        evolving = evolving_on(cluster.address)
        assert evolving.reach(3)
        with slowed(first):
            evolving.done()


@long
def test_a_worker_whose_disk_is_full(evolving_on, tmp_path):
    """From one moment on, and from the beginning."""
    with Cluster(tmp_path / "cluster") as cluster:
        first, _ = cluster.start_workers(2)
        evolving = evolving_on(cluster.address)
        assert evolving.reach(3)
        first.full_disk()
        late = cluster.start_worker()
        late.full_disk()
        evolving.done()
        assert first.alive


@long
def test_a_local_directory_that_cannot_be_written(evolving_on, tmp_path):
    """Such a worker does not start; the others do not mind."""
    place = tmp_path / "file"
    place.touch()
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(1)
        evolving = evolving_on(cluster.address)
        broken = cluster.start_worker("--local-directory", place)
        until(lambda: not broken.alive, "it works on a folder that is a file", broken)
        evolving.done()


OTHER_VERSION = """
import botschool
botschool.__version__ = "0.0.1"
"""


def of_another_version(cluster, folder):
    """A worker whose botschool says it is of another version."""
    folder.mkdir()
    (folder / "sitecustomize.py").write_text(OTHER_VERSION)
    path = f"{folder}:{cluster.environment['PYTHONPATH']}"
    return registered(cluster.start_worker(PYTHONPATH=path))


@long
def test_a_worker_with_another_version_takes_no_part(evolving_on, tmp_path):
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(1)
        of_another_version(cluster, tmp_path / "before")
        evolving = evolving_on(cluster.address)
        assert evolving.reach(3)
        of_another_version(cluster, tmp_path / "late")
        code, out, errors = evolving.finish()
        assert code == 0, errors
        assert "is left out: it has botschool 0.0.1" in out


CUT = 60
"""Seconds."""


@long
def test_the_network_of_a_worker_is_cut_for_a_minute(evolving_on, tmp_path):
    """Everything between it and the others; nobody is told."""
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(1)
        port = free_port()
        to_scheduler, to_worker = Cable(port_of(cluster.address)), Cable(port)
        far = cluster.start_worker(
            *("--listen-address", f"tcp://127.0.0.1:{port}"),
            *("--contact-address", f"tcp://127.0.0.1:{to_worker.port}"),
            address=f"tcp://127.0.0.1:{to_scheduler.port}",
        )
        registered(far)
        evolving = evolving_on(cluster.address)
        assert evolving.reach(3)
        with to_scheduler.cut(), to_worker.cut():
            time.sleep(CUT)
        evolving.done()


@long
@pytest.mark.parametrize("how", ["cut", "broken"])
def test_the_network_of_the_command_is_cut_for_a_minute(how, undisturbed, tmp_path):
    """It goes on, or says so and is resumed."""
    ini, generations, whole = undisturbed("acrobot")
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(2)
        cable = Cable(port_of(cluster.address))
        address = f"tcp://127.0.0.1:{cable.port}"
        evolving = Evolving(ini, tmp_path / "run", address, generations)
        assert evolving.reach(3)
        with getattr(cable, how)():
            time.sleep(CUT)
        code, _, errors = evolving.finish()
        if code:
            one_sentence(code, errors, "--resume")
            evolving.begin("--resume")
            evolving.done()
    assert same(whole, tmp_path / "run")


@long
def test_what_a_cluster_has_left_one_machine_finishes(undisturbed, tmp_path):
    """And what one machine has left, a cluster."""
    ini, generations, whole = undisturbed("acrobot")
    run = tmp_path / "run"
    arguments = ("es", "-f", ini, "-s", 5, "-o", run, "--resume", "--generations")
    with Cluster(tmp_path / "cluster") as cluster:
        cluster.start_workers(1)
        for until_generation, where in (
            (generations // 4, ("--cluster", cluster.address)),
            (generations // 2, ("-w", 2)),
            (3 * generations // 4, ("--cluster", cluster.file)),
            (generations, ()),
        ):
            code, _, errors = finish(start(*arguments, until_generation, *where), LIMIT)
            assert code == 0, errors
    assert same(whole, run)
