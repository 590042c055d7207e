"""One place for each addition (docs/architecture.md): each test adds something to a scratch copy of
the library, touches nothing else, and uses it through the command."""

import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import numpy as np
import pytest

import botschool
from botschool import _core
from botschool.analysis.runs import read_stat

ROOT = Path(__file__).parents[2]
IGNORED = shutil.ignore_patterns("__pycache__", "*.so")
# without `site`, whose hooks would find the installed package first
START = "import sys; sys.path[:0] = sys.argv.pop(1).split(';'); "
COMMAND = START + "from botschool.cli import main; main()"


class Scratch:
    """A copy of the library in FOLDER/lib, and its command in FOLDER/work."""

    def __init__(self, folder: Path) -> None:
        self.lib, self.work = folder / "lib", folder / "work"
        self.work.mkdir()
        shutil.copytree(ROOT / "lib", self.lib, ignore=IGNORED)

    def run(self, code: str, *arguments: object, succeeds: bool = True) -> str:
        path = ";".join([str(self.lib), sysconfig.get_path("platlib")])
        done = subprocess.run(
            [sys.executable, "-S", "-c", code, path, *map(str, arguments)],
            cwd=self.work,
            env=os.environ | {"COLUMNS": "200"},
            capture_output=True,
            text=True,
        )
        assert (done.returncode == 0) == succeeds, done.stdout + done.stderr
        return done.stdout if succeeds else done.stderr

    def command(self, *arguments: object, **options) -> str:
        return self.run(COMMAND, *arguments, **options)

    def borrow_module(self) -> None:
        """Uses the C++ module that is installed here."""
        shutil.copy(_core.__file__, self.lib / "botschool")

    def compile(self, problems: set[str]) -> None:
        """Compiles the C++ module with these problems (all would take long)."""
        for header in (self.lib / "arena" / "problems").iterdir():
            if header.stem not in problems:
                header.unlink()
        build_file = self.lib / "CMakeLists.txt"
        build_file.write_text(build_file.read_text().replace("-O3", "-O1"))  # is quicker
        build = self.lib.parent / "build"
        scripts = sysconfig.get_path("scripts") + os.pathsep + os.environ["PATH"]
        tools = os.environ | {"PATH": scripts}
        cmake = shutil.which("cmake", path=scripts)
        options = [f"-DPython_EXECUTABLE={sys.executable}", "-DCMAKE_BUILD_TYPE=Release"]
        ninja = ["-G", "Ninja"] if shutil.which("ninja", path=scripts) else []
        for step in (
            [cmake, "-S", self.lib, "-B", build, *ninja, *options],
            [cmake, "--build", build, "--target", "_core", "-j", "2"],
        ):
            done = subprocess.run(step, env=tools, capture_output=True, text=True)
            assert done.returncode == 0, done.stdout + done.stderr
        shutil.copy(next(build.glob("_core*")), self.lib / "botschool")


SLIDER = """// A slider that has to be pushed to the middle.
#pragma once

#include <cmath>

#include "../engine/problem.hpp"

BOTSCHOOL_BEGIN

template <int L>
struct Slider : ProblemBase {
  static Info info() {
    Info info;
    info.name = "Slider-v3";
    info.observations = 200;
    info.outputs = 3;
    info.states = 1;
    info.limit = 40;
    info.discrete = true;
    info.seconds = 0.1;
    return info;
  }
  void bounds(double* low, double* high) const {
    for (int i = 0; i < 200; ++i) low[i] = -2, high[i] = 2;
  }

  double state[1][L];

  void start(int lane, Random& random) { state[0][lane] = random.uniform(-1, 1); }

  template <class T>
  void observe(T* out) const {
    for (int i = 0; i < 200; ++i)
      for (int l = 0; l < L; ++l) out[i * L + l] = static_cast<T>(state[0][l]);
  }

  void step(const double* action, double* reward, std::int64_t* ended) {
    for (int l = 0; l < L; ++l) {
      state[0][l] += 0.05 * (action[l] - 1);
      reward[l] = 1 - std::fabs(state[0][l]);
      ended[l] = std::fabs(state[0][l]) > 2;
    }
  }
};

BOTSCHOOL_END

BOTSCHOOL_PROBLEM(Slider)
"""

POLICY = "nhiddens = 2\nepisodes = 2\npepisodes = 2\n"
ALGO = "[ALGO]\nmaxmsteps = 0.02\nsamplesize = 4\n"

FACE = (
    START
    + """
import gymnasium, numpy as np
from gymnasium.utils.env_checker import check_env
import botschool.envs
env = gymnasium.make("botschool/Slider-v3", render_mode="rgb_array", disable_env_checker=True)
check_env(env.unwrapped)
assert env.action_space == gymnasium.spaces.Discrete(3)
assert env.observation_space == gymnasium.spaces.Box(-2, 2, (200,), np.float32)
env.reset(seed=1)
assert env.spec.max_episode_steps == 40 and env.render().std() > 5
"""
)

ROBOT = """    {"Beetle", 20, 30, 100, {0, 45, 90, 135, 180, 225, 270, 315},
     {9, 9, 9, 9, 9, 9, 9, 9}, 1, 50, {5, 0.5, 2}, {5, 0.5, 2}},
"""
DRIVEN = (
    START
    + """
from botschool import arena
env = arena.make("discrim", models="beetle", noise=0)
env.reset(seed=1)
env.robots[0] = 23, 200, 3.14159265
assert env.sense()[0] > 0.9 and env.models[0].radius == 20
env.action[:] = -1
env.step()
assert abs(env.robots[0][0] - 33) < 1e-9  # 100 mm/s for 0.1 s
"""
)


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """A copy with a native problem, a robot and a hyperparameter more."""
    scratch = Scratch(tmp_path_factory.mktemp("native"))
    (scratch.lib / "arena" / "problems" / "slider.hpp").write_text(SLIDER)
    table = scratch.lib / "arena" / "robots" / "plan.hpp"
    before = "inline constexpr RobotModel kRobotModels[]{\n"
    assert before in table.read_text()
    table.write_text(table.read_text().replace(before, before + ROBOT))
    keys = scratch.lib / "evonet" / "hyperparameters.hpp"
    line = '  X(double, patience, 0.5, 0, 3, "how long it waits", "") \\\n'
    before = "#define BOTSCHOOL_HYPERPARAMETERS(X) \\\n"
    assert before in keys.read_text()
    keys.write_text(keys.read_text().replace(before, before + line))
    policy = scratch.lib / "botschool" / "policies" / "hyperparameters.py"
    before = '    nhiddens: int = _of_network("nhiddens")\n'
    assert before in policy.read_text()
    line = '    patience: float = _of_network("patience")\n'
    policy.write_text(policy.read_text().replace(before, before + line))
    scratch.compile({"slider", "discrim"})
    (scratch.work / "slider.ini").write_text(
        f"[EXP]\nenvironment = Slider-v3\n[POLICY]\n{POLICY}{ALGO}"
    )
    return scratch


@pytest.mark.long
def test_a_native_problem(compiled):
    out = compiled.command("es", "-f", "slider.ini", "-s", 1, "-o", "run")
    assert "seed 1: best" in out
    assert read_stat(compiled.work / "run" / "statS1.npy")[-1, 0] >= 20000
    robot = ("es", "-f", "slider.ini", "-s", 1, "-p", "-g", "run/bestgS1.npy", "--episodes", 1)
    assert "steps 40" in compiled.command(*robot, "--render", "none")
    compiled.command(*robot, "--video", "slider.mp4")
    compiled.command(*robot, "--replay", "slider.html")
    assert (compiled.work / "slider.mp4").stat().st_size > 2000
    assert "Slider-v3" in (compiled.work / "slider.html").read_text()


def test_its_gymnasium_face(compiled):
    compiled.run(FACE)


def test_a_wheeled_robot(compiled):
    policy = "architecture = 3\n" + POLICY + "maxsteps = 30\n"
    ini = compiled.work / "beetle.ini"
    ini.write_text(f"[EXP]\nenvironment = ErDiscrim\nrobots = beetle\n[POLICY]\n{policy}{ALGO}")
    compiled.command("es", "-f", ini, "-s", 1, "-o", "beetle")
    robot = ("es", "-f", ini, "-s", 1, "-p", "-g", "beetle/bestgS1.npy")
    compiled.command(*robot, "--replay", "beetle.html")
    ini.write_text(ini.read_text().replace("beetle", "betle"))
    errors = compiled.command("es", "-f", ini, "-o", "wrong", succeeds=False)
    assert "line 3" in errors and "Beetle" in errors and errors.count("\n") == 1
    compiled.run(DRIVEN)


def test_a_hyperparameter_of_the_policy(compiled):
    assert "how long it waits" in " ".join(compiled.command("es").split())
    ini = compiled.work / "patient.ini"
    exp = "[EXP]\nenvironment = Slider-v3\n[POLICY]\n"
    ini.write_text(f"{exp}patience = 2\n{POLICY}{ALGO}")
    compiled.command("es", "-f", ini, "-s", 1, "-o", "patient")
    other = compiled.work / "impatient.ini"
    other.write_text(f"{exp}patience = 1\n{POLICY}{ALGO}")
    errors = compiled.command("es", "-f", other, "-o", "patient", "--resume", succeeds=False)
    assert "patience = 2" in errors
    other.write_text(f"{exp}patience = 4\n{POLICY}{ALGO}")
    errors = compiled.command("es", "-f", other, "-o", "new", succeeds=False)
    assert "patience = 4 is out of range" in errors
    code = START + "from botschool import _core; print(_core.Spec().patience)"
    assert compiled.run(code) == "0.5\n"


CLIMBER = '''"""A hill climber."""

from dataclasses import dataclass

import numpy as np

from botschool.evolution.algorithm import RunConfig, Stateful, algorithm
from botschool.policies.hyperparameters import hyper
from botschool.seeds import generator


@dataclass
class ClimberConfig(RunConfig):
    jump: float = hyper(0.1, "standard deviation of a jump", above=0, high=10)


@algorithm("climber", "a hill climber", ClimberConfig)
class Climber(Stateful):
    evolves = ("generation", "centre", "best")

    def __init__(self, config, initial, seed):
        self.config, self.seed, self.generation = config, seed, 0
        self.centre, self.best = initial(0), -np.inf

    def ask(self):
        jump = generator(self.seed, self.generation).standard_normal(len(self.centre))
        self.next = self.centre + self.config.jump * jump
        return self.next[None], np.array([self.seed], dtype=np.uint64)

    def tell(self, fitness):
        if fitness[0] > self.best:
            self.best, self.centre = float(fitness[0]), self.next
        self.generation += 1

    def average_parameter(self):
        return float(np.abs(self.centre).mean())
'''


@pytest.mark.slow
def test_an_algorithm(tmp_path):
    scratch = Scratch(tmp_path)
    scratch.borrow_module()
    path = scratch.lib / "botschool" / "evolution" / "algorithms" / "climber.py"
    path.write_text(CLIMBER)
    assert "standard deviation of a jump" in " ".join(scratch.command("es").split())
    ini = scratch.work / "climber.ini"
    exp = "[EXP]\nenvironment = CartPole-v1\nalgo = climber\n[POLICY]\n" + POLICY
    ini.write_text(f"{exp}[ALGO]\nmaxmsteps = 0.01\njump = 0.5\n")
    scratch.command("es", "-f", ini, "-s", 1, "-o", "whole")
    scratch.command("es", "-f", ini, "-s", 1, "-o", "halves", "--generations", 5)
    scratch.command("es", "-f", ini, "-s", 1, "-o", "halves", "--resume", "-w", 2)
    whole, halves = (np.load(scratch.work / run / "bestgS1.npy") for run in ("whole", "halves"))
    assert np.array_equal(whole, halves)
    ini.write_text(f"{exp}[ALGO]\njumb = 0.5\n")
    assert "jump" in scratch.command("es", "-f", ini, "-o", "new", succeeds=False)


PADDLE = '''"""A problem of one's own."""

import gymnasium
import numpy as np
from gymnasium.spaces import Box


class Paddle(gymnasium.Env):
    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}
    observation_space = Box(-1, 1, (2,), np.float32)
    action_space = Box(-1, 1, (1,), np.float32)

    def __init__(self, render_mode=None):
        self.render_mode = render_mode

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.x = self.np_random.uniform(-1, 1)
        return np.float32([self.x, 1]), {}

    def step(self, action):
        self.x = float(np.clip(self.x + 0.1 * action[0], -1, 1))
        return np.float32([self.x, 1]), -abs(self.x), False, False, {}

    def render(self):
        frame = np.full((64, 128, 3), 255, np.uint8)
        frame[:, int(60 + 50 * self.x) : int(68 + 50 * self.x)] = 0
        return frame


gymnasium.register("Paddle-v0", entry_point=Paddle, max_episode_steps=20)
'''


@pytest.mark.slow
def test_a_problem_in_python(tmp_path):
    (tmp_path / "paddle.py").write_text(PADDLE)
    ini = tmp_path / "paddle.ini"
    ini.write_text(f"[EXP]\nenvironment = paddle:Paddle-v0\n[POLICY]\n{POLICY}{ALGO}")
    for arguments in (
        ("-o", "run", "-w", "2", "--steps", "2000"),
        ("-p", "-g", "run/bestgS1.npy", "--video", "paddle.mp4", "--episodes", "1"),
    ):
        subprocess.run(
            [sys.executable, "-m", "botschool", "es", "-f", ini, "-s", "1", *arguments],
            cwd=tmp_path,
            check=True,
            capture_output=True,
        )
    assert (tmp_path / "paddle.mp4").stat().st_size > 2000


def test_there_is_a_copy_to_test():
    assert Path(botschool.__file__).is_relative_to(ROOT / "lib")
