"""Runs leave the files that they always left, bit for bit: hashes of tests/golden.json.

`PYTHON tests/engine/test_golden.py` prints the hashes of the botschool that this Python has.
Those in tests/golden.json were printed at commit 7a16f59, before runs evaluated two generations'
episodes together, or when their algorithm came. They must never change.
"""

from __future__ import annotations

import ast
import hashlib
import json
import os
import platform
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pytest

import botschool

TESTS = Path(__file__).parents[1]
GOLDEN = json.loads((TESTS / "golden.json").read_text(encoding="utf-8"))

RUNS = {
    # name: environment, algo, [POLICY], [ALGO], further arguments
    "acrobot": (
        "Acrobot-v1",
        "OpenAI-ES",
        "episodes=1 pepisodes=10 maxsteps=500 nhiddens=10 bias=1 afunction=2 out_type=3 winit=1",
        "maxmsteps=20 samplesize=20 stepsize=0.01 noiseStdDev=0.02",
        "--steps 600000",
    ),
    "acrobot, weight decay, a seed for each": (
        "Acrobot-v1",
        "OpenAI-ES",
        "episodes=2 pepisodes=7 maxsteps=300 nhiddens=4 winit=1",
        "maxmsteps=0.3 samplesize=7 wdecay=1 symseed=0",
        "-w 2",
    ),
    "cartpole, SSS": (
        "CartPole-v1",
        "SSS",
        "episodes=5 pepisodes=20 maxsteps=500 nhiddens=10 bias=1 afunction=2 out_type=3 winit=0",
        "maxmsteps=0.4 popsize=20 mutrate=0.1",
        "-s 3",
    ),
    "cartpole, OpenAI-ES": (
        "CartPole-v1",
        "OpenAI-ES",
        "episodes=1 pepisodes=20 maxsteps=500 nhiddens=10 bias=1 afunction=2 out_type=3 winit=0",
        "maxmsteps=0.5 samplesize=20 stepsize=0.03 noiseStdDev=0.1",
        "",
    ),
    "cartpole, saved every generation, normalised": (
        "CartPole-v0",
        "OpenAI-ES",
        "episodes=3 pepisodes=4 maxsteps=500 normalize=1 architecture=2",
        "maxmsteps=0.05 samplesize=5 wdecay=2 saveeach=0",
        "-s 9",
    ),
    "pendulum, normalised": (
        "Pendulum-v1",
        "OpenAI-ES",
        "episodes=1 pepisodes=10 maxsteps=200 nhiddens=20 bias=1 afunction=2 out_type=3 "
        "winit=1 normalize=1 clip=1",
        "maxmsteps=0.5 samplesize=20 stepsize=0.03 noiseStdDev=0.1",
        "-w 2",
    ),
    "pendulum, noise and bins": (
        "Pendulum-v1",
        "SSS",
        "episodes=2 pepisodes=3 maxsteps=90 nbins=5 action_noise=2 nhiddens=5 normalize=1",
        "maxmsteps=0.1 popsize=8",
        "",
    ),
    "mountain car, normalised": (
        "MountainCarContinuous-v0",
        "SSS",
        "episodes=3 pepisodes=20 maxsteps=999 nhiddens=10 bias=1 afunction=2 out_type=3 "
        "winit=0 normalize=1 clip=1",
        "maxmsteps=0.8 popsize=20 mutrate=0.5",
        "",
    ),
    "swing-up": (
        "envSwingupCustom",
        "OpenAI-ES",
        "episodes=1 pepisodes=20 maxsteps=1000 nhiddens=20 nlayers=2 bias=1 afunction=2 "
        "out_type=3 winit=1",
        "maxmsteps=1 samplesize=20 stepsize=0.03 noiseStdDev=0.1",
        "",
    ),
    "double pole": (
        "ErDpole",
        "OpenAI-ES",
        "episodes=3 pepisodes=50 maxsteps=1000 nhiddens=10 bias=1 architecture=1 afunction=2 "
        "out_type=3 winit=1",
        "maxmsteps=0.7 samplesize=40 stepsize=0.03 noiseStdDev=0.1",
        "",
    ),
    "wheeled robot": (
        "ErDiscrim",
        "OpenAI-ES",
        "episodes=2 pepisodes=5 maxsteps=200 nhiddens=5 bias=1 architecture=1 out_type=2",
        "maxmsteps=0.1 samplesize=5",
        "--generations 11",
    ),
    "pendulum, CMA-ES, normalised": (
        "Pendulum-v1",
        "CMA-ES",
        "episodes=1 pepisodes=5 maxsteps=100 nhiddens=8 bias=1 afunction=2 out_type=3 normalize=1",
        "maxmsteps=0.1 sigma=0.5",
        "-w 2",
    ),
    "cartpole, CMA-ES, diagonal": (
        "CartPole-v1",
        "CMA-ES",
        "episodes=2 pepisodes=5 maxsteps=200 nhiddens=5 bias=1",
        "maxmsteps=0.1 popsize=12 diagonal=1 active=0",
        "-s 2",
    ),
    "acrobot, xNES": (
        "Acrobot-v1",
        "xNES",
        "episodes=1 pepisodes=5 maxsteps=200 nhiddens=6 bias=1 winit=1",
        "maxmsteps=0.1 sigma=0.1",
        "",
    ),
    "double pole, sNES": (
        "ErDpole",
        "sNES",
        "episodes=2 pepisodes=5 maxsteps=300 nhiddens=5 bias=1 architecture=1 out_type=3",
        "maxmsteps=0.05 popsize=20 etasigma=0.2",
        "",
    ),
    "in Gymnasium": (
        "MountainCar-v0",
        "SSS",
        "episodes=1 pepisodes=2 maxsteps=40 nhiddens=3 normalize=1",
        "maxmsteps=0.002 popsize=4",
        "",
    ),
}


def write(name: str, folder: Path) -> tuple[Path, list[str]]:
    """Writes a run's experiment file; gives it, and the arguments of `botschool es` after -f."""
    environment, algo, policy, hyperparameters, arguments = RUNS[name]
    lines = ["[EXP]", f"environment = {environment}", f"algo = {algo}"]
    lines += ["[POLICY]", *policy.split(), "[ALGO]", *hyperparameters.split()]
    path = folder / "own.ini"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path, arguments.split()


def hashes(folder: Path) -> dict[str, str]:
    """Of what a run has left, by name: its .npy and .fit files whole, each array of its checkpoint,
    and the points of its TensorBoard curves (which also say when they were written)."""
    found = {}
    for path in [*folder.glob("*.npy"), *folder.glob("*.fit")]:
        found[path.name] = path.read_bytes()
    for path in folder.glob("*.npz"):
        with np.load(path, allow_pickle=False) as arrays:
            for name in sorted(set(arrays) - {"botschool"}):  # that names every hyperparameter
                array = arrays[name]
                found[f"{path.name}:{name}"] = f"{array.dtype}{array.shape}".encode()
                found[f"{path.name}:{name}"] += array.tobytes()
    for path in folder.glob("tensorboard*"):
        found[path.name] = repr(list(points(path))).encode()
    return {name: hashlib.sha256(found[name]).hexdigest()[:16] for name in sorted(found)}


def points(folder: Path):
    """Step, name and value of every point in a folder's event files, as TensorBoard reads them."""
    from tensorboard.backend.event_processing.event_file_loader import LegacyEventFileLoader

    for path in sorted(folder.iterdir()):
        for event in LegacyEventFileLoader(str(path)).Load():
            for value in event.summary.value:
                yield event.step, value.tag, value.simple_value


# numpy draws normal numbers, and Gymnasium moves its car, with functions of the system's C library
@pytest.mark.skipif(
    not (sys.platform == "linux" and platform.machine() in ("x86_64", "aarch64")),
    reason="hashes are those of Linux on x86-64 and ARM",
)
@pytest.mark.parametrize("name", RUNS)
def test_files_are_as_ever(name, command, tmp_path):
    path, arguments = write(name, tmp_path)
    code, _, errors = command("es", "-f", path, *arguments, "-o", tmp_path / "results")
    assert code == 0, errors
    assert hashes(tmp_path / "results") == GOLDEN[name]


PORTABLE = ("evolution/algorithms", "rl/native")
"""Rooms of Python code that decides bits of results, and calls no function of the C library."""
EXACT = {
    "sqrt",
    "ceil",
    "floor",
    "frexp",
    "ldexp",
    "fsum",
    "isfinite",
    "isnan",
    "inf",
    "nan",
    "prod",
}


def calls_of_the_c_library(text: str) -> list[str]:
    """Return what in a module's text is computed by functions whose last bits differ."""
    found = []
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            base = node.left.value if isinstance(node.left, ast.Constant) else None
            if type(base) is not int and "config.cells" not in ast.unparse(node):
                found.append(ast.unparse(node))
        elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            libm = {"exp", "log", "log2", "log10", "log1p", "expm1", "power", "float_power"}
            libm |= {"sin", "cos", "tan", "tanh", "sinh", "cosh", "hypot", "cbrt", "logaddexp"}
            if node.value.id == "np" and node.attr in libm:
                found.append(ast.unparse(node))
            if node.value.id == "math" and node.attr not in EXACT:
                found.append(ast.unparse(node))
    return found


@pytest.mark.parametrize("room", PORTABLE)
def test_results_call_no_function_whose_bits_differ_between_processors(room):
    files = sorted((Path(botschool.__file__).parent / room).glob("*.py"))
    found = {path.name: calls_of_the_c_library(path.read_text("utf-8")) for path in files}
    assert found and {name: calls for name, calls in found.items() if calls} == {}


@pytest.mark.slow
@pytest.mark.skipif(
    not (sys.platform == "linux" and platform.machine() == "x86_64"),
    reason="glibc's tunables choose instructions on x86-64",
)
def test_a_processor_without_fused_multiplication_gives_the_same_bits(tmp_path):
    name = "pendulum, CMA-ES, normalised"
    path, arguments = write(name, tmp_path)
    tunables = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4"}
    command = [sys.executable, "-m", "botschool", "es", "-f", path, *arguments]
    subprocess.run([*command, "-o", tmp_path / "results"], check=True, env=os.environ | tunables)
    assert hashes(tmp_path / "results") == GOLDEN[name]


def main() -> None:
    """Prints all hashes as JSON."""
    printed = {}
    for name in RUNS:
        with tempfile.TemporaryDirectory() as folder:
            path, arguments = write(name, Path(folder))
            command = [sys.executable, "-m", "botschool", "es", "-f", str(path), *arguments]
            results = Path(folder) / "results"
            subprocess.run([*command, "-o", str(results)], check=True, stdout=subprocess.DEVNULL)
            printed[name] = hashes(results)
    print(json.dumps(printed, indent=1))


if __name__ == "__main__":
    main()
