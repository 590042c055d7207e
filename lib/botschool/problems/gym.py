"""Make any Gymnasium environment a problem: episodes run in Python, in worker processes with -w."""

from __future__ import annotations

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems.making import make_env
from botschool.problems.python import PythonProblem
from botschool.problems.spaces import Flattener, Unsupported, fitted, interface
from botschool.problems.transition import Transition


class GymProblem(PythonProblem):
    """A registered Gymnasium id (also `module:id`, which imports the module first).

    An environment with a body to evolve has an attribute `morphology_size`, the number of its
    parameters, and a method `set_morphology(parameters)`, which sets the body of the episodes from
    the next reset on.
    """

    def __init__(self, name: str, wrapped: str = "", options: str = "") -> None:
        """Make the environment; wrapped: its wrappers, options: keywords of its constructor, both
        as in an experiment file.
        """
        self.name = self.dynamics = name
        self.made = {"name": name, "wrappers": wrapped, "options": options}
        self._wrappers = wrappers.parse(wrapped)
        self._options = wrappers.keywords(options)
        self._env = make_env(name, self._wrappers, **self._options)
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

    def _episode(self, env, policy: Policy, seed: int, episode: int, maxsteps: int):
        policy.reset(seed, episode)
        start = (seed + episode) % 2**32
        where = f"episode {episode} of seed {seed}"
        if self.interface.morphology:
            env.unwrapped.set_morphology(policy.morphology)
        raw, _ = self._call(env.reset, f"reset of {where}", seed=start)
        total, space = 0.0, env.action_space
        for step in range(1, self.steps(maxsteps) + 1):
            observation = self._flat(self._flattener, raw, seed, episode)
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

    def _drawing(self):
        return make_env(self.name, self._wrappers, render_mode="rgb_array", **self._options)
