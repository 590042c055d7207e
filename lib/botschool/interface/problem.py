"""`botschool.problem`: returns of genotypes, at the engine's speed, for anybody's optimiser."""

from __future__ import annotations

import io
import math
import os
from contextlib import redirect_stdout, suppress
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from botschool import problems
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution import checkpoint
from botschool.evolution.evaluate import means
from botschool.interface.sources import (
    Source,
    experiment_of,
    in_python_words,
    numbers,
    seeded,
    usable,
    whole,
)
from botschool.problems import Episodes


def problem(source: Source, **hyperparameters: Any) -> Problem:
    """Return the problem of an experiment: what an optimiser needs to evolve robots for it.

    source: the name of a problem (CartPole-v1, PlanarHopper-v5, any Gymnasium id), an experiment
    file, or a dict. Further arguments are hyperparameters of experiment files, such as maxsteps;
    `hidden` is the number of hidden neurons. Raises BotschoolError.

    >>> pole = problem("CartPole-v1", hidden=8)
    >>> pole.parameters
    50
    >>> returns, steps = pole.evaluate(np.zeros((3, 50)), seeds=7)
    >>> returns.shape
    (3,)
    """
    with in_python_words():
        return Problem(experiment_of(source, hyperparameters))


class Problem:
    """A problem and a policy network, to evaluate genotypes.

    The return of an episode is a pure function of genotype, seed and number of the episode: on
    every machine, with any number of workers, in any batch. Calls from several threads are safe
    for native problems.
    """

    def __init__(self, experiment: Experiment) -> None:
        """Make the problem; `botschool.problem` does this. Raises BotschoolError."""
        self.experiment = experiment
        self._problem = problems.of(experiment)
        self._policy = self._problem.policy(experiment.policy)
        self.name: str = self._problem.name
        self.native: bool = self._problem.native
        """Whether whole episodes run in C++, on all cores."""
        self.parameters: int = self._policy.genotype_size
        """Length of a genotype: weights and biases, and parameters of the body if it evolves."""
        spec = self._policy.spec
        self._saved = self.parameters + (2 * spec.inputs if spec.normalize else 0)
        self._batches: dict[tuple[int, int], tuple[np.ndarray, np.ndarray]] = {}
        if experiment.competitive and not self.native:
            raise BotschoolError(
                f"{self.name} has two sides, so a genotype alone has no return: use evolve."
            )

    def __reduce__(self) -> tuple:
        """Pickle and copy the problem as its experiment."""
        return Problem, (self.experiment,)

    def initial(self, seed: int = 1, index: int = 0) -> np.ndarray:
        """Return a random genotype to start from, float64, shape (parameters,); each (seed, index)
        gives another.
        """
        return self._policy.initial(seeded(seed), whole("index", index, 0, 2**32 - 1))

    def evaluate(
        self,
        genotypes: ArrayLike,
        seeds: ArrayLike = 1,
        episodes: int = 1,
        workers: int | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the mean return of each genotype, float64 (n,), and its steps, int64 (n,).

        genotypes: (n, parameters), or (parameters,) for a single one. seeds: one for all, or (n,).
        A genotype plays the episodes 0, 1, ... of its seed. A saved robot that scales its
        observations (normalize = 1) is longer by the means and deviations, which are then used.
        workers: cores to use; by default all for a native problem, and 1 for one in Python. Without
        the GIL for native problems. Raises BotschoolError.
        """
        x = np.ascontiguousarray(numbers("genotypes", genotypes), dtype=np.float64)
        if x.ndim == 1:
            x = x[None]
        if x.ndim != 2 or x.shape[1] not in (self.parameters, self._saved):
            raise BotschoolError(
                f"genotypes has shape {np.shape(genotypes)}, but {self.name} needs "
                f"(n, {self.parameters}): a row of parameters for each."
            )
        ends = (np.maximum.reduce(x, axis=None), np.minimum.reduce(x, axis=None)) if x.size else ()
        if not all(map(math.isfinite, ends)):  # a sum takes longer
            row = int((~np.isfinite(x)).any(axis=1).argmax())
            raise BotschoolError(f"genotypes holds a value in row {row} that is no finite number.")
        vectors = None
        if x.shape[1] > self.parameters:  # each with vectors of its own
            vectors = np.ascontiguousarray(x[:, self.parameters :])
            x = np.ascontiguousarray(x[:, : self.parameters])
            if (vectors[:, vectors.shape[1] // 2 :] <= 0).any():
                raise BotschoolError("The genotypes' standard deviations must be above 0.")
        returns, steps = self._outcome(x, vectors, seeds, episodes, workers)
        if episodes > 1:
            steps = np.add.reduce(steps.reshape(-1, episodes), axis=1)
        return means(returns, episodes), steps.astype(np.int64)

    def returns(self, genotype: ArrayLike, seed: int, episodes: int = 20) -> np.ndarray:
        """Return a genotype's return in each of the episodes 0, 1, ... of a seed, (episodes,).

        An episode is as long as a post-evaluation's (pmaxsteps). Raises BotschoolError.
        """
        longest = self._policy.config.post_steps
        return self._outcome(*self._split(genotype), seed, episodes, None, longest)[0]

    def quantities(self) -> list[tuple[str, str, str]]:
        """Return what `reward` and `ends` may name: tuples of name, unit and meaning. Raises
        BotschoolError for a problem that is not native.
        """
        if not self.native:
            raise BotschoolError(
                f"{self.name} runs in Python, so its reward is changed by a wrapper: `botschool "
                "problems` lists those that have quantities."
            )
        return self._problem.quantities()

    def check(self, file: Path) -> None:
        """Raise BotschoolError if this version evaluates the robot in a file differently."""
        checkpoint.check_scaling(file, self._policy)

    def _split(self, genotype: ArrayLike) -> tuple[np.ndarray, np.ndarray | None]:
        parameters, vectors = self._policy.split(numbers("genotype", genotype))
        return parameters[None], vectors

    def _outcome(self, x, normalisation, seeds, episodes, workers, longest=None):
        """Return the return and the steps of each episode, genotype by genotype."""
        episodes = whole("episodes", episodes, 1, 2**32 - 1)
        batch = self._batches.get((len(x), episodes)) or self._batch(len(x), episodes)
        seed, chosen = np.empty(len(batch[0]), np.uint64), np.empty(0)
        if isinstance(seeds, int) and 0 <= seeds < 2**64:  # the usual case, in less time
            seed[:] = seeds
        else:
            with suppress(BotschoolError):
                chosen = numbers("seeds", seeds)
            wrong = chosen.dtype.kind not in "iu" or chosen.size not in (1, len(x))
            if wrong or chosen.min() < 0:
                raise BotschoolError(
                    f"seeds is {seeds!r:.40}, but must be a whole number from 0 to 2^64 - 1, or "
                    f"{len(x)} of them, one for each genotype."
                )
            seed.reshape(len(x), episodes)[:] = chosen.reshape(-1, 1)
        if workers is None:
            workers = CORES if self.native else 1
        elif workers != 1:
            workers = usable(workers, self.native)
        outcome = self._problem.evaluate(
            self._policy,
            x,
            normalisation,
            Episodes(batch[0], seed, batch[1]),
            longest or self._policy.config.maxsteps,
            workers,
        )
        return outcome.fitness, outcome.steps

    def _batch(self, n: int, episodes: int) -> tuple[np.ndarray, np.ndarray]:
        """Return rows and numbers of the episodes of n genotypes; the newest are kept."""
        if not n:
            raise BotschoolError("genotypes has no row: give at least one genotype.")
        if len(self._batches) > 20:
            self._batches.clear()
        made = Episodes.of(np.zeros(n, np.uint64), episodes)
        return self._batches.setdefault((n, episodes), (made.candidate, made.episode))

    def film(
        self, genotype: ArrayLike, path: str | os.PathLike[str], seed: int = 1, episodes: int = 1
    ) -> Path:
        """Write a film (.mp4, .webm, .gif) of the first episodes of a seed, and return its path.

        Raises BotschoolError.
        """
        from botschool.render.video import write_video
        from botschool.render.watch import PostEvaluation

        seed, episodes = seeded(seed), whole("episodes", episodes)
        with in_python_words(), redirect_stdout(io.StringIO()):
            robot = PostEvaluation(self.experiment, seed, numbers("genotype", genotype))
            robot.episodes_seed = seed
            try:
                write_video(Path(path), robot.frames(episodes, False), robot.problem.fps)
            finally:
                robot.problem.close()
        return Path(path)

    def __repr__(self) -> str:
        longest = self._problem.steps(self._policy.config.maxsteps)
        kind = "native" if self.native else "in Python"
        return (
            f"Problem({self.name}: {self.parameters} parameters, episodes of at most {longest} "
            f"steps, {kind})"
        )


CORES = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
