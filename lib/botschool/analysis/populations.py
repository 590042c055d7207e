"""Read the populations that co-evolution saves (docs/specification.md, "Run files").

`S12G200.npy` holds the populations of seed 12 after 200 generations: first all predators, then all
prey, one network per row. `S12FitG200.npy` holds the fitness of each network against each
competitor. If one population plays both sides (`single`), the files hold this population, and its
individuals are both predators and prey.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.evaluate import mean
from botschool.npy import NotNumbers, read_numbers
from botschool.policies.policy import Policy

POPULATIONS = re.compile(r"S(?P<seed>\d+)G(?P<generation>\d+)\.npy", re.ASCII)
"""Names of the files."""
_LISTED = 12
"""Largest number of generations that a sentence lists in full."""


@dataclass(frozen=True)
class Population:
    """Predators and prey of one generation, the best first; each (individuals, nparameters)."""

    name: str
    predators: np.ndarray
    prey: np.ndarray

    def best(self, individuals: int) -> Population:
        """Return the n best of both. Raises BotschoolError if there are fewer."""
        if individuals > len(self.prey):
            raise BotschoolError(
                f"{self.name} has {len(self.prey)} predators and as many prey, so it cannot give "
                f"the {individuals} best: ask for at most {len(self.prey)}."
            )
        return Population(self.name, self.predators[:individuals], self.prey[:individuals])


class Populations:
    """The saved generations of the run with this seed.

    Raises BotschoolError if the folder holds none; the sentence lists the seeds that it holds.
    """

    def __init__(self, folder: Path, seed: int, policy: Policy, single: bool = False) -> None:
        self.folder = folder
        self.seed = seed
        self.policy = policy
        self.single = single
        found = seeds_of(folder)
        if seed not in found:
            there = ", ".join(map(str, found)) or "none at all"
            raise BotschoolError(
                f"{folder} holds no populations of seed {seed}, such as S{seed}G0.npy (seeds "
                f"there: {there}): name the run's seed with -s and its folder."
            )
        self.generations = found[seed]
        """The saved generations, sorted."""

    def check(self, generation: int) -> None:
        """Raise BotschoolError if there is no such generation."""
        if generation not in self.generations:
            raise BotschoolError(f"There is no generation {generation}: {self.there()}.")

    def load(self, generation: int) -> Population:
        """Return all individuals of a generation. Raises BotschoolError."""
        self.check(generation)
        path = self.folder / f"S{self.seed}G{generation}.npy"
        return read_population(path, self.policy, f"generation {generation}", self.single)

    def there(self) -> str:
        """Return what the folder holds, as the end of a sentence."""
        return f"{self.folder} holds {counted(self.generations)} of seed {self.seed}"


def seeds_of(folder: Path) -> dict[int, list[int]]:
    """Return seed -> generations whose populations the folder holds, both sorted."""
    try:
        names = [path.name for path in folder.iterdir()]
    except FileNotFoundError:
        raise BotschoolError(f"There is no folder {folder}: check its name.") from None
    except OSError as error:
        raise BotschoolError(f"{folder} cannot be read ({error.strerror or error}).") from error
    found: dict[int, list[int]] = {}
    for match in filter(None, map(POPULATIONS.fullmatch, names)):
        found.setdefault(int(match["seed"]), []).append(int(match["generation"]))
    return {seed: sorted(found[seed]) for seed in sorted(found)}


def counted(generations: list[int]) -> str:
    """Return the generations as part of a sentence, shortened if there are many."""
    if len(generations) == 1:
        return f"generation {generations[0]} alone"
    numbers = [str(generation) for generation in generations]
    if len(numbers) > _LISTED:
        numbers = [*numbers[:3], "...", *numbers[-2:]]
        return f"generations {', '.join(numbers)} ({len(generations)} of them)"
    return f"generations {', '.join(numbers[:-1])} and {numbers[-1]}"


def read_population(path: Path, policy: Policy, name: str, single: bool = False) -> Population:
    """Return the populations in a file, sorted by mean fitness if a Fit file lies beside it.

    Raises BotschoolError if a file is damaged or its networks are not the policy's.
    """
    genotypes = _numbers(path, "populations")
    count, length = genotypes.shape
    if length != policy.nparameters:
        raise BotschoolError(
            f"{path} holds {count} networks of {length} parameters, but this experiment's "
            f"have {policy.nparameters}: it belongs to an experiment with other [POLICY] "
            "settings."
        )
    if single and count:
        best = genotypes[_order(path, count, 1)]
        return Population(name, best, best)
    if count % 2 or not count:
        raise BotschoolError(
            f"{path} holds {count} networks, but populations have as many predators as prey."
        )
    order = _order(path, count, 2)
    half = count // 2
    return Population(name, genotypes[order[:half]], genotypes[order[half:]])


def _order(path: Path, count: int, sides: int) -> np.ndarray:
    """Return the rows of one side after the other, the best first; ties keep their order."""
    beside = path.with_name(re.sub(r"(S\d+)(G\d+\.npy)", r"\1Fit\2", path.name))
    if beside == path or not beside.exists():
        return np.arange(count)
    fitness = _numbers(beside, "fitness")
    if len(fitness) != count or not fitness.shape[1]:
        raise BotschoolError(
            f"{beside} holds the fitness of {len(fitness)} individuals, but {path.name} has "
            f"{count}: the two files are not from one run."
        )
    means = np.array([mean(row) for row in fitness]).reshape(sides, -1)
    order = np.argsort(-means, axis=1, kind="stable")
    return (order + count // sides * np.arange(sides)[:, None]).ravel()


def _numbers(path: Path, what: str) -> np.ndarray:
    """Return a table of finite numbers, float64."""
    try:
        table = read_numbers(path)
    except FileNotFoundError:
        raise BotschoolError(f"There is no file {path}: check its name.") from None
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read ({error.strerror or error}).") from error
    except NotNumbers as error:
        raise BotschoolError(f"{path} holds no {what}: {error}.") from None
    if table.ndim != 2 or not np.isfinite(table).all():
        raise BotschoolError(f"{path} holds no {what}: it is not a table of finite numbers.")
    return table.astype(np.float64)
