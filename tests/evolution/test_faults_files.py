"""Genotypes and checkpoints that are damaged, foreign or hostile: refused in one sentence."""

import json
import os
import pickle
import shutil
import sys
from zipfile import ZipFile

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401  (registers them)
from botschool.analysis.runs import read_fit
from botschool.arenas import samples
from botschool.errors import BotschoolError
from botschool.rl import parameters, weights
from running import call, contents, finished_run, one_sentence, write_experiment

# genotypes


def test_genotypes_that_do_not_fit(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    saved = np.load(results / "bestgS1.npy")
    wrong = {
        "short": (saved[:-1], [f"needs {len(saved)} values", f"({len(saved) - 1},)"]),
        "long": (np.append(saved, 0.0), [f"needs {len(saved)} values"]),
        "unnormalised": (saved[:-8], [f"needs {len(saved)} values", "8 for normalisation"]),
        "matrix": (saved[None], [f"needs {len(saved)} values"]),
        "empty": (saved[:0], [f"needs {len(saved)} values"]),
        "number": (np.array(3.0), [f"needs {len(saved)} values"]),
        "text": (saved.astype(str), ["not a genotype", "plain numbers"]),
        "complex": (saved.astype(complex), ["not a genotype", "plain numbers"]),
        "nan": (np.where(np.arange(len(saved)) == 2, np.nan, saved), ["finite"]),
        "std": (np.append(saved[:-1], 0.0), ["standard deviations"]),
    }
    for name, (values, says) in wrong.items():
        np.save(tmp_path / f"{name}.npy", values)
        refused("es", "-f", ini, "-p", "-g", tmp_path / f"{name}.npy", says=says)


def test_files_that_are_no_genotypes(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    whole = (results / "bestgS1.npy").read_bytes()
    other = {
        "notes.npy": b"I am the very model of a modern major genotype\n",
        "empty.npy": b"",
        "zip.npy": b"PK\x03\x04 and no more",
        "half.npy": whole[: len(whole) // 2],
        "head.npy": whole[:9],
        "shape.npy": whole.replace(b"(26,)", b"(9**9,)"),
        "huge.npy": whole.replace(b"(26,), }         ", b"(26000000000,), }"),
    }
    assert other["huge.npy"] != whole != other["shape.npy"]
    for name, data in other.items():
        (tmp_path / name).write_bytes(data)
        refused("es", "-f", ini, "-p", "-g", tmp_path / name, says=["not a genotype", name])
    for path in (results / "checkpointS1.npz", results / "S1.fit", results):
        refused("es", "-f", ini, "-p", "-g", path, says="genotype")
    refused("es", "-f", ini, "-g", tmp_path / "bestgS2.npy", says=["bestgS2.npy", "bestgS11.npy"])


class Trap:
    """Unpickling this is an attack."""

    def __reduce__(self):
        return (exec, ("raise SystemExit('unpickled')",))


def test_pickles_are_never_opened(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    np.save(tmp_path / "trap.npy", np.array([Trap()], dtype=object), allow_pickle=True)
    (tmp_path / "bare.npy").write_bytes(pickle.dumps(Trap()))
    for name in ("trap.npy", "bare.npy"):
        refused("es", "-f", ini, "-p", "-g", tmp_path / name, says=["not a genotype"])
    whole = dict(np.load(results / "checkpointS1.npz"))
    for name in ("botschool", "algorithm.population", "more"):
        trapped = whole | {name: np.array([Trap()], dtype=object)}
        np.savez(results / "checkpointS1.npz", **trapped)
        refused("es", "-f", ini, "-o", results, "--resume", says=["checkpointS1.npz", "--force"])


# checkpoints


@pytest.mark.slow
def test_truncated_checkpoints(refused, tmp_path):
    """Cut at every length, in steps; finished work stays as it was."""
    ini, results = finished_run(tmp_path, maxmsteps=0.001)
    whole = (results / "checkpointS1.npz").read_bytes()
    before = {path.name: path.read_bytes() for path in results.glob("*S1.*") if path.is_file()}
    lengths = [0, 1, 2, 3, 4, *range(5, len(whole), 97), len(whole) - 22, len(whole) - 1]
    for length in lengths:
        (results / "checkpointS1.npz").write_bytes(whole[:length])
        refused("es", "-f", ini, "-o", results, "--resume", says=["checkpointS1.npz", "--force"])
        before["checkpointS1.npz"] = whole[:length]
        after = {path.name: path.read_bytes() for path in results.glob("*S1.*") if path.is_file()}
        assert after == before


@pytest.mark.slow
def test_damaged_checkpoints(refused, command, tmp_path):
    """Bytes that have changed: refused, or where they mean nothing the run is as before."""
    ini, results = finished_run(tmp_path, maxmsteps=0.0005)
    whole = (results / "checkpointS1.npz").read_bytes()
    before = contents(results)
    numbers = np.random.default_rng(1)
    refusals = 0
    for place in numbers.choice(len(whole), 150, replace=False):
        damaged = bytearray(whole)
        damaged[place] ^= int(numbers.integers(1, 256))
        (results / "checkpointS1.npz").write_bytes(damaged)
        code, _, errors = command("es", "-f", ini, "-o", results, "--resume")
        if code:
            refusals += 1
            one_sentence(code, errors, ["checkpointS1.npz", "--force"])
            (results / "checkpointS1.npz").write_bytes(whole)
        assert contents(results) == before
    assert refusals > 75


def test_foreign_checkpoints(refused, tmp_path):
    ini, results = finished_run(tmp_path)
    path = results / "checkpointS1.npz"
    whole = dict(np.load(path))
    header = json.loads(str(whole["botschool"]))

    def rewritten(**changes):
        np.savez(path, **{**whole, "botschool": np.array(json.dumps(header | changes))})

    def without(*names):
        np.savez(path, **{name: value for name, value in whole.items() if name not in names})

    def filled(name, value):
        np.savez(path, **{**whole, name: np.full_like(whole[name], value)})

    def resized(name):
        np.savez(path, **{**whole, name: whole[name][..., :-1]})

    def no_array():
        with ZipFile(path, "a") as archive:
            archive.writestr("more", b"no array")

    files = {
        "another seed": (lambda: shutil.copy(path, results / "checkpointS2.npz"), ["of seed 1"]),
        "other arrays": (lambda: np.savez(path, steps=np.arange(3)), []),
        "one array": (lambda: np.save(path.open("wb"), np.arange(3)), []),
        "text": (lambda: path.write_text("checkpoint"), []),
        "nothing": (lambda: path.write_bytes(b""), []),
        "a folder": (lambda: (path.unlink(), path.mkdir()), []),
        "newer": (lambda: rewritten(format=99), ["another version"]),
        "no seed": (lambda: np.savez(path, **whole | {"botschool": np.array("{}")}), []),
        "a list": (lambda: np.savez(path, **whole | {"botschool": np.array("[1]")}), []),
        "no json": (lambda: np.savez(path, **whole | {"botschool": np.array("{")}), []),
        "no words": (lambda: np.savez(path, **whole | {"botschool": np.zeros(3)}), []),
        "strange experiment": (lambda: rewritten(experiment="CartPole"), []),
        "stranger experiment": (lambda: rewritten(experiment={"exp": 3}), []),
        "no population": (lambda: without("algorithm.population"), []),
        "no statistics": (lambda: without("evaluator.moments"), []),
        "no curve": (lambda: without("record.stat"), []),
        "small population": (lambda: resized("algorithm.population"), []),
        "few vectors": (lambda: resized("evaluator.normalisation"), []),
        "narrow curve": (lambda: resized("record.stat"), []),
        "no generation": (lambda: filled("algorithm.generation", -1), []),
        "a part that is no array": (no_array, []),
        "parameters of nothing": (lambda: filled("algorithm.population", np.nan), []),
        "a share of nothing": (lambda: filled("evaluator.owed", np.nan), []),
        "an endless share": (lambda: filled("evaluator.owed", np.inf), []),
        "steps of nothing": (lambda: filled("record.stat", np.nan), []),
        "endless steps": (lambda: filled("record.stat", np.inf), []),
        "more steps than done": (lambda: filled("record.stat", 1e9), []),
        "fewer steps each time": (
            lambda: np.savez(path, **whole | {"record.stat": whole["record.stat"][::-1]}),
            [],
        ),
        "curve of text": (lambda: np.savez(path, **whole | {"record.stat": np.array("x")}), []),
    }
    for name, (make, says) in files.items():
        if path.is_dir():
            path.rmdir()
        np.savez(path, **whole)
        make()
        seed = 2 if name == "another seed" else 1
        says = [f"checkpointS{seed}.npz", "--force", *says]
        refused("es", "-f", ini, "-o", results, "-s", seed, "--resume", says=says)


@pytest.mark.parametrize(
    ("key", "value"),
    [
        *[("environment", "CartPole-v0"), ("algo", "OpenAI-ES"), ("popsize", 8), ("mutrate", 0.3)],
        *[("episodes", 3), ("nhiddens", 4), ("maxsteps", 61), ("normalize", 0), ("clip", 1)],
    ],
)
def test_checkpoints_of_other_experiments(key, value, refused, tmp_path):
    ini, results = finished_run(tmp_path)
    before = contents(results)
    parts = {"environment": "CartPole-v1", "algo": "SSS"}
    policy, algorithm = {"normalize": 1}, {}
    if key in parts:
        parts[key] = value
    elif key in ("popsize", "mutrate"):
        algorithm[key] = value
    else:
        policy[key] = value
    write_experiment(tmp_path, **parts, policy=policy, **algorithm)
    refused("es", "-f", ini, "-o", results, "--resume", says=[f"{key} is now {value}", "--force"])
    assert contents(results) == before


# what is no file, and what is not this kind of file


def foreign(folder):
    """Files of numbers that are no genotype, stat file or population, with a word about each."""
    folder.mkdir()
    np.savez(folder / "any.npz", a=np.ones(6), b=np.zeros(2))
    shutil.copy(folder / "any.npz", folder / "any.npy")
    (folder / "begins.npy").write_bytes(b"PK\x03\x04" + bytes(60))
    objects = np.empty(6, dtype=object)
    objects[:] = range(6)
    np.save(folder / "objects.npy", objects)
    np.save(folder / "words.npy", np.array(["a"] * 6))
    np.save(folder / "fields.npy", np.zeros(6, dtype=[("a", float), ("b", float)]))
    words = {"objects.npy": "allow_pickle=True", "words.npy": "numbers", "fields.npy": "numbers"}
    return {path: words.get(path.name, "zip or .npz") for path in sorted(folder.iterdir())}


def test_other_files_of_numpy_are_refused_everywhere(refused, tmp_path):
    ini, _ = finished_run(tmp_path)
    for path, word in foreign(tmp_path / "foreign").items():
        refused("page", ini, "-g", path, "-o", tmp_path / "x.html", says=["not a genotype", word])
        refused("es", "-f", ini, "-p", "-g", path, says=["not a genotype", word])
        refused("plotstat", path, "-o", tmp_path / "x.png", says=["not a stat file"])
        with pytest.raises(BotschoolError, match=f"not a genotype.*{word}"):
            gymnasium.make("botschool/Prey-v0", opponent=str(path))
        refused("page", "CartPole-v1", "-g", path, "-o", tmp_path / "x.html", says=[path])


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such pipes")
def test_a_pipe_is_no_file(tmp_path):
    """Nobody writes into it, so reading would never end."""
    ini, _ = finished_run(tmp_path)
    pipe, page = tmp_path / "pipe.ini", ("-o", tmp_path / "x.html")
    for path in (pipe, tmp_path / "statS1.npy"):
        os.mkfifo(path)
    for arguments in (
        ("es", "-f", pipe),
        ("page", pipe, *page),
        ("tournament", "-f", pipe),
        ("es", "-f", ini, "-p", "-g", pipe),
        ("page", ini, "-g", pipe, *page),
        ("plotstat", tmp_path / "statS1.npy"),
    ):
        code, _, errors = call(*arguments)
        one_sentence(code, errors, "it is a pipe or a device, not a file")
    for read in (samples.load, parameters.read_settings, weights.numbers, read_fit):
        with pytest.raises((BotschoolError, OSError), match="pipe"):
            read(pipe)
