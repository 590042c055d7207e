"""Any Gymnasium environment as a problem: episodes run in Python, in worker processes with -w."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError
from botschool.inifile import shown
from botschool.policy import Policy
from botschool.problems.base import Episodes, Interrupted, Outcome, Problem
from botschool.problems.making import make_env, sentence
from botschool.problems.spaces import Flattener, Unsupported, fitted, interface
from botschool.problems.transition import Transition


class GymProblem(Problem):
    """A registered Gymnasium id (also `module:id`, which imports the module first).

    An environment with a body to evolve has an attribute `morphology_size`, the number of its
    parameters, and a method `set_morphology(parameters)`, which decides on the body of the episodes
    from the next reset on.
    """

    native = False

    def __init__(self, name: str, wrapped: str = "") -> None:
        """wrapped: the wrappers around it, as an experiment file names them."""
        self.name = self.dynamics = name
        self._wrapped = wrapped
        self._wrappers = wrappers.parse(wrapped)
        self._env = make_env(name, self._wrappers)
        registered = self._env.unwrapped.spec
        self.limit = None if registered is None else registered.max_episode_steps
        self.fps = self._env.metadata.get("render_fps") or 30
        body = int(getattr(self._env.unwrapped, "morphology_size", 0))
        try:
            self._flattener = Flattener(self._env.observation_space, name)
            self.interface = interface(
                self._flattener.size, self._env.action_space, body, self._flattener.image
            )
        except Unsupported as error:
            raise BotschoolError(f"{name} cannot be evolved: its {error}.") from None
        self._pool = None

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
                self._pool = Workers((self.name, self._wrapped), policy.config, workers)
            return self._pool.evaluate(genotypes, normalisation, episodes, maxsteps, stopping)
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
        env = self._drawing() if render else self._env
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
                env.step, f"step {step} of {where}", fitted(action, space)
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
                f"{self.name} raised {type(error).__name__} in {where} ({sentence(error)[:-1]}): "
                "mend the environment."
            ) from error

    def _flat(self, raw, seed: int, episode: int) -> np.ndarray:
        try:
            flat = self._flattener(raw)
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

    def _drawing(self):
        """An environment like the own one that draws."""
        return make_env(self.name, self._wrappers, render_mode="rgb_array")

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
