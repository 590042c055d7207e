"""Define the common part of all problems."""

from __future__ import annotations

import multiprocessing
import sys
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Interface, Policy
from botschool.problems.transition import Transition


class Interrupted(Exception):
    """Raised if the evaluation was stopped on request; its results are dropped."""


@dataclass
class Episodes:
    """A batch of n episodes to evaluate; all arrays have shape (n,)."""

    candidate: np.ndarray
    """int32: rows of the genotypes; or shape (robots, n), a row of one network for each robot."""
    seed: np.ndarray
    """uint64."""
    episode: np.ndarray
    """uint32: together with the seed, it determines everything random in the episode."""
    collect: np.ndarray | None = None
    """uint8: 1 for episodes that collect the moments of the observations."""

    @classmethod
    def of(cls, seeds: np.ndarray | list[int], episodes: int) -> Episodes:
        """Return `episodes` episodes of every candidate, candidate by candidate."""
        n = len(seeds)
        return cls(
            np.repeat(np.arange(n, dtype=np.int32), episodes),
            np.repeat(np.asarray(seeds, dtype=np.uint64), episodes),
            np.tile(np.arange(episodes, dtype=np.uint32), n),
        )

    def select(self, chosen: slice) -> Episodes:
        """Return some of the episodes."""
        collect = None if self.collect is None else self.collect[chosen]
        return Episodes(
            self.candidate[..., chosen], self.seed[chosen], self.episode[chosen], collect
        )

    def __len__(self) -> int:
        return len(self.seed)


@dataclass
class Outcome:
    """Results of a batch of n episodes."""

    fitness: np.ndarray
    """float64, shape (n,): the return of each episode; of a problem of two sides without
    `constant_sum` (2, n), the return of each side.
    """
    steps: np.ndarray
    """int32, shape (n,)."""
    moments: np.ndarray | None = None
    """float64, shape (n, 2 * observations): sums, then sums of squares of what the network read
    (`Network.observation`).
    """


class Problem(ABC):
    """An environment and the way to evaluate policies on it."""

    name: str
    interface: Interface
    limit: int | None
    fps: float
    native: bool
    dynamics: str
    """Name of the dynamics, which selects the pictures."""
    constant_sum: bool = True
    """For two sides: whether the second side's return is 1 minus the first side's. Otherwise each
    side has a return of its own.
    """
    common: bool = False
    """For two sides without `constant_sum`: whether both get the same return."""
    sides: tuple[str, str] = ("predator", "prey")
    """Names of the individuals of two sides."""
    robot: Any = None
    """The robot of one's own (problems.robot.Robot), of which a run keeps the tables."""

    @property
    def roles(self) -> str:
        """Return a note about predators and prey if they have other names; else ""."""
        if self.sides == Problem.sides:
            return ""
        return f"predators are {self.sides[0]}, prey are {self.sides[1]}"

    def policy(self, config: PolicyConfig) -> Any:
        """Return the policy that a [POLICY] section describes. Raises BotschoolError."""
        return Policy(self.name, self.interface, config)

    @abstractmethod
    def evaluate(
        self,
        policy: Policy,
        genotypes: np.ndarray,
        normalisation: np.ndarray | None,
        episodes: Episodes,
        maxsteps: int,
        workers: int = 1,
        stopping: Callable[[], bool] = lambda: False,
    ) -> Outcome:
        """Run the episodes. The outcome is a pure function of the first five arguments.

        genotypes: float64, shape (candidates, genotype_size). normalisation: vectors of all
        candidates, or (candidates, 2 * observations), a row for each. Raises `Interrupted` soon
        after `stopping()` is true, and BotschoolError if the environment breaks down.
        """

    @abstractmethod
    def play(
        self,
        policy: Policy,
        genotype: np.ndarray,
        normalisation: np.ndarray | None,
        seed: int,
        episode: int,
        maxsteps: int,
        render: bool = False,
    ) -> Iterator[Transition]:
        """Run one episode, the same that `evaluate` runs, and yield every step.

        With `render`, an environment in Python adds its pictures. botschool.render.scene draws
        native problems from the state.
        """

    def sided(self, returns: np.ndarray) -> np.ndarray:
        """Return `evaluate`'s result, (n,), as returns of both sides, (2, n), if they share one."""
        return np.stack([returns, returns]) if self.common else returns

    def rows(self, *parts: np.ndarray) -> np.ndarray:
        """Return genotypes for `evaluate`, one part after another."""
        return np.concatenate(parts)

    def modules(self) -> set[str]:
        """Return the names of the environment's modules; a native problem has none."""
        return set()

    def status(self) -> str:
        """Return the workers' state for a progress bar; often ""."""
        return ""

    def steps(self, maxsteps: int) -> int:
        """Return the longest episode under an experiment's `maxsteps`."""
        return maxsteps if self.limit is None else min(maxsteps, self.limit)

    def broken(self, what: str, seed: int, episode: int, acted: bool = True) -> BotschoolError:
        """Return the error for an environment that returns an unusable value; acted: whether it had
        got an action in this episode.
        """
        grown = (
            ", or lower stepsize, noiseStdDev or mutrate if the actions have grown without bound"
        )
        return BotschoolError(
            f"{self.name} gave {what} in episode {episode} of seed {seed}, so fitness cannot be "
            f"measured: mend the environment{grown if acted else ''}."
        )

    def close(self) -> None:
        """End the worker processes that evaluation has started."""


def vectors_of(normalisation: np.ndarray | None, candidate: Any) -> np.ndarray | None:
    """Return the normalisation vectors of a candidate, or of several, as `evaluate` takes them."""
    own = normalisation is not None and normalisation.ndim == 2
    return normalisation[candidate] if own else normalisation


@cache
def say(sentence: str) -> None:
    """Print a note on stderr, once in a program."""
    if multiprocessing.parent_process() is None:
        print(f"note: {sentence}", file=sys.stderr)


def say_unrepeatable(name: str) -> None:
    """Print that an environment does not repeat, and why it matters."""
    say(
        f"{name} does not repeat: an episode played again from the same seed is not the "
        "same, so the same command, -w, --resume and -p give other results: let reset set "
        "everything anew, and draw random numbers from self.np_random only"
    )
