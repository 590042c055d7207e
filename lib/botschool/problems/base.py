"""What all problems have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import PolicyConfig
from botschool.policies.policy import Interface, Policy
from botschool.problems.transition import Transition


class Interrupted(Exception):
    """The evaluation was stopped on request; its results are dropped."""


@dataclass
class Episodes:
    """A batch of n episodes to evaluate; all arrays have shape (n,)."""

    candidate: np.ndarray
    """int32: rows of the genotypes; or shape (robots, n), a row of one network for each robot."""
    seed: np.ndarray
    """uint64."""
    episode: np.ndarray
    """uint32: together with the seed, what is random in the episode."""
    collect: np.ndarray | None = None
    """uint8: 1 where the moments of the observations are wanted."""

    @classmethod
    def of(cls, seeds: np.ndarray | list[int], episodes: int) -> Episodes:
        """`episodes` episodes of every candidate, candidate by candidate."""
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
    """What a batch of n episodes gave."""

    fitness: np.ndarray
    """float64, shape (n,): the return of each episode; of a problem of two sides without
    `constant_sum` (2, n), the return of each side."""
    steps: np.ndarray
    """int32, shape (n,)."""
    moments: np.ndarray | None = None
    """float64, shape (n, 2 * observations): sums, then sums of squares of what the network read
    (`Network.observation`)."""


class Problem(ABC):
    """An environment and the way to evaluate policies on it."""

    name: str
    interface: Interface
    limit: int | None
    fps: float
    native: bool
    dynamics: str
    """Name of the dynamics, by which pictures are drawn."""
    constant_sum: bool = True
    """Of two sides: whether an episode has one return, the first side's, and the second side gets
    1 minus it. Otherwise each has a return of its own."""
    common: bool = False
    """Of two sides without `constant_sum`: whether an episode has one return, which both get."""
    sides: tuple[str, str] = ("predator", "prey")
    """What individuals of two sides are called."""

    @property
    def roles(self) -> str:
        """Who predators and prey are, where they have other names; "" where they have not."""
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

        genotypes: float64, shape (candidates, genotype_size). Raises `Interrupted` soon after
        `stopping()` is true, and BotschoolError when the environment breaks down.
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

        With `render`, an environment in Python adds its pictures; those of native problems are
        drawn from the state (botschool.render.scene).
        """

    def sided(self, returns: np.ndarray) -> np.ndarray:
        """Return what `evaluate` gave, (n,), as the returns of both sides, (2, n), if they share
        one.
        """
        return np.stack([returns, returns]) if self.common else returns

    def rows(self, *parts: np.ndarray) -> np.ndarray:
        """Return genotypes for `evaluate`, one part after another."""
        return np.concatenate(parts)

    def modules(self) -> set[str]:
        """Return the names of the modules that its environment is made of; of a native one
        none.
        """
        return set()

    def status(self) -> str:
        """Return what a progress bar is to say of those who evaluate; often nothing."""
        return ""

    def steps(self, maxsteps: int) -> int:
        """Longest episode under an experiment's `maxsteps`."""
        return maxsteps if self.limit is None else min(maxsteps, self.limit)

    def broken(self, what: str, seed: int, episode: int) -> BotschoolError:
        """Return the error for an environment that gives something that cannot be used."""
        return BotschoolError(
            f"{self.name} gave {what} in episode {episode} of seed {seed}, so fitness cannot be "
            "measured: mend the environment, or lower stepsize, noiseStdDev or mutrate if the "
            "actions have grown without bound."
        )

    def close(self) -> None:
        """Ends what evaluation has started (worker processes)."""
