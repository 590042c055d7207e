"""A cluster refuses workers with other files."""

import hashlib
import sys
from pathlib import Path

import pytest

from running import call, environment_of_command, experiment, one_sentence, same, write_experiment

pytest.importorskip("distributed")

from botschool import _core, problems
from botschool.cluster import files
from botschool.cluster.connection import Connection
from botschool.cluster.worker import bits
from clusters import Cluster, registered

pytestmark = pytest.mark.slow

LATE = """
import gymnasium, numpy as np
from gymnasium import spaces
from late_parts import REWARD

class Late(gymnasium.Env):
    observation_space = spaces.Box(-1, 1, (2,), np.float32)
    action_space = spaces.Box(-1, 1, (1,), np.float32)

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.n = 0
        return np.zeros(2, np.float32), {}

    def step(self, action):
        self.n += 1
        reward = 1.0 if self.n < 30 else REWARD
        reward += float(action[0])
        return np.full(2, self.n % 2, np.float32), reward, self.n >= 40, False, {}

gymnasium.register("Late-v0", "late_env:Late", max_episode_steps=40)
"""


def environment(folder, reward):
    """A folder with an environment whose rewards differ after the steps of a probe."""
    folder.mkdir()
    (folder / "late_env.py").write_text(LATE)
    (folder / "late_parts.py").write_text(f"REWARD = {reward}\n")
    return folder


def test_a_worker_with_another_environment_takes_no_part(tmp_path):
    mine, theirs = environment(tmp_path / "mine", 1.0), environment(tmp_path / "theirs", 5.0)
    ini = write_experiment(tmp_path, "late_env:Late-v0", "OpenAI-ES", samplesize=4)
    arguments = ("es", "-f", ini, "-s", 5)
    here = {"env": environment_of_command(DASK_BOTSCHOOL__SHORTEST="0"), "cwd": mine}
    assert call(*arguments, "-o", tmp_path / "one", **here)[0] == 0
    with Cluster(tmp_path / "cluster") as cluster:
        registered(cluster.start_worker(PYTHONPATH=str(theirs)))
        code, _, errors = call(
            *arguments, "-o", tmp_path / "no", "--cluster", cluster.address, **here
        )
        *_, sentence = errors.splitlines(keepends=True)  # before: where the module is from
        one_sentence(code, sentence, ["late_parts.py differs", "install the same files"])
        registered(cluster.start_worker(PYTHONPATH=str(mine)))
        code, out, errors = call(
            *arguments, "-o", tmp_path / "two", "--cluster", cluster.address, **here
        )
    assert code == 0, errors
    assert out.count("is left out: its late_parts.py differs from this machine's") == 1
    assert same(tmp_path / "one", tmp_path / "two")


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A package with an environment, a file that it reads, and a compiled one."""
    folder = tmp_path / "a_package"
    folder.mkdir()
    (folder / "__init__.py").write_text(
        LATE.replace("from late_parts import REWARD", "REWARD = 1").replace("late_env", "a_package")
    )
    (folder / "body.urdf").write_text("<robot/>")
    (folder / "quick.so").write_bytes(b"of this machine")
    monkeypatch.syspath_prepend(tmp_path)
    yield folder
    sys.modules.pop("a_package", None)
    files._digest.cache_clear()


@pytest.mark.parametrize(
    ("name", "told"),
    [("body.urdf", ["a_package/body.urdf"]), ("quick.so", []), ("__init__.py", None)],
)
def test_all_of_a_package_is_compared_but_what_is_compiled(name, told, package):
    problem = problems.make("a_package:Late-v0")
    here = files.manifest(problem)
    assert set(here) == {"botschool", "botschool._core", "gymnasium", "a_package"}
    assert files.differing(here) == []
    (package / name).write_text("other")
    assert files.differing(here) == []  # what a process has loaded stays what it was
    files._digest.cache_clear()
    assert files.differing(here) == (["a_package/__init__.py"] if told is None else told)


def test_other_files_of_botschool_are_named():
    here = files.manifest(problems.make("CartPole-v1"))
    here["botschool"]["botschool/seeds.py"] = b"other"
    here["botschool"]["botschool/missing.py"] = b"there"
    here["botschool._core"]["evonet/layout.cpp"] = b"other"
    told = ["botschool/missing.py", "botschool/seeds.py", "compiled evonet/layout.cpp"]
    assert sorted(files.differing(here)) == told


def test_the_module_knows_what_it_was_compiled_from():
    folder = Path(__file__).parents[2] / "lib"
    sources = [p for kind in ("*.cpp", "*.hpp", "*.in", "*.cmake") for p in folder.rglob(kind)]
    wanted = {p.relative_to(folder).as_posix(): p for p in [*sources, folder / "CMakeLists.txt"]}
    found = dict(reversed(line.split()) for line in _core.sources.splitlines())
    assert found.keys() == wanted.keys()
    for name, path in wanted.items():
        assert found[name] == hashlib.sha256(path.read_bytes()).hexdigest(), f"{name}: make build"


def test_no_dashboard_is_named_where_there_is_none(tmp_path):
    with Cluster(tmp_path / "cluster") as cluster:  # --no-dashboard
        lines = []
        Connection("here", cluster.address, 0, 60.0, lines.append).close()
    assert lines == []


GAIN = {
    "a text that names it": ('GAIN = open(HERE / "gain.txt").read()', "gain.txt"),
    "a name made of parts": ('GAIN = open(HERE / f"gain{1}.txt").read()', "gain1.txt"),
    "numpy, in a folder": ('GAIN = np.loadtxt(HERE / "data" / ("g" + "0.csv"))', "data/g0.csv"),
    "bytes, at a reset": ('def at_reset(): (HERE / f"g{2}.bin").read_bytes()', "g2.bin"),
    "after the probe": ('def late(): (HERE / "late.json").read_text()', "late.json"),
}


@pytest.mark.parametrize("way", GAIN)
def test_files_that_a_single_module_uses_are_compared(way, tmp_path, monkeypatch):
    line, name = GAIN[way]
    parts = "REWARD = 1\nat_reset = lambda: None\n"
    start = f"{parts}HERE = Path(__file__).parent\n{line}"
    text = LATE.replace("from late_parts import REWARD", start)
    text = text.replace("self.n = 0", "self.n = 0; at_reset()").replace("late_env", "single_env")
    (tmp_path / "single_env.py").write_text("from pathlib import Path\n" + text)
    for used in (tmp_path / name, tmp_path / "unused.ini", tmp_path / "results" / "S1.fit"):
        used.parent.mkdir(exist_ok=True)
        used.write_text("1.0")
    monkeypatch.syspath_prepend(tmp_path)
    own = experiment(tmp_path, "single_env:Late-v0", "OpenAI-ES", samplesize=2)
    try:
        with files.noticing():
            problem = problems.of(own)
            bits(own)
        here = files.manifest(problem)
        assert set(here["single_env"]) == {"single_env.py", name}
        files._digest.cache_clear()
        (tmp_path / name).write_text("2.0")
        assert files.differing(here) == [name]
    finally:
        sys.modules.pop("single_env", None)
        files._digest.cache_clear()
