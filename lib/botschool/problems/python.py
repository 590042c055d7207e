"""Run episodes in Python, in worker processes with -w: the common part of such problems."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError, said
from botschool.inifile import shown
from botschool.policies.policy import Policy
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.transition import Transition


class PythonProblem(Problem):
    """A problem whose environment is a Python object.

    A subclass sets the attributes of `Problem`, `_env` and `made`, and plays an episode.
    """

    native = False
    made: dict[str, Any]
    """The arguments of botschool.problems.make that make the same problem in a worker process."""
    _env: Any
    _pool = None

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
        if workers > 1:
            from botschool.problems.workers import Workers

            if self._pool is None:
                self._pool = Workers(self.made, policy.config, workers)
            return self._pool.evaluate(genotypes, normalisation, episodes, maxsteps, stopping)
        n, size = len(episodes), self.interface.observations
        returns = np.zeros((n,) if self.constant_sum else (self.interface.robots, n))
        outcome = Outcome(returns, np.zeros(n, dtype=np.int32))
        if episodes.collect is not None:
            outcome.moments = np.zeros((n, 2 * size))
        for i in range(n):
            if stopping():
                raise Interrupted
            policy.load(genotypes[episodes.candidate[..., i]], normalisation)
            wanted = episodes.collect is not None and episodes.collect[i]
            moments = outcome.moments[i] if wanted else None
            seed, episode = int(episodes.seed[i]), int(episodes.episode[i])
            for transition in self._episode(self._env, policy, seed, episode, maxsteps):
                returns[..., i] = transition.total if self.constant_sum else transition.totals
                outcome.steps[i] = transition.step
                if moments is not None:
                    moments[:size] += policy.network.observation
                    moments[size:] += policy.network.observation**2
        return outcome

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
        if render and "rgb_array" not in (self._env.metadata.get("render_modes") or ()):
            raise self._unseen()
        policy.load(genotype, normalisation)
        env = self._drawing() if render else self._env
        try:
            for transition in self._episode(env, policy, seed, episode, maxsteps):
                if render:
                    transition.frame = self._picture(env)
                yield transition
        finally:
            if render:
                env.close()

    def modules(self) -> set[str]:
        """Return the modules that the experiment names, and the environment's own modules."""
        named = {self.name.partition(":")[0]} if ":" in self.name else set()
        named |= {w.module for w in wrappers.parse(self.made.get("wrappers", "")) if w.module}
        env = self._env
        while env is not None:
            named |= {kind.__module__ for kind in type(env).__mro__} - {"builtins", "abc", "typing"}
            env = vars(env).get("env")
        return named

    @abstractmethod
    def _episode(
        self, env: Any, policy: Policy, seed: int, episode: int, maxsteps: int
    ) -> Iterator[Transition]:
        """Play an episode with the genotype that the policy has loaded."""

    @abstractmethod
    def _drawing(self) -> Any:
        """Return a copy of the environment that draws."""

    def _call(self, method, where: str, *arguments, **options):
        try:
            return method(*arguments, **options)
        except (Exception, SystemExit) as error:
            raise BotschoolError(
                f"{self.name} raised {type(error).__name__} in {where} ({said(error)}): "
                "mend the environment."
            ) from error

    def _flat(self, flattener, raw, seed: int, episode: int) -> np.ndarray:
        try:
            flat = flattener(raw)
        except (TypeError, ValueError, LookupError):
            what = f"an observation {shown(raw)}, which its observation_space does not contain,"
            raise self.broken(what, seed, episode) from None
        if not np.isfinite(flat).all():
            raise self.broken("an observation with NaN or infinity", seed, episode)
        return flat

    def _number(self, reward, step: int, seed: int, episode: int) -> float:
        try:
            number = float(reward)
        except (TypeError, ValueError):
            number = np.nan
        if not np.isfinite(number):
            raise self.broken(f"a reward of {shown(reward)} at step {step}", seed, episode)
        return number

    def _picture(self, env) -> np.ndarray:
        frame = np.asarray(self._call(env.render, "render"))
        if frame.ndim != 3 or frame.shape[2] != 3:
            raise self._unseen()
        return frame.astype(np.uint8)

    def _unseen(self) -> BotschoolError:
        return BotschoolError(
            f"{self.name} draws no pictures (render_mode rgb_array): leave out --video and "
            "--replay, and add --render none."
        )

    def close(self) -> None:
        """End the worker processes."""
        if self._pool is not None:
            self._pool.close()
            self._pool = None
