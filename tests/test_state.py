"""A checkpoint holds everything of an algorithm that changes: no attribute can be forgotten."""

from dataclasses import fields

import numpy as np
import pytest

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool.evolution.algorithm import ALGORITHMS

SMALL = {"samplesize": 3, "selsize": 2, "ncompetitors": 3, "popsize": 6, "addtoarchiveevery": 1}
PLAIN = {"archive": {"popsize": 1}, "maxsolvestar": {"popsize": 1, "archivelen": 4}}
SIZE = 4

HALL = ["centres", "m", "v", "saved", "champions", "fitness", "archive_predators", "archive_prey"]
SAVED = {
    "ARS": ["centre"],
    "CMA-ES": ["mean", "sigma", "path_sigma", "path_c", "covariance", "root"],
    "OpenAI-ES": ["centre", "m", "v"],
    "SSS": ["population"],
    "archive": HALL,
    "archivestar": [
        *HALL,
        *(
            f"archive_{side}_{of}"
            for side in ("predators", "prey")
            for of in ("lineages", "strengths")
        ),
    ],
    "coevo2": ["parameters", "m", "v", "fitness"],
    "maxsolvestar": [*HALL, "archive_predators_solved", "archive_prey_solved"],
    "sNES": ["mean", "sigma"],
    "xNES": ["mean", "sigma", "shape"],
}
"""Names of the arrays in checkpoints that exist."""


def made(name):
    entry = ALGORITHMS[name]
    known = {field.name for field in fields(entry.config)}
    own = {key: value for key, value in SMALL.items() if key in known} | PLAIN.get(name, {})
    size = 2 * SIZE if entry.competitive else SIZE
    initial = lambda index: np.random.default_rng(index).normal(size=size)  # noqa: E731
    return entry.make(entry.config(**own), initial, 3)


def step(algorithm):
    if hasattr(algorithm, "advance"):
        algorithm.advance(lambda one, other, pairs, seed=None: win(one[pairs[0]] - other[pairs[1]]))
    else:
        candidates, _ = algorithm.ask()
        algorithm.tell(-(np.asarray(candidates) ** 2).sum(axis=1))


def win(difference):
    return 1 / (1 + np.exp(-difference.sum(axis=1)))


def equal(one, other):
    if isinstance(one, np.ndarray):
        return one.dtype == other.dtype and np.array_equal(one, other, equal_nan=True)
    if isinstance(one, list | tuple):
        return len(one) == len(other) and all(map(equal, one, other))
    if hasattr(one, "__dict__"):
        return vars(one).keys() == vars(other).keys() and all(
            equal(value, vars(other)[name]) for name, value in vars(one).items()
        )
    return type(one) is type(other) and (one == other or one != one)


@pytest.mark.parametrize("name", ALGORITHMS)
def test_what_changes_in_a_generation_is_in_the_checkpoint(name):
    one, two = made(name), made(name)
    for _ in range(7):
        step(one)
    two.restore({key: value.copy() for key, value in one.state().items()})
    forgotten = [key for key, value in vars(two).items() if not equal(vars(one)[key], value)]
    assert not forgotten, f"{name}: the next generation depends on {forgotten}; add to `evolves`"
    for _ in range(3):
        step(one)
        step(two)
    one, two = (sorted(each.state().items()) for each in (one, two))
    assert equal(one, two)


@pytest.mark.parametrize("name", SAVED)
def test_checkpoints_keep_the_names_of_their_arrays(name):
    assert set(made(name).state()) == {"generation", *SAVED[name]}
