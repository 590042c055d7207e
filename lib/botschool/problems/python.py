"""Run episodes in Python, in worker processes with -w: the common part of such problems."""

from __future__ import annotations

import sys
import warnings
from abc import abstractmethod
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from hashlib import blake2b
from typing import Any

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError, Option, said
from botschool.inifile import shown
from botschool.policies.policy import Policy
from botschool.problems.base import (
    Episodes,
    Interrupted,
    Outcome,
    Problem,
    say_unrepeatable,
    vectors_of,
)
from botschool.problems.pictures import picture
from botschool.problems.transition import Transition
from botschool.seeds import libraries_kept, seed_libraries

LARGEST = 1e100
"""Largest reward: sums of such rewards, and of their squares, are still numbers."""
START = "reset must return two values, (observation, info), info a dict"
STEP = "step must return five values, (observation, reward, terminated, truncated, info)"
HINTS = {
    "argument 'seed'": "write def reset(self, seed=None, options=None)",
    "argument 'options'": "write def reset(self, seed=None, options=None)",
    "unpack": f"{START}; {STEP}",
}
"""Part of an exception's message -> what the environment must do instead."""
PROBE = 987_654_321
"""Seed of the episodes that show whether an environment repeats."""
PROBED_STEPS, PROBED_EPISODES = 400, 16
"""So many steps or episodes show it, with at most a quarter of the steps in one episode."""


class Wrong(TypeError):
    """Raised for a value that an environment must not return."""


class PythonProblem(Problem):
    """A problem whose environment is a Python object.

    A subclass sets the attributes of `Problem` and `made`, makes environments, and plays an episode
    in one. Before the first evaluation it shows whether its episodes repeat in one environment, or
    in a new one each (docs/specification.md, "Fitness is a pure function").
    """

    native = False
    fresh: bool | None = None
    """Whether every episode gets a new environment; None: not known yet."""
    made: dict[str, Any]
    """The arguments of botschool.problems.make that make the same problem in a worker process."""
    _env: Any = None
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
        if self.fresh is None and self.settle(policy, stopping) is None:
            say_unrepeatable(self.name)
        with libraries_kept():
            return self._evaluate(policy, genotypes, normalisation, episodes, maxsteps, stopping)

    def _evaluate(
        self, policy: Any, genotypes, normalisation, episodes: Episodes, maxsteps: int, stopping
    ) -> Outcome:
        n, size = len(episodes), self.interface.observations
        returns = np.zeros((n,) if self.constant_sum else (self.interface.robots, n))
        outcome = Outcome(returns, np.zeros(n, dtype=np.int32))
        if episodes.collect is not None:
            outcome.moments = np.zeros((n, 2 * size))
        for i in range(n):
            if stopping():
                raise Interrupted
            row = episodes.candidate[..., i]
            policy.load(genotypes[row], vectors_of(normalisation, row))
            wanted = episodes.collect is not None and episodes.collect[i]
            moments = outcome.moments[i] if wanted else None
            seed, episode = int(episodes.seed[i]), int(episodes.episode[i])
            if self.fresh:
                self._renew()
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
        modes = self._metadata.get("render_modes") or self._metadata.get("render.modes") or ()
        if render and "rgb_array" not in modes:
            raise self._unseen()
        if self.fresh is None:  # what an environment imports in its first steps can then be seeded
            with libraries_kept(), suppress(BotschoolError):
                self._probe(policy, [0], 1, 1, lambda: False)
        policy.load(genotype, normalisation)
        if not render:
            self._renew()
        env = self._new(render_mode="rgb_array") if render else self._env
        try:
            with libraries_kept():
                for transition in self._episode(env, policy, seed, episode, maxsteps):
                    if render:
                        transition.frame = picture(self._call(env.render, "render"), self.name)
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

    def settle(
        self, policy: Any, stopping: Callable[[], bool] = lambda: False
    ) -> dict[int, bytes] | None:
        """Find out whether every episode needs a new environment; return digests of the episodes:
        None if they do not repeat, none if they break down.

        Two environments play the same episodes, the second one in reverse: what an environment
        keeps, and what its constructor draws, differs then. If anything differs, the same is tried
        with a new environment for each episode.
        """
        steps = min(self.steps(policy.config.maxsteps), PROBED_STEPS // 4)
        seen: dict[int, bytes] | None = {}
        fresh = False
        try:
            with libraries_kept():
                ways = (True,) if self._keeps_a_world() else (False, True)
                for self.fresh in ways:
                    first = range(PROBED_EPISODES)
                    seen = self._probe(policy, first, steps, PROBED_STEPS, stopping)
                    again = self._probe(policy, reversed(seen), steps, sys.maxsize, stopping)
                    if seen == again:
                        fresh = self.fresh
                        break
                    seen = None
        except BotschoolError:  # the run meets the same fault and says it
            seen = {}
        self.begin(fresh)
        return seen

    def _keeps_a_world(self) -> bool:
        """Return whether the environment has a world of Box2D.

        It outlives reset, and keeps an order of contacts, and so roundings, of episodes before:
        too rarely for a few episodes to show it.
        """
        held = vars(getattr(self._env, "unwrapped", self._env)).values()
        return any(type(value).__module__.startswith("Box2D") for value in held)

    def begin(self, fresh: bool) -> None:
        """Make the environment for evaluation; fresh: whether every episode gets a new one.

        The first environment of a process can differ, because it imports modules that draw.
        """
        self.fresh = fresh
        with suppress(BotschoolError):  # it cannot be made twice: the first one stays
            self._renew()

    def _probe(
        self, policy: Any, numbers: Iterable[int], steps: int, most: int, stopping
    ) -> dict[int, bytes]:
        """Play these episodes, about `most` steps in all; return digests."""
        self._renew()
        seen: dict[int, bytes] = {}
        spent = 0
        for number in numbers:
            if stopping():
                self.fresh = None
                raise Interrupted
            if spent >= most:
                break
            if self.fresh and seen:
                self._renew()
            neutral = np.repeat([0.0, 1.0], self.interface.observations)
            policy.load(policy.initial(PROBE, number), neutral if policy.config.normalize else None)
            digest = blake2b()
            for transition in self._episode(self._env, policy, PROBE, number, steps):
                paid = transition.totals or transition.total
                digest.update(transition.observation.tobytes() + repr(paid).encode())
                spent += 1
            seen[number] = digest.digest()
        return seen

    def _renew(self) -> None:
        """Replace the environment by a new one."""
        if self._env is not None:
            with suppress(Exception):
                self._env.close()
        self._env = self._new()

    def _new(self, **options: Any) -> Any:
        """Return a new environment, which is the same in every process."""
        with libraries_kept(), warnings.catch_warnings():
            if self._env is not None:
                warnings.simplefilter("ignore")  # the first one has warned
            seed_libraries(0)
            return self._make(**options)

    @property
    def _metadata(self) -> dict[str, Any]:
        return getattr(self._env, "metadata", None) or {}

    @abstractmethod
    def _make(self, **options: Any) -> Any:
        """Return a new environment; options: for its constructor, besides the experiment's."""

    @abstractmethod
    def _episode(
        self, env: Any, policy: Policy, seed: int, episode: int, maxsteps: int
    ) -> Iterator[Transition]:
        """Play an episode with the genotype that the policy has loaded."""

    def _call(self, method, where: str, *arguments, **options):
        try:
            return method(*arguments, **options)
        except Wrong as error:
            raise BotschoolError(
                f"{self.name} does not work in {where} ({said(error)}): mend the environment."
            ) from None
        except (Exception, SystemExit) as error:
            hint = "".join(f"; {hint}" for part, hint in HINTS.items() if part in str(error))
            raise BotschoolError(
                f"{self.name} raised {type(error).__name__} in {where} ({said(error)}): "
                f"mend the environment{hint}."
            ) from error

    def _flat(self, flattener, raw, seed: int, episode: int, acted: bool) -> np.ndarray:
        try:
            flat = flattener(raw)
        except (TypeError, ValueError, LookupError, OverflowError):
            what = f"an observation {shown(raw)}, which its observation_space does not contain,"
            raise self.broken(what, seed, episode, acted) from None
        if not np.isfinite(flat).all():
            raise self.broken("an observation with NaN or infinity", seed, episode, acted)
        return flat

    def _number(self, reward, step: int, seed: int, episode: int) -> float:
        try:
            number = float(reward.item() if isinstance(reward, np.ndarray) else reward)
        except (TypeError, ValueError, OverflowError):
            number = None
        if number is None or isinstance(reward, (str, bytes)):
            what = f"a reward of {shown(reward)} ({type(reward).__name__}, not a number)"
            raise self.broken(f"{what} at step {step}", seed, episode, acted=False)
        if not abs(number) <= LARGEST:
            large = f" (above {LARGEST:g}: scale rewards down)" if abs(number) > LARGEST else ""
            raise self.broken(f"a reward of {shown(reward)}{large} at step {step}", seed, episode)
        return number

    def _unseen(self) -> BotschoolError:
        return BotschoolError(
            f"{self.name} draws no pictures (render_mode rgb_array)",
            Option(": leave out --video and --replay, and add --render none", ""),
            ".",
        )

    def close(self) -> None:
        """End the worker processes."""
        if self._pool is not None:
            self._pool.close()
            self._pool = None
