"""What an evolutionary algorithm is, and the registry that all of them are in.

A new one is one file in botschool/evolution/algorithms: a dataclass of its hyperparameters and a
class with the decorator `algorithm`. Experiment files, `botschool es`, checkpoints and the list of
hyperparameters find it there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar

import numpy as np

Initial = Callable[[int], np.ndarray]
"""index -> a random genotype, shape (parameters,); each index gives another."""


class Algorithm(Protocol):
    """One population: `ask` for candidates, measure them, `tell` their fitness; and again.

    It is a pure function of its hyperparameters, `initial`, the seed and the fitness it was told.
    Its hyperparameters include `maxmsteps`, the length of a run in million steps, and `saveeach`,
    the minutes between saves. An attribute `conflicts(config)` of the class may yield pairs of
    hyperparameters that cannot go together, as botschool.config.conflicts does.
    """

    generation: int
    """Generations done."""

    def __init__(self, config: Any, initial: Initial, seed: int) -> None: ...

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Candidates, float64 (n, parameters), and the seed of each one's evaluation, uint64 (n,).

        Asked twice before `tell`, it gives the same.
        """

    def tell(self, fitness: np.ndarray) -> None:
        """Ends the generation; fitness: float64 (n,), of the candidates in the order of `ask`."""

    def average_parameter(self) -> float:
        """Average absolute parameter, for the stat file."""

    def state(self) -> dict[str, np.ndarray]:
        """All that a checkpoint needs besides the hyperparameters and the seed, as arrays.

        `tell` replaces these arrays and leaves them as they are: an earlier state can be restored.
        """

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""


def mean_absolute(parameters: np.ndarray) -> float:
    """np.mean(np.abs(parameters)), in half the time."""
    return float(np.add.reduce(np.abs(parameters), axis=None)) / parameters.size


@dataclass(frozen=True)
class Entry:
    """An algorithm as the registry knows it."""

    name: str
    """What `algo = NAME` says in experiment files."""
    explanation: str
    config: type
    """The dataclass of its hyperparameters, made with botschool.hyperparameters.hyper."""
    make: type
    """Its class: an Algorithm, or with `competitive` one of two populations."""
    competitive: bool
    """Whether two populations meet (botschool.evolution.coevolution runs it)."""

    def conflicts(self, config: Any) -> Iterator[tuple[tuple[str, ...], str]]:
        """Hyperparameters that cannot go together: their names and a sentence with the remedy."""
        yield from getattr(self.make, "conflicts", lambda config: ())(config)


ALGORITHMS: dict[str, Entry] = {}
"""By name; filled when botschool.evolution.algorithms is imported."""

Class = TypeVar("Class", bound=type)


def algorithm(
    name: str, explanation: str, config: type, competitive: bool = False
) -> Callable[[Class], Class]:
    """Decorates an algorithm's class: enters it into the registry."""

    def enter(made: Class) -> Class:
        ALGORITHMS[name] = Entry(name, explanation, config, made, competitive)
        return made

    return enter
