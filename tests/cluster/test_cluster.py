"""--cluster: real schedulers and workers on the loopback, and the same bits as on this machine."""

import json
import re
import sys

import numpy as np
import psutil
import pytest

from botschool.cluster.address import is_this_machine, place
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.ascent import Ascent, Start
from botschool.evolution.algorithms.drawing import draw
from botschool.problems import Episodes
from botschool.seeds import generator
from running import call, environment_of_command, finish, same, start, write_experiment

pytest.importorskip("distributed")

from botschool.cluster import Open, chunks, connection, wire, worker
from botschool.cluster.members import Shelf

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
    bytes_ = int(re.search(r"evaluation \d+ %.*; (\d+) bytes a candidate", out)[1])
    assert bytes_ < 1000


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


@pytest.mark.parametrize("both", [True, False])
def test_any_candidates_are_drawn_again_to_the_bit(both):
    numbers = generator(7, 3)
    numbers.integers(5)  # leaves half a word in the buffer
    centres = generator(7, 4).standard_normal((2, 9))
    deviation = 0.02 if both else np.linspace(0.1, 1, 9)
    samples, candidates = draw(numbers, centres, 100, deviation, both)
    again = wire.table(wire.packed(candidates.recipe[0]))
    assert samples.shape == (2, 100, 9) and len(again) == len(candidates) == (400 if both else 200)
    for rows in ([150, 151, 199], [3], range(len(candidates)), [0, 140, len(candidates) - 1]):
        assert (again.rows(np.array(rows)) == candidates[list(rows)]).all()
    assert candidates[:5].recipe is None and (candidates + 1).recipe is None
    assert candidates.reshape(2, -1, 9).reshape(-1, 9).recipe == candidates.recipe
    assert candidates.reshape(-1).recipe is None


def test_an_ascent_is_followed_by_what_it_was_told(monkeypatch):
    monkeypatch.setattr(worker, "_tables", {})
    numbers = generator(7, 3)
    centres, m = numbers.standard_normal((2, 3, 9))
    stream = numbers.place
    ascent = Ascent(Start(centres, m, np.abs(m), stream, 4, 0.02, 0.01, 1))
    episodes = Episodes(np.array([[0, 20], [24, 24]], dtype=np.int32), *np.zeros((2, 2), dtype=int))
    rows = {}
    for step in range(4):
        offspring = ascent.offspring()
        batch = chunks.Batch([offspring, centres], None, episodes, 10)
        request, tables = batch.message(slice(0, 2))
        assert len(tables) == 1 + step + 1  # where it began, each fitness, and who is met
        worker._tables.update({name: wire.table(data) for name, data in tables.items()})
        rows[step] = request["parts"][0], offspring[[0, 20]]
        ascent.climb(numbers.standard_normal((3, 8)))
    for step in (1, 3, 0, 2):  # forward, and from the beginning again
        part, ours = rows[step]
        assert (worker._rows(wire.unpack(wire.pack(part))) == ours).all()


def test_tables_that_were_used_last_are_kept():
    shelf = Shelf(10)
    for name in b"abc":
        shelf.put(name, 3)
    shelf.use([97])
    shelf.put(100, 3)
    assert shelf.trim() == [98] and 98 not in shelf and 97 in shelf


def test_what_goes_over_the_wire_comes_back_and_code_does_not():
    value = {"a": np.arange(100, dtype=np.uint64), "b": [1.5, "x", None, b"y"]}
    back = wire.unpack(wire.pack(value))
    assert (back["a"] == value["a"]).all() and back["a"].dtype == np.uint64
    assert back["b"] == value["b"]
    with pytest.raises(TypeError):
        wire.pack({"a": print})
    with pytest.raises(ValueError):
        wire.unpack(wire.pack(np.array([print], dtype=object)))


def test_chunks_cover_a_batch_once_and_keep_its_order():
    episodes = Episodes.of(np.arange(50), 3)
    genotypes = np.arange(100.0).reshape(50, 2)
    batch = chunks.Batch([genotypes[:30], genotypes[30:]], None, episodes, 10)
    quick, slow = chunks.Pace(1, 300.0, 1.0), chunks.Pace(1, 100.0, 1.0)
    taken = []
    while batch.waiting:
        count = chunks.size(batch, len(taken) % 2, [slow, quick], [0.0, 0.0], False, 0.0)
        taken.append(batch.take(count))
    assert sum(chunk.stop - chunk.start for chunk in taken) == 150 and len(taken) > 4
    batch.give_back(taken[1])
    assert batch.take(1) == taken[1]
    for chunk in reversed(taken):
        request, tables = batch.message(chunk)
        sent = np.concatenate([part["sent"] for part in request["parts"] if "sent" in part])
        if not tables:  # no part is sent whole
            own = sent[request["candidate"]]
            assert (own == genotypes[episodes.candidate[chunk]]).all()
        steps = np.arange(chunk.start, chunk.stop, dtype=np.int32)
        batch.enter(chunk, {"fitness": steps * 2.0, "steps": steps, "moments": None})
    assert not batch.left and (batch.outcome().fitness == 2.0 * np.arange(150)).all()


def test_no_worker_is_given_more_than_its_share():
    """However many chunks it has at a time: whoever has more than that is waited for."""
    batch = chunks.Batch([], None, Episodes.of(np.arange(800), 1), 10)
    paces, ahead = [chunks.Pace(1, 300.0), chunks.Pace(1, 100.0)], [0.0, 0.0]
    for number in (0, 1) * 4:
        chunk = batch.take(chunks.size(batch, number, paces, ahead, False))
        ahead[number] += chunk.stop - chunk.start
    assert ahead[0] <= 600 and ahead[1] <= 200 and sum(ahead) > 700


def test_a_short_chunk_says_little_of_a_workers_speed():
    pace = chunks.Pace(1)
    pace.measured(200, 2000, 2.0)
    assert pace.episodes == 100 and pace.steps == 1000
    pace.measured(1, 10, 0.05)
    assert 95 < pace.episodes < 99
    pace.measured(20, 200, 10.0)
    assert 2 < pace.episodes < 2.1 and 20 < pace.steps < 21


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
    "missing.json": "no file",
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
    assert place(str(file), unsafe=True).address() == "tcp://10.1.2.3:1"
    file.write_text(json.dumps({"address": "tls://10.1.2.3:1"}))
    assert place(str(file)).address() == "tls://10.1.2.3:1"


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
    with Open("local:1", patience=6.0)(print) as cluster:
        yield cluster._connection


def test_local_workers_are_reached_from_this_machine_only(link):
    processes = [psutil.Process(), *psutil.Process().children(recursive=True)]
    heard = {
        c.laddr.ip for p in processes for c in p.net_connections("tcp") if c.status == "LISTEN"
    }
    assert heard == {"127.0.0.1"}


def test_time_without_evaluation_is_not_the_schedulers_silence(link, monkeypatch):
    before = connection.time.monotonic
    link.refresh()
    monkeypatch.setattr(connection.time, "monotonic", lambda: before() + 3600)
    link.refresh()
    assert link.answering and not link.lost
