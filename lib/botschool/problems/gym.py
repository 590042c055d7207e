"""Any Gymnasium environment as a problem: episodes run in Python, in worker processes with -w."""

from __future__ import annotations

import difflib
import importlib.util
import multiprocessing
import os
import sys
import warnings
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool.errors import BotschoolError
from botschool.inifile import shown
from botschool.policy import Interface, Policy
from botschool.problems import faces  # noqa: F401  (registers our own)
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.native import NATIVE
from botschool.problems.transition import Transition

SUPPORTED = (
    "policies read flat observations (a Box of one dimension, Discrete, MultiDiscrete or "
    "MultiBinary) and give Discrete actions or a Box of one dimension"
)

PACKAGES = {"BalanceBotBulletEnv-v0": "balance_bot"}
"""Environments of the course in packages of their own, which register them on import."""


class GymProblem(Problem):
    """A registered Gymnasium id (also `module:id`, which imports the module first).

    An environment with a body to evolve has an attribute `morphology_size`, the number of its
    parameters, and a method `set_morphology(parameters)`, which decides on the body of the episodes
    from the next reset on.
    """

    native = False

    def __init__(self, name: str) -> None:
        self.name = self.dynamics = name
        self._env = make_env(name)
        self.limit = None if self._env.spec is None else self._env.spec.max_episode_steps
        self.fps = self._env.metadata.get("render_fps") or 30
        self._observation_space = self._env.observation_space
        self.interface = self._interface()
        self._pool = None

    def _interface(self) -> Interface:
        observed, acted = self._env.observation_space, self._env.action_space
        if isinstance(observed, spaces.Box):
            if len(observed.shape) != 1 or observed.dtype.kind not in "fiub":
                kind = "images" if len(observed.shape) > 1 else f"{observed.dtype} values"
                raise self._unsupported(f"observations are {kind} of shape {observed.shape}")
        elif not isinstance(observed, (spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)):
            raise self._unsupported(f"observations are a nested {type(observed).__name__} space")
        size = spaces.flatdim(observed)
        body = int(getattr(self._env.unwrapped, "morphology_size", 0))
        if isinstance(acted, spaces.Discrete):
            return Interface(size, int(acted.n), discrete=True, morphology=body)
        if not isinstance(acted, spaces.Box) or len(acted.shape) != 1:
            raise self._unsupported(f"actions are {acted}")
        low, high = np.unique(acted.low), np.unique(acted.high)
        common = len(low) == len(high) == 1 and np.isfinite([low[0], high[0]]).all()
        return Interface(
            size,
            acted.shape[0],
            discrete=False,
            low=float(low[0]) if common else None,
            high=float(high[0]) if common else None,
            morphology=body,
        )

    def _unsupported(self, what: str) -> BotschoolError:
        return BotschoolError(
            f"{self.name} cannot be evolved: its {what}, but {SUPPORTED}; a gymnasium wrapper "
            "can convert it."
        )

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
                self._pool = Workers(self.name, policy.config, maxsteps, workers)
            return self._pool.evaluate(genotypes, normalisation, episodes, stopping)
        n, size = len(episodes), self.interface.observations
        outcome = Outcome(np.zeros(n), np.zeros(n, dtype=np.int32))
        if episodes.collect is not None:
            outcome.moments = np.zeros((n, 2 * size))
        for i in range(n):
            if stopping():
                raise Interrupted
            policy.load(genotypes[episodes.candidate[i]], normalisation)
            wanted = episodes.collect is not None and episodes.collect[i]
            moments = outcome.moments[i] if wanted else None
            seed, episode = int(episodes.seed[i]), int(episodes.episode[i])
            for transition in self._episode(self._env, policy, seed, episode, maxsteps):
                outcome.fitness[i] = transition.total
                outcome.steps[i] = transition.step
                if moments is not None:
                    moments[:size] += transition.observation
                    moments[size:] += transition.observation**2
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
        env = make_env(self.name, render_mode="rgb_array") if render else self._env
        try:
            for transition in self._episode(env, policy, seed, episode, maxsteps):
                if render:
                    transition.frame = self._picture(env)
                yield transition
        finally:
            if render:
                env.close()

    def _episode(self, env, policy: Policy, seed: int, episode: int, maxsteps: int):
        policy.reset(seed, episode)
        start = (seed + episode) % 2**32
        where = f"episode {episode} of seed {seed}"
        if self.interface.morphology:
            env.unwrapped.set_morphology(policy.morphology)
        raw, _ = self._call(env.reset, f"reset of {where}", seed=start)
        total, space = 0.0, env.action_space
        for step in range(1, self.steps(maxsteps) + 1):
            observation = self._flat(raw, seed, episode)
            action = policy.act(observation)
            raw, reward, terminated, truncated, _ = self._call(
                env.step, f"step {step} of {where}", _fitted(action, space)
            )
            reward = self._number(reward, step, seed, episode)
            total += reward
            yield Transition(
                step, reward, total, observation, np.atleast_1d(action), policy.network.activations
            )
            if terminated or truncated:
                return

    def _call(self, method, where: str, *arguments, **options):
        try:
            return method(*arguments, **options)
        except (Exception, SystemExit) as error:
            raise BotschoolError(
                f"{self.name} raised {type(error).__name__} in {where} ({_sentence(error)[:-1]}): "
                "mend the environment."
            ) from error

    def _flat(self, raw, seed: int, episode: int) -> np.ndarray:
        observed = self._observation_space
        try:
            flat = raw if isinstance(observed, spaces.Box) else spaces.flatten(observed, raw)
            flat = np.asarray(flat, dtype=np.float32).astype(np.float64)
        except (TypeError, ValueError, LookupError):
            flat = np.zeros(0)
        if flat.shape != (self.interface.observations,):
            what = f"an observation {shown(raw)}, which its observation_space does not contain,"
            raise self.broken(what, seed, episode)
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
        """Ends worker processes."""
        if self._pool is not None:
            self._pool.close()
            self._pool = None


def _fitted(action: np.ndarray | int, space):
    """An action that the space contains: discrete ones start where it does, others are clipped."""
    if isinstance(space, spaces.Discrete):
        return space.start + action
    if not np.isfinite(action).all():
        action = np.nan_to_num(action)
    fitted = np.minimum(np.maximum(action, space.low), space.high)  # a third of np.clip's time
    return fitted.astype(space.dtype, copy=False)


def make_env(name: str, **options) -> gymnasium.Env:
    """gymnasium.make with errors for learners; a `module:` may lie in the present folder."""
    if ":" in name:
        if os.getcwd() not in sys.path:
            sys.path.insert(0, os.getcwd())
        _say_if_local(name.partition(":")[0])
    if name in PACKAGES and name not in gymnasium.registry:
        _import_package(name)
    own = f"botschool/{name}"
    env_id = own if own in gymnasium.registry else name  # others may have taken our plain id
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # errors say it in a sentence
            return gymnasium.make(env_id, disable_env_checker=True, **options)
    except (gymnasium.error.DependencyNotInstalled, ModuleNotFoundError) as error:
        raise BotschoolError(
            f"{name} needs a package that is not installed: {_sentence(error)}"
        ) from None
    except gymnasium.error.UnregisteredEnv:
        module, colon, own = name.rpartition(":")
        known = [*NATIVE, *PACKAGES, *gymnasium.registry]
        near = difflib.get_close_matches(own, known, n=1, cutoff=0.65)
        hint = "is the package that has it installed?"
        if near:
            hint = f"did you mean {module}{colon}{near[0]}?"
        raise BotschoolError(f"There is no environment '{name}'; {hint}") from None
    except Exception as error:
        raise BotschoolError(f"{name} cannot be made: {_sentence(error)}") from error


@cache
def _say_if_local(module: str) -> None:
    """A line on stderr, once, when a module is taken from the present folder."""
    if multiprocessing.parent_process() is not None:
        return
    try:
        spec = importlib.util.find_spec(module.partition(".")[0])
    except (ImportError, ValueError):
        return
    places = [] if spec is None else [spec.origin, *(spec.submodule_search_locations or ())]
    for place in filter(None, places):
        if Path(place).parent.resolve() == Path.cwd().resolve():
            print(f"{module} is taken from the present folder: {place}", file=sys.stderr)
            return


def _import_package(name: str) -> None:
    try:
        importlib.import_module(PACKAGES[name])
    except ModuleNotFoundError as error:
        if error.name != PACKAGES[name]:
            raise BotschoolError(f"{name} cannot be made: {_sentence(error)}") from None
        raise BotschoolError(
            f"{name} comes in a package of its own, which exercise 10 builds: install it with "
            f"'pip install -e envs/{error.name}', or the one that you have built yourself."
        ) from None


def _sentence(error: Exception) -> str:
    text = " ".join(str(error).split()) or type(error).__name__
    return text if text.endswith(".") else text + "."
