"""--cluster: real schedulers and workers on the loopback, and the same bits as on this machine."""

import json
import re
import sys
from contextlib import closing
from types import SimpleNamespace

import numpy as np
import psutil
import pytest

from botschool.cluster.address import is_this_machine, place
from botschool.errors import BotschoolError
from botschool.problems import Episodes, Outcome
from running import call, environment_of_command, finish, same, start, write_experiment

pytest.importorskip("distributed")

from botschool.cluster import PATIENCE, chunks, connection, crew

pytestmark = pytest.mark.slow

EVERYTHING = {"DASK_BOTSCHOOL__SHORTEST": "0"}
"""Even the shortest batches go to the workers."""


def evolved(folder, path, *arguments, **variables):
    """What `botschool es` prints."""
    code, out, errors = call(
        *("es", "-f", path, "-s", 5, "-o", folder, *arguments),
        env=environment_of_command(**variables),
    )
    assert code == 0 and not errors, errors
    return out


def test_acrobot_has_the_same_files_on_a_cluster(tmp_path):
    path = write_experiment(
        tmp_path, "Acrobot-v1", "OpenAI-ES", {"normalize": 1}, samplesize=40, maxmsteps=0.1
    )
    evolved(tmp_path / "one", path)
    out = evolved(tmp_path / "two", path, "--cluster", "local:2", **EVERYTHING)
    assert same(tmp_path / "one", tmp_path / "two")
    assert len(re.findall(r"^worker tcp://127\.0\.0\.1:\d+: .* steps/s$", out, re.M)) == 2
    assert re.search(r"^time of the workers: evaluation \d+ %", out, re.M)


@pytest.mark.long
def test_predators_and_prey_have_the_same_files_on_a_cluster(tmp_path):
    path = write_experiment(
        *(tmp_path, "ErPredprey", "coevo2"),
        {"nrobots": 2, "heterogeneous": 1, "pepisodes": 1, "episodes": 1},
        popsize=4,
        selsize=2,
        samplesize=2,
        ngenerations=3,
        saveeach=1,
    )
    path.write_text(path.read_text().replace("maxmsteps = 0.005\n", ""))
    evolved(tmp_path / "one", path)
    evolved(tmp_path / "two", path, "--cluster", "local:2", **EVERYTHING)
    assert same(tmp_path / "one", tmp_path / "two")

    def tournament(*arguments):
        picture = tmp_path / f"{len(arguments)}.png"
        code, out, errors = call(
            *("tournament", tmp_path / "one", "-f", path, "-o", picture, *arguments),
            env=environment_of_command(**EVERYTHING),
        )
        assert code == 0 and not errors, errors
        return out.replace(str(picture.with_suffix("")), ""), picture.with_suffix(
            ".csv"
        ).read_text()

    assert tournament() == tournament("--cluster", "local:2")


def test_a_killed_worker_leaves_no_trace(tmp_path):
    path = write_experiment(
        tmp_path, "Acrobot-v1", "OpenAI-ES", {"maxsteps": 500}, samplesize=400, maxmsteps=4
    )
    evolved(tmp_path / "one", path)
    run = start(
        *("es", "-f", path, "-s", 5, "-o", tmp_path / "two", "--cluster", "local:2"),
        env=environment_of_command(**EVERYTHING),
    )
    while "generation 1 " not in (line := run.stdout.readline()):
        assert line
    workers = [p for p in psutil.Process(run.pid).children() if "spawn_main" in str(p.cmdline())]
    workers[0].kill()
    code, _, errors = finish(run)
    assert code == 0 and not errors, errors
    assert len(workers) == 2 and same(tmp_path / "one", tmp_path / "two")


def workers(*paces):
    """A crew without a connection, of ready workers with these paces."""
    found = crew.Crew.__new__(crew.Crew)
    found._native, found._least = False, 0.0
    found._workers = {
        str(number): crew.Worker(str(number), 1, ready=True, pace=pace)
        for number, pace in enumerate(paces)
    }
    return found


def test_chunks_cover_a_batch_once_and_keep_its_order():
    episodes = Episodes.of(np.arange(50), 3)
    genotypes = np.arange(100.0).reshape(50, 2)
    batch, these = chunks.Batch(genotypes, None, episodes, 10), workers(100.0, 300.0)
    taken = []
    while batch.waiting:
        taken.append(these._next(these.ready[len(taken) % 2], batch))
    assert sum(chunk.stop - chunk.start for chunk in taken) == 150 and len(taken) > 4
    batch.give_back(taken[1])
    assert batch.take(1) == taken[1]
    for chunk in reversed(taken):
        sent, _, those, _ = batch.arguments(chunk)
        assert (sent[those.candidate] == genotypes[episodes.candidate[chunk]]).all()
        steps = np.arange(chunk.start, chunk.stop, dtype=np.int32)
        assert not batch.over.is_set()
        batch.enter(chunk, Outcome(steps * 2.0, steps))
        batch.give_back(chunk)
    assert batch.over.is_set() and not batch.waiting
    assert (batch.outcome().fitness == 2.0 * np.arange(150)).all()


def test_an_idle_worker_gets_a_late_chunk_too(monkeypatch):
    """Late is three times the expected duration, and the second time twice that."""
    now = 0.0
    monkeypatch.setattr(chunks.time, "monotonic", lambda: now)
    these, batch = workers(10.0, 10.0), chunks.Batch([], None, Episodes.of(np.arange(40), 1), 10)
    one, two = these.ready
    chunk = these._next(one, batch)
    one.ahead = chunk.stop - chunk.start
    rest = [these._next(two, batch) for _ in range(20) if batch.waiting]
    for each in rest:
        batch.enter(each, Outcome(np.zeros(each.stop - each.start), np.zeros(1, np.int32)))
    for later, given in ((3.8, None), (0.2, chunk), (7.7, None), (0.2, chunk)):
        now += later
        assert these._next(one, batch) is None
        assert these._next(two, batch) == given
    assert list(batch.idle) == ["1"]


def test_a_chunk_that_workers_do_not_survive_ends_the_evaluation():
    batch = chunks.Batch([], None, Episodes.of(np.arange(40), 1), 10)
    for _ in range(chunks.LOSSES):
        assert not batch.over.is_set()
        batch.give_back(batch.take(40))
    assert batch.over.is_set()
    with pytest.raises(BotschoolError, match="were lost 10 times"):
        batch.outcome()


def test_no_worker_is_given_more_than_its_share():
    """However many chunks it has at a time: whoever has more than that is waited for."""
    batch, these = chunks.Batch([], None, Episodes.of(np.arange(800), 1), 10), workers(300.0, 100.0)
    quick, slow = these.ready
    for worker in (quick, slow) * 4:
        chunk = these._next(worker, batch)
        worker.ahead += chunk.stop - chunk.start
    assert quick.ahead <= 600 and slow.ahead <= 200 and quick.ahead + slow.ahead > 700


def test_a_short_chunk_says_little_of_a_workers_speed():
    worker = crew.Worker("", 1)
    worker.measured(200, 2000, 2.0)
    assert worker.pace == 100 and worker.steps == 1000
    worker.measured(1, 10, 0.05)
    assert 95 < worker.pace < 99
    worker.measured(20, 200, 10.0)
    assert 2 < worker.pace < 2.1 and 20 < worker.steps < 21


@pytest.mark.parametrize(
    ("host", "own"),
    [
        ("127.0.0.1", True),
        ("localhost", True),
        ("::1", True),
        ("10.1.2.3", False),
        ("0.0.0.0", False),
    ],
)
def test_the_loopback_is_this_machine(host, own):
    assert is_this_machine(host) == own


REFUSED = {
    "nonsense": "none of tcp://HOST:PORT",
    "tcp://127.0.0.1": "none of",
    "http://127.0.0.1:80": "none of",
    "tcp://10.1.2.3:8786": "--no-tls",
    "local:0": "from 1 to",
    "local:two": "from 1 to",
    "missing.json": "No such file",
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_no_cluster_is_refused(text, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(BotschoolError, match=re.escape(REFUSED[text])):
        place(text)


def test_a_schedulers_file_is_read_and_checked(tmp_path):
    file = tmp_path / "scheduler.json"
    for content, says in (
        ("{", "not a scheduler's file"),
        ('{"address": "tcp://10.1.2.3:1"}', "TLS"),
    ):
        file.write_text(content)
        with pytest.raises(BotschoolError, match=says):
            place(str(file))
    assert place(str(file), unsafe=True) == ("tcp://10.1.2.3:1", 0)
    file.write_text(json.dumps({"address": "tls://10.1.2.3:1"}))
    assert place(str(file)) == ("tls://10.1.2.3:1", 0)


def test_options_that_do_not_go_together_are_refused(tmp_path, refused):
    path = write_experiment(tmp_path)
    refused("es", "-f", path, "--cluster", "local:2", "-w", 2, says="leave -w out")
    refused("es", "-f", path, "--no-tls", says="--cluster")
    refused("es", "-f", path, "-p", "--cluster", "local:2", says="leave it out")
    refused("es", "-f", path, "--cluster", "tcp://127.0.0.1:1", says="No scheduler answers")


def test_without_dask_it_says_what_to_install(tmp_path, refused, monkeypatch):
    monkeypatch.setitem(sys.modules, "distributed", None)
    monkeypatch.delitem(sys.modules, "botschool.cluster.connection", raising=False)
    path = write_experiment(tmp_path)
    refused("es", "-f", path, "--cluster", "local:2", says="pip install 'botschool[cluster]'")


@pytest.fixture(scope="module")
def link():
    """A connection to a worker of its own."""
    with closing(connection.Connection("local:1", *place("local:1"), PATIENCE, print)) as found:
        yield found


def test_local_workers_are_reached_from_this_machine_only(link):
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    heard = {
        c.laddr.ip for p in processes for c in p.net_connections("tcp") if c.status == "LISTEN"
    }
    assert heard == {"127.0.0.1"}


def test_time_without_evaluation_is_not_the_schedulers_silence(monkeypatch):
    told, now = [], 0.0
    monkeypatch.setattr(crew.time, "monotonic", lambda: now)
    link = SimpleNamespace(place="x", address="tcp://x:1", patience=60.0, heard=True, loop=None)
    link.say = told.append
    monkeypatch.setattr(crew.asyncio, "run_coroutine_threadsafe", lambda task, _: task.close())
    these = crew.Crew(link, {}, None, False, 0.0)
    these._workers["a"] = crew.Worker("a", 1, ready=True)
    for wait, heard, says in (
        (3600, False, ""),
        *[(1, False, "")] * 9,
        (1, False, "does not answer: waiting for it up to 60 seconds"),
        (0.2, True, "is back"),
    ):
        now += wait
        link.heard = heard
        these._look()
        assert says in "".join(told) and bool(told) == bool(says)
        told.clear()
    these._workers.clear()
    for wait, says in ((0.2, ""), (1, ""), (1, ""), (1, "No workers at x yet: start one with")):
        now += wait
        link.heard = True
        these._look()
        assert says in "".join(told) and bool(told) == bool(says)
    with pytest.raises(BotschoolError, match="For 60 seconds no worker at x has taken part"):
        for _ in range(90):
            now += 1
            link.heard = True
            these._look()
