"""Play the master tournament: predators and prey of all generations against each other.

In an arms race both sides improve, so the fitness against contemporaries hardly changes. Progress
shows only when each generation meets the competitors of all others. Two indices follow Miconi
(2009), "Why coevolution doesn't 'work': superiority and progress in coevolution". Progress is
*historical* if later generations do better against the competitors that came before them. It is
*global* if they do better against competitors at large.

A table of fitness has the shape (..., generations, generations of competitors), with rows and
columns in the order of time. The prey's table follows from the predators', because the prey's
fitness is 1 minus the predators' fitness, unless each side has a fitness of its own.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from botschool import problems
from botschool.analysis.populations import Population
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.problems import Episodes, Problem
from botschool.seeds import POST_EVALUATION_SEED, generator

ROLES = ("predators", "prey")
RESAMPLES = 1000
LEVEL = 0.95


class Contest:
    """Lets predators meet prey, each pair in `pepisodes` episodes of the run's post-evaluation.

    Raises BotschoolError if the experiment's environment does not have two robots.
    """

    problem: Problem
    """The problem; another one with the same outcomes, such as a cluster's, may replace it."""

    def __init__(self, experiment: Experiment, seed: int, workers: int = 1) -> None:
        self.problem = problems.of(experiment)
        robots = self.problem.interface.robots
        if robots != 2:
            raise BotschoolError(
                f"{self.problem.name} has {'one robot' if robots == 1 else f'{robots} robots'}: "
                "predators and prey meet in ErPredprey or an environment of PettingZoo with two "
                "agents, so give its experiment with -f."
            )
        self.policy = self.problem.policy(experiment.policy)
        self.seed = seed
        self.single = experiment.single
        """Whether one population plays both sides."""
        self._workers = workers

    @property
    def roles(self) -> str:
        """Return a note about what predators and prey are, "" if it is obvious."""
        if not self.single:
            return self.problem.roles
        first, second = self.problem.sides
        return (
            f"one population: its predators are its individuals as {first}, "
            f"its prey those as {second}"
        )

    def __enter__(self) -> Contest:
        return self

    def __exit__(self, *error: object) -> None:
        self.problem.close()

    def meet(self, predators: np.ndarray, prey: np.ndarray) -> np.ndarray:
        """Return the predators' fitness, shape (predators, prey); both given as (n, nparameters).

        Unless the prey's fitness is 1 minus it (`problem.constant_sum`), return the fitness of both
        sides, (2, predators, prey).
        """
        repeats = self.policy.config.pepisodes
        # Neighbouring episodes share a predator, so its parameters stay in the cache.
        pairs = np.indices((len(predators), len(prey)), dtype=np.int32).reshape(2, -1)
        pairs[1] += len(predators)
        count = pairs.shape[1] * repeats
        episodes = Episodes(
            np.repeat(pairs, repeats, axis=1),
            np.full(count, self.seed + POST_EVALUATION_SEED, dtype=np.uint64),
            np.tile(np.arange(repeats, dtype=np.uint32), pairs.shape[1]),
        )
        outcome = self.problem.evaluate(
            self.policy,
            self.problem.rows(predators, prey),
            None,
            episodes,
            self.policy.config.maxsteps,
            self._workers,
        )
        fitness = self.problem.sided(outcome.fitness)
        shape = *fitness.shape[:-1], len(predators), len(prey), repeats
        return fitness.reshape(shape).mean(axis=-1)


def play(
    contest: Contest,
    predators: Sequence[np.ndarray],
    prey: Sequence[np.ndarray],
    report: Callable[[int], None] = lambda done: None,
) -> np.ndarray:
    """Play predators of several generations against prey of several generations.

    All generations of one side have the same number of individuals. Return the predators' fitness,
    float64, of shape (generations of predators, generations of prey, predators, prey), or the
    fitness of both sides, (2, ...). `report` gets the number of generations of predators that are
    done.
    """
    competitors = np.concatenate(prey)
    parts = []
    for done, group in enumerate(predators, 1):
        fitness = contest.meet(group, competitors)
        shape = *fitness.shape[:-2], len(group), len(prey), -1
        parts.append(fitness.reshape(shape).swapaxes(-3, -2))
        report(done)
    return np.stack(parts, axis=-4)


@dataclass(frozen=True)
class Table:
    """Mean fitness of one side's generations (rows) against the other side's (columns)."""

    role: str
    mean: np.ndarray
    """(generations, generations of competitors)."""
    samples: np.ndarray
    """(RESAMPLES, generations, generations of competitors): the means of resampled individuals."""

    @property
    def interval(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the lower and upper end of each mean's 95 % interval."""
        return interval(self.samples)


def summarised(fitness: np.ndarray, seed: int) -> tuple[Table, Table]:
    """Return the predators' and the prey's table from the result of `play`.

    Intervals come from the bootstrap over individuals. Each resample draws every generation of both
    sides anew from its own individuals, with replacement. All cells of the table use that one draw,
    so indices that combine several cells get correct intervals, too. Drawing both sides is slightly
    conservative (Owen 2007, "The pigeonhole bootstrap"). The draws depend only on the seed.
    """
    rng = generator(seed, POST_EVALUATION_SEED)
    rows, columns, predators, prey = fitness.shape[-4:]
    own = rng.multinomial(predators, np.full(predators, 1 / predators), (RESAMPLES, rows))
    met = rng.multinomial(prey, np.full(prey, 1 / prey), (RESAMPLES, columns))

    def resampled(fitness: np.ndarray) -> np.ndarray:
        samples = [
            np.einsum("ijm,jm->ij", np.einsum("in,ijnm->ijm", own[k] / predators, fitness), met[k])
            for k in range(RESAMPLES)
        ]
        return np.array(samples) / prey

    if fitness.ndim == 5:
        (mean, other), (samples, others) = fitness.mean(axis=(3, 4)), map(resampled, fitness)
    else:
        mean, samples = fitness.mean(axis=(2, 3)), resampled(fitness)
        other, others = 1 - mean, 1 - samples
    prey_table = Table(ROLES[1], other.T, others.transpose(0, 2, 1))
    return Table(ROLES[0], mean, samples), prey_table


def interval(samples: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the lower and upper end of the 95 % interval: percentiles over the first axis."""
    low, high = np.quantile(samples, [(1 - LEVEL) / 2, (1 + LEVEL) / 2], axis=0)
    return low, high


def historical_progress(fitness: np.ndarray) -> np.ndarray:
    """Return how much better later generations do against ancient competitors than earlier ones.

    With f(g, k) the mean fitness of generation g against the competitors of generation k:

        mean over all pairs i < j of   mean over all k <= i of   f(j, k) - f(i, k)

    Both generations of a pair meet the same competitors, from generation 0 to i. The unit is
    fitness. 0 means no progress. Below 0, later generations have lost what earlier ones could do (a
    little below if strategies come and go in cycles, because each is at its best against
    competitors of its own time). fitness: (..., g, g) with g >= 2; returns (...).
    """
    count = fitness.shape[-1]
    ancient = np.cumsum(fitness, axis=-1) / np.arange(1, count + 1)
    earlier, later = np.triu_indices(count, 1)
    return (ancient[..., later, earlier] - ancient[..., earlier, earlier]).mean(axis=-1)


def global_progress(fitness: np.ndarray) -> np.ndarray:
    """Return how much better later generations do against all competitors than earlier ones.

        mean over all pairs i < j of   mean over all k of   f(j, k) - f(i, k)

    k runs over the competitors of all generations, ancient and future: the best sample of all
    possible competitors that a run has. Shapes and units as in historical_progress.
    """
    overall = fitness.mean(axis=-1)
    earlier, later = np.triu_indices(fitness.shape[-1], 1)
    return (overall[..., later] - overall[..., earlier]).mean(axis=-1)


PROGRESS = {"historical progress": historical_progress, "global progress": global_progress}


@dataclass(frozen=True)
class Estimate:
    """A number and its 95 % interval."""

    value: float
    low: float
    high: float

    @classmethod
    def of(cls, value: Any, samples: np.ndarray) -> Estimate:
        """Return the number and the interval of its resamples, shape (RESAMPLES,)."""
        low, high = interval(samples)
        return cls(float(value), float(low), float(high))


def progress(table: Table) -> dict[str, Estimate]:
    """Return both indices of a side, by name."""
    return {
        name: Estimate.of(index(table.mean), index(table.samples))
        for name, index in PROGRESS.items()
    }


def verdict(table: Table, names: Sequence[str]) -> str:
    """Return a sentence on whether later generations do better against ancient competitors.

    The answer is yes or no only if 0 is outside the interval of the historical progress. names: the
    names of the generations.
    """
    own, other = ROLES if table.role == ROLES[0] else ROLES[::-1]
    found = progress(table)
    historical = found["historical progress"]
    if historical.low > 0:
        said = f"Later {own} do better against ancient {other} than earlier {own} did"
    elif historical.high < 0:
        said = f"Later {own} do worse against ancient {other} than earlier {own} did"
    else:
        said = f"Later {own} do neither clearly better nor worse against ancient {other}"
    numbers = "; ".join(f"{name} {in_words(estimate, '+')}" for name, estimate in found.items())
    last = table.mean[-1]
    return (
        f"{said}: {numbers}; the {own} of {names[-1]} reach {last[0]:.2f} against the {other} of "
        f"{names[0]} and {last[-1]:.2f} against those of their own generation."
    )


def in_words(estimate: Estimate, sign: str = "") -> str:
    """Return the number with its interval, such as "0.31 (95 % interval 0.25 to 0.36)".

    sign: "+" shows the sign of a difference, and one more decimal.
    """
    form = f"{sign}.{3 if sign else 2}f"
    return (
        f"{estimate.value:{form}} (95 % interval {estimate.low:{form}} to {estimate.high:{form}})"
    )


def master_tournament(
    contest: Contest,
    populations: Sequence[Population],
    report: Callable[[int], None] = lambda done: None,
) -> tuple[Table, Table]:
    """Let all meet all; return the predators' and the prey's table over these populations."""
    fitness = play(
        contest,
        [population.predators for population in populations],
        [population.prey for population in populations],
        report,
    )
    return summarised(fitness, contest.seed)
