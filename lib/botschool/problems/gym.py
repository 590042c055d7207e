"""Make any Gymnasium environment a problem: episodes run in Python, in worker processes with -w."""

from __future__ import annotations

from collections.abc import Mapping
from types import NoneType
from typing import Any

import numpy as np

from botschool import wrappers
from botschool.errors import BotschoolError
from botschool.inifile import shown
from botschool.policies.policy import Policy
from botschool.problems.making import is_ours, make_env
from botschool.problems.pictures import rate
from botschool.problems.python import START, STEP, PythonProblem, Wrong
from botschool.problems.spaces import Flattener, Unsupported, fitted, interface
from botschool.problems.transition import Transition
from botschool.seeds import seed_libraries


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
        self._renew()
        registered = self._env.unwrapped.spec
        self.limit = None if registered is None else registered.max_episode_steps
        self.fps = rate(self._metadata, name)
        body = int(getattr(self._env.unwrapped, "morphology_size", 0))
        try:
            self._flattener = Flattener(self._env.observation_space, name)
            self.interface = interface(
                self._flattener.size,
                self._env.action_space,
                body,
                self._flattener.image,
                scaled=not is_ours(name),
            )
        except Unsupported as error:
            raise BotschoolError(f"{name} cannot be evolved: its {error}.") from None

    def _episode(self, env, policy: Policy, seed: int, episode: int, maxsteps: int):
        policy.reset(seed, episode)
        start = seed_libraries(seed, episode)
        where = f"episode {episode} of seed {seed}"
        if self.interface.morphology:
            body = policy.morphology
            self._call(env.unwrapped.set_morphology, f"set_morphology of {where}", body)
        raw = self._call(_start, f"reset of {where}", env, start)
        total, space = 0.0, env.action_space
        for step in range(1, self.steps(maxsteps) + 1):
            observation = self._flat(self._flattener, raw, seed, episode, step > 1)
            action = policy.act(observation)
            raw, reward, ended = self._call(
                _step, f"step {step} of {where}", env, fitted(action, space)
            )
            reward = self._number(reward, step, seed, episode)
            total += reward
            yield Transition(
                step, reward, total, observation, np.atleast_1d(action), policy.network.activations
            )
            if ended:
                return

    def _make(self, **options):
        return make_env(self.name, self._wrappers, **(self._options | options))


def _start(env, seed: int) -> Any:
    """Start an episode; return the observation."""
    given = env.reset(seed=seed)
    pair = isinstance(given, (tuple, list)) and len(given) == 2
    if not pair or not isinstance(given[1], (Mapping, NoneType)):
        raise Wrong(f"{START}, but it gives {shown(given)}")
    return given[0]


def _step(env, action: Any) -> tuple[Any, Any, bool]:
    """Act; return observation, reward, and whether the episode has ended."""
    given = env.step(action)
    if not isinstance(given, (tuple, list)) or len(given) != 5:
        raise Wrong(f"{STEP}, but it gives {shown(given)}")
    observation, reward, terminated, truncated, _ = given
    return observation, reward, bool(terminated or truncated)
