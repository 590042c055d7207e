"""CMA-ES, xNES and sNES: the updates of the papers, step by step; runs of whole experiments."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from botschool.config import load
from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS
from plain_algorithms import PlainCMAES, PlainSNES, PlainXNES
from running import run_seeds, write_experiment

SIZE = 6
VARIANTS = {
    "CMA-ES": ("CMA-ES", {}),
    "CMA-ES, not active": ("CMA-ES", {"active": 0}),
    "CMA-ES, diagonal": ("CMA-ES", {"diagonal": 1}),
    "xNES": ("xNES", {}),
    "sNES": ("sNES", {}),
}
each = pytest.mark.parametrize("name", VARIANTS)


def initial(index, size=SIZE):
    return np.random.default_rng(index).normal(size=size)


def made(name, size=SIZE, **options):
    algo, own = VARIANTS[name]
    entry = ALGORITHMS[algo]
    config = entry.config(**({"sigma": 0.5} | own | options))
    return entry.make(config, lambda index: initial(index, size), 7)


def bent(x):
    """A valley that is no axis's: fitness, the higher the better."""
    return -(x[:, 0] ** 2) - 30 * (x[:, 1] - x[:, 0]) ** 2 - np.abs(x[:, 2:]).sum(axis=1)


def plain(name, mean, popsize):
    if name == "xNES":
        return PlainXNES(mean, 0.5)
    if name == "sNES":
        return PlainSNES(mean, 0.5)
    return PlainCMAES(mean, 0.5, popsize, "diagonal" in name, "not" not in name)


def shape_of(algorithm):
    """Covariance of its next candidates, (n, n)."""
    state, n = algorithm.state(), len(algorithm.mean)
    if "covariance" in state:
        c = state["covariance"]
        return state["sigma"] ** 2 * (np.diag(c) if c.ndim == 1 else c)
    root = state["sigma"] * state.get("shape", np.eye(n))
    return root @ root.T


def plain_shape(algorithm):
    if isinstance(algorithm, PlainCMAES):
        return algorithm.sigma**2 * algorithm.c
    root = algorithm.sigma * getattr(algorithm, "b", np.eye(SIZE))
    return root @ root.T


@pytest.mark.parametrize("popsize", [0, 7, 40])
@each
def test_every_step_is_that_of_the_paper(name, popsize):
    one = made(name, popsize=popsize)
    other = plain(name, initial(0), one.popsize)
    assert one.popsize == popsize or one.popsize == 9
    for generation in range(60):
        candidates, seeds = one.ask()
        assert candidates.shape == (one.popsize, SIZE)
        assert seeds.tolist() == [7 + generation] * one.popsize
        assert np.array_equal(one.ask()[0], candidates)
        # sometimes in steps, so that there are equals
        fitness = bent(candidates) if generation % 3 else np.round(bent(candidates))
        before = candidates.copy()
        one.tell(fitness)
        other.tell(candidates, fitness)
        assert np.array_equal(candidates, before)
        np.testing.assert_allclose(one.mean, getattr(other, "m", getattr(other, "mu", 0)), 1e-8)
        np.testing.assert_allclose(shape_of(one), plain_shape(other), 1e-7, 1e-12)
    assert one.average_parameter() == pytest.approx(np.abs(one.mean).mean())
    assert bent(one.mean[None]) > bent(initial(0)[None])


BITS = """
import hashlib
from test_gaussian import VARIANTS, bent, made
for name in VARIANTS:
    one, found = made(name, size=40), hashlib.sha256()
    for generation in range(25):
        candidates, _ = one.ask()
        found.update(candidates.tobytes())
        one.tell(bent(candidates))
    print(name, found.hexdigest())
"""


@pytest.mark.slow
def test_instruction_sets_and_blas_do_not_show():
    """Of numpy, and of its BLAS."""
    features = np._core._multiarray_umath.__cpu_features__
    dispatch = np._core._multiarray_umath.__cpu_dispatch__
    disabled = " ".join(name for name in dispatch if features.get(name))
    printed = []
    for variables in (
        {},
        {"NPY_DISABLE_CPU_FEATURES": disabled, "OPENBLAS_NUM_THREADS": "1"},
        {"OPENBLAS_CORETYPE": "Prescott"},
    ):
        paths = os.pathsep.join(sys.path)
        done = subprocess.run(
            [sys.executable, "-c", BITS],
            env=os.environ | {"PYTHONPATH": paths} | variables,
            cwd=Path(__file__).parent,
            capture_output=True,
            text=True,
        )
        assert done.returncode == 0, done.stderr
        printed.append(done.stdout)
    assert len(printed[0].splitlines()) == len(VARIANTS)
    assert printed[0] == printed[1] == printed[2]


# bad input


@pytest.mark.parametrize(
    ("algo", "line", "says"),
    [
        ("CMA-ES", "popsize = 1", "popsize = 1 leaves nothing to rank"),
        ("xNES", "popsize = 2.5", "is not a whole number"),
        ("sNES", "sigma = 0", "above 0"),
        ("sNES", "diagonal = 1", "diagonal is a hyperparameter of CMA-ES"),
        ("CMA-ES", "active = 2", "0 (no) or 1 (yes)"),
        ("xNES", "etasigna = 1", "etasigma"),
        ("OpenAI-ES", "sigma = 1", "CMA-ES"),
        ("CMAES", "sigma = 1", "CMA-ES"),
    ],
)
def test_wrong_lines_are_refused(algo, line, says, tmp_path):
    path = tmp_path / "own.ini"
    head = f"[EXP]\nenvironment = CartPole-v1\nalgo = {algo}\n[POLICY]\n[ALGO]\n"
    path.write_text(head + line + "\n")
    with pytest.raises(BotschoolError) as error:
        load(path)
    assert says in str(error.value) and "\n" not in str(error.value)


@pytest.mark.parametrize(("algo", "says"), [("CMA-ES", "diagonal = 1"), ("xNES", "algo = sNES")])
def test_a_network_too_large_for_a_matrix_is_refused(algo, says, tmp_path, refused):
    path = write_experiment(tmp_path, algo=algo, policy={"nhiddens": 1000})
    refused("es", "-f", path, "-o", tmp_path, says=("6000 parameters", says))
    path = write_experiment(tmp_path, algo="CMA-ES", policy={"nhiddens": 1000}, diagonal=1)
    assert run_seeds(load(path), tmp_path / "diagonal", steps=1)


def test_a_covariance_that_is_not_finite_is_a_sentence():
    """As the fuzzer found, of a checkpoint with numbers near the largest."""
    algorithm = ALGORITHMS["CMA-ES"].make(
        ALGORITHMS["CMA-ES"].config(), lambda index: np.zeros(3) + index, 1
    )
    algorithm.matrix.covariance[0, 0] = np.inf
    with pytest.raises(BotschoolError, match="CMA-ES has broken down"):
        algorithm.matrix.decompose()
