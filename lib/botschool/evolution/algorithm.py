"""What an evolutionary algorithm is, and the registry that all of them are in.

A new one is one file in botschool/evolution/algorithms: a dataclass of its hyperparameters and a
class with the decorator `algorithm`. Experiment files, `botschool es`, checkpoints and the list of
hyperparameters find it there.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from operator import attrgetter
from typing import Any, Protocol, TypeVar

import numpy as np

from botschool.policies.hyperparameters import hyper

Initial = Callable[[int], np.ndarray]
"""index -> a random genotype, shape (parameters,); each index gives another."""


class Algorithm(Protocol):
    """One population: `ask` for candidates, measure them, `tell` their fitness; and again.

    It is a pure function of its hyperparameters, `initial`, the seed and the fitness it was told.
    Its hyperparameters include those of `RunConfig`; `Stateful` has the methods `state` and
    `restore`. An attribute `conflicts(config)` of the class may yield pairs of
    hyperparameters that cannot go together, as botschool.config.conflicts does.
    """

    generation: int
    """Generations done."""

    def __init__(self, config: Any, initial: Initial, seed: int) -> None: ...

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        """Return candidates, float64 (n, parameters), and the seed of each one's evaluation, uint64
        (n,).

        Asked twice before `tell`, it gives the same.
        """

    def tell(self, fitness: np.ndarray) -> None:
        """Ends the generation; fitness: float64 (n,), of the candidates in the order of `ask`."""

    def average_parameter(self) -> float:
        """Return the average absolute parameter, for the stat file."""

    def state(self) -> dict[str, np.ndarray]:
        """Return all that a checkpoint needs besides the hyperparameters and the seed, as arrays.

        `tell` replaces these arrays and leaves them as they are: an earlier state can be restored.
        """

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""


Play = Callable[..., np.ndarray]
"""(predators, prey, pairs, seed=None) -> fitness in each meeting, float64.

Predators and prey are networks, float64, shapes (p, parameters) and (q, parameters); pairs says who
meets whom, int32 (2, meetings). In a game of constant sum the fitness is the predator's,
(meetings,), and a prey's is 1 minus it. In others it is that of both, (2, meetings), on any
scale.

Every meeting is the same `episodes` episodes: those of the run's seed with numbers 0, 1, ... With
`seed` they are of that seed, and prey j has those from j * episodes on: all predators meet it under
the same conditions, and other prey under others."""


class Competition(Protocol):
    """Two sides, predators and prey, that evolve against each other: `advance`, again and again.

    Its hyperparameters include `ngenerations`, the length of a run in generations, and `saveeach`,
    the generations between saves; they may include `maxmsteps`. What is said of Algorithm holds
    here too: `initial` gives two networks in a row, of a predator and a prey.
    """

    generation: int
    """Generations done."""
    side: int
    """Who evolves in the next generation: 0 predators, 1 prey."""
    share: float
    """How much of the evolution is done, from 0 to 1; the run sets it before each generation."""
    plays: int
    """Calls of `play` in a generation."""
    sides: tuple[str, ...]
    """Names of the populations: predators and prey, or the only one, which plays both sides."""

    def __init__(
        self, config: Any, initial: Initial, seed: int, constant_sum: bool = True
    ) -> None: ...

    def advance(self, play: Play) -> None:
        """A generation, or what must come before the first one: then `generation` stays 0.

        It changes nothing before its end, so what `play` raises leaves no trace.
        """

    def best(self) -> tuple[np.ndarray, float]:
        """Return the best predator and the best prey, one after the other, and the predator's
        fitness.
        """

    def summary(self) -> dict[str, float]:
        """Return what to report of a generation; under the names in `sides` the mean fitness of
        each.
        """

    def individuals(self, play: Play) -> tuple[np.ndarray, np.ndarray] | None:
        """Return the individuals to keep in files: networks, float64 (2, n, parameters), predators,
        then prey;
        and the fitness of predators (rows) against prey (columns), (n, n) or (2, n, n) as `Play`
        says. Of a single population networks (n, parameters) and fitness (n, n). None if there is
        nobody yet.

        Playing for this changes nothing, and its steps do not count.
        """

    def remembered(self) -> tuple | None:
        """Meetings of which the state holds the outcome: what `play` was given, and what it gave
        (four arrays, or five with the seed).

        A resumed run repeats them, to see that they still end as they did. None if there are none.
        """

    def average_parameter(self) -> float:
        """Return the average absolute parameter, for the stat file."""

    def state(self) -> dict[str, np.ndarray]:
        """As Algorithm.state; arrays whose name begins with "archive_" may get longer."""

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""


class Stateful:
    """Saves and restores what a class declares in `evolves`: the methods `state` and `restore`."""

    evolves: tuple[str, ...] = ("generation",)
    """Attributes that a generation changes and that the next one depends on: arrays and numbers.

    "matrix.root" is the attribute `root` of the attribute `matrix`, and is saved as "root".
    Everything else must follow from the hyperparameters and the seed, or be made anew by the next
    generation. A test looks at all algorithms for attributes that change and are not declared.
    """

    def state(self) -> dict[str, np.ndarray]:
        """Return what `evolves` names, as arrays."""
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
    """What every algorithm with one population has in section [ALGO]."""

    maxmsteps: float = million_steps(1.0)
    saveeach: float = hyper(
        60.0, "minutes between saves (0 = every generation)", low=0, high=1e6, free=True
    )


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
    """The dataclass of its hyperparameters, made with botschool.policies.hyperparameters.hyper."""
    make: Any
    """Its class: an Algorithm, or with `competitive` a Competition."""
    competitive: bool
    """Whether two sides meet (botschool.evolution.coevolution runs it)."""

    def conflicts(self, config: Any) -> Iterator[tuple[tuple[str, ...], str]]:
        """Yield hyperparameters that cannot go together: their names and a sentence with the
        remedy.
        """
        yield from getattr(self.make, "conflicts", lambda config: ())(config)


class Registry(dict[str, Entry]):
    """Algorithms by name; `module:name` is a strategy of the user's own, and is in no list."""

    own: Callable[[str], Entry]

    def __missing__(self, name: str) -> Entry:
        if ":" in name:
            return self.own(name)
        raise KeyError(name)


ALGORITHMS = Registry()
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
