"""Define what an evolutionary algorithm is, and register all algorithms.

A new algorithm is one file in botschool/evolution/algorithms: a dataclass of its hyperparameters
and a class with the decorator `algorithm`. Experiment files, `botschool es`, checkpoints and the
list of hyperparameters find it without further changes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Protocol, TypeVar

import numpy as np

from botschool.policies.hyperparameters import hyper

Initial = Callable[[int], np.ndarray]
"""index -> a random genotype, shape (parameters,); each index gives a different one."""


class Algorithm(Protocol):
    """One population: `ask` for candidates, measure them, `tell` their fitness, and repeat.

    Its state is a pure function of its hyperparameters, `initial`, the seed and the fitness values
    that it was told. Its hyperparameters include all of `RunConfig`. `Stateful` has the methods
    `state` and `restore`. The class may have an attribute `conflicts(config)` that yields pairs of
    hyperparameters that exclude each other, as botschool.config.conflicts does, and a method
    `check(config, policy)` that raises BotschoolError for a policy that it cannot evolve. With
    `behaves = True` the run calls `tell(fitness, behaviour)`; behaviour, shape (n, 2,
    observations), is the mean and the standard deviation of each observation in an episode.
    """

    generation: int
    """Generations done."""

    def __init__(self, config: Any, initial: Initial, seed: int) -> None: ...

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, float64 (n, parameters), and each one's evaluation seed, uint64 (n,).

        Further calls before `tell` return the same.
        """

    def tell(self, fitness: np.ndarray) -> None:
        """End the generation; fitness: float64 (n,), in the order of the candidates of `ask`."""

    def average_parameter(self) -> float:
        """Return the average absolute parameter, for the stat file."""

    def state(self) -> dict[str, np.ndarray]:
        """Return everything that a checkpoint needs besides hyperparameters and seed, as arrays.

        `tell` replaces these arrays and never changes them, so an earlier state can be restored.
        """

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore a state that state() returned."""


Play = Callable[..., np.ndarray]
"""(predators, prey, pairs, seed=None) -> fitness in each meeting, float64.

Predators and prey are networks, float64, shapes (p, parameters) and (q, parameters). pairs holds
the rows that meet, int32 (2, meetings). In a constant-sum game the result is the predator's
fitness, (meetings,), and the prey's fitness is 1 minus it. In other games it is the fitness of
both, (2, meetings), on any scale.

Every meeting consists of the same `episodes` episodes: numbers 0, 1, ... of the run's seed. If
`seed` is given, the episodes have that seed, and prey j gets the episodes from j * episodes on: all
predators meet one prey under the same conditions, and different prey under different conditions.
"""


class Competition(Protocol):
    """Two sides, predators and prey, that evolve against each other: call `advance` repeatedly.

    Its hyperparameters include `ngenerations`, the length of a run in generations, and `saveeach`,
    the generations between saves; they may include `maxmsteps`. The rules of Algorithm hold here,
    too. `initial` returns two networks in a row, of a predator and a prey.
    """

    generation: int
    """Generations done."""
    side: int
    """The side that evolves in the next generation: 0 predators, 1 prey."""
    share: float
    """Share of the evolution that is done, from 0 to 1; the run sets it before each generation."""
    plays: int
    """Calls of `play` in a generation."""
    sides: tuple[str, ...]
    """Names of the populations: predators and prey, or one population that plays both sides."""

    def __init__(
        self, config: Any, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None: ...

    def advance(self, play: Play) -> None:
        """Run a generation, or the preparation of the first one (then `generation` stays 0).

        It changes nothing before its end, so an exception of `play` leaves no trace.
        """

    def best(self) -> tuple[np.ndarray, float]:
        """Return the best predator and the best prey in one array, and the predator's fitness."""

    def summary(self) -> dict[str, float]:
        """Return the numbers to report of a generation; `sides` name the mean fitness of each."""

    def individuals(self, play: Play) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the individuals to keep in files, and their fitness; None if there are none yet.

        Networks: float64 (2, n, parameters), predators, then prey. Fitness: predators (rows)
        against prey (columns), (n, n), or (2, n, n) as `Play` says. A single population has
        networks (n, parameters) and fitness (n, n). Playing for this changes nothing, and its steps
        do not count.
        """

    def remembered(self) -> tuple | None:
        """Return meetings whose outcome the state holds: the arguments of `play`, and its result.

        The tuple has four arrays, or five with the seed. A resumed run repeats these meetings to
        check that they end as before. Return None if there are none.
        """

    def average_parameter(self) -> float:
        """Return the average absolute parameter, for the stat file."""

    def state(self) -> dict[str, np.ndarray]:
        """Return the state as Algorithm.state does; arrays named "archive_..." may get longer."""

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore a state that state() returned."""


class Stateful:
    """Gives an algorithm `state` and `restore` for the attributes named in `evolves`."""

    evolves: tuple[str, ...] = ("generation",)
    """Attributes that a generation changes and the next one needs: arrays and numbers.

    "matrix.root" is the attribute `root` of the attribute `matrix`, saved as "root". Everything
    else must follow from the hyperparameters and the seed, or each generation must make it anew. A
    test checks that no algorithm changes an attribute without declaring it.
    """

    def state(self) -> dict[str, np.ndarray]:
        """Return the attributes that `evolves` names, as arrays."""
        return {name.rpartition(".")[2]: np.asarray(self._get(name)) for name in self.evolves}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Put the arrays of `state` back; numbers become numbers of Python again."""
        for name in self.evolves:
            path, _, attribute = name.rpartition(".")
            now, saved = self._get(name), state[attribute]
            value = saved if isinstance(now, np.ndarray) else type(now)(saved)
            setattr(self._get(path) if path else self, attribute, value)

    def _get(self, name: str) -> Any:
        return attrgetter(name)(self)


def million_steps(default: float, free: bool = True) -> Any:
    """Declare the hyperparameter `maxmsteps`. free: a resumed run may change it."""
    text = "length of the run, in million steps"
    return hyper(default, text, above=0, high=1e9, free=free)


def generations_between_saves(default: int) -> Any:
    """Declare the hyperparameter `saveeach` of an algorithm with two sides."""
    return hyper(default, "generations between saves", low=1, high=1000000000, free=True)


@dataclass
class RunConfig:
    """Section [ALGO] of every algorithm with one population."""

    maxmsteps: float = million_steps(1.0)
    saveeach: float = hyper(
        60.0, "minutes between saves (0 = every generation)", low=0, high=1e6, free=True
    )


def mean_absolute(parameters: np.ndarray) -> float:
    """Return np.mean(np.abs(parameters)), in half the time."""
    return float(np.add.reduce(np.abs(parameters), axis=None)) / parameters.size


@dataclass(frozen=True)
class Entry:
    """An algorithm as the registry knows it."""

    name: str
    """The name in experiment files: `algo = NAME`."""
    explanation: str
    config: type
    """The dataclass of its hyperparameters, made with botschool.policies.hyperparameters.hyper."""
    make: Any
    """Its class: an Algorithm, or a Competition if `competitive`."""
    competitive: bool
    """Whether it has two sides (then botschool.evolution.coevolution runs it)."""

    @property
    def behaves(self) -> bool:
        """Return whether the algorithm is told how robots behave."""
        return getattr(self.make, "behaves", False)

    def conflicts(self, config: Any) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that exclude each other: names and a sentence with the remedy."""
        yield from getattr(self.make, "conflicts", lambda config: ())(config)

    def check(self, config: Any, policy: Any) -> None:
        """Raise BotschoolError for a policy that the algorithm cannot evolve."""
        getattr(self.make, "check", lambda config, policy: None)(config, policy)


class Registry(dict[str, Entry]):
    """Algorithms by name; `module:name` also finds a user's own strategy, but lists omit it."""

    own: Callable[[str], Entry]

    def __missing__(self, name: str) -> Entry:
        if ":" in name:
            return self.own(name)
        raise KeyError(name)


ALGORITHMS: Registry = Registry()
"""All algorithms by name; importing botschool.evolution.algorithms fills it."""

Class = TypeVar("Class", bound=type)


def algorithm(
    name: str, explanation: str, config: type, competitive: bool = False
) -> Callable[[Class], Class]:
    """Decorate an algorithm's class to enter it into the registry."""

    def enter(made: Class) -> Class:
        ALGORITHMS[name] = Entry(name, explanation, config, made, competitive)
        return made

    return enter
