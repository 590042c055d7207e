"""Watch a submission learn on an environment of the grader.

All but `lasted` runs in the submission's process. What it reports can be forged, so the grader
plays what the submission has learnt itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from functools import partial
from typing import Any
from unittest import mock

import gymnasium
import numpy as np

from botschool.envs.native import NativeEnv
from botschool.grading.run.pulse import beat

Layers = list[tuple[np.ndarray, np.ndarray]]
"""Weights and biases of each layer of a network."""


class BrokenOff(BaseException):
    """As many episodes have begun as the grader wants to see."""


class Turned(gymnasium.Wrapper):
    """A native problem with parts that are turned round; it notes each episode's first action.

    signs: of the observations. side: the sign of actions. episodes: after so many it breaks off.
    """

    def __init__(
        self,
        problem: str,
        signs: list[float],
        side: float,
        episodes: float = np.inf,
        render_mode: str | None = None,
    ) -> None:
        super().__init__(NativeEnv(problem, render_mode))
        self.signs, self.side, self.episodes = np.array(signs, dtype=np.float32), side, episodes
        self.actions: list[np.ndarray] = []
        self._begins = False

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple:
        if len(self.actions) >= self.episodes:
            raise BrokenOff
        self._begins = True
        observation, info = self.env.reset(seed=seed, options=options)
        return self.signs * observation, info

    def step(self, action: Any) -> tuple:
        beat()
        if self._begins:
            self.actions.append(np.array(action))
        self._begins = False
        observation, *rest = self.env.step(self.side * np.asarray(action))
        return self.signs * observation, *rest


def lasted(layers: Layers, robot: dict[str, Any], seed: int, episodes: int, most: int) -> list[int]:
    """Return how many steps some episodes last, `most` at most, under a network of tanh layers.

    robot: arguments of Turned. The last layer has no tanh.
    """
    env, found = Turned(**robot), []
    for episode in range(episodes):
        (signal, _), step, ended = env.reset(seed=seed + episode), 0, False
        while step < most and not ended:
            for number, (weights, biases) in enumerate(layers):
                signal = weights @ (np.tanh(signal) if number else signal) + biases
            signal, _, ended, _, _ = env.step(signal)
            step += not ended
        found.append(step)
    return found


class Updates:
    """What PPO has made of actors, the networks from observations to actions."""

    def __init__(self) -> None:
        self._begun: dict[int, tuple[Any, list]] = {}
        self._made: list[tuple[list, list]] = []

    def watch(self, update: Any, model: Any) -> None:
        """Let a model make an update."""
        _, before = self._begun.setdefault(id(model), (model, self._actor(model)))
        update(model)
        self._made.append((before, self._actor(model)))

    @staticmethod
    def _actor(model: Any) -> list[np.ndarray]:
        parts = dict(model.policy.named_parameters())
        names = [name for name in parts if "policy_net" in name or "action_net" in name]
        return [parts[name].detach().cpu().numpy().copy() for name in names]

    def change_of(self, layers: Any) -> float:
        """Return by how much PPO has changed the largest of these layers on average.

        0 if they are not those of an actor after an update. layers: [weights, biases] each.
        """
        try:
            parts = [np.asarray(part, dtype=float) for layer in layers for part in layer]
        except (TypeError, ValueError):
            return 0.0
        for before, after in reversed(self._made):
            same_shapes = [part.shape for part in parts] == [part.shape for part in after]
            if same_shapes and all(map(_near, parts, after)):
                largest = max(range(len(parts)), key=lambda i: parts[i].size)
                return float(np.abs(after[largest] - before[largest]).mean())
        return 0.0


def _near(one: np.ndarray, other: np.ndarray) -> bool:
    return np.allclose(one, other, atol=1e-5)


@contextmanager
def watching_ppo() -> Iterator[Updates]:
    """Yield what PPO of Stable-Baselines3 makes within the block."""
    from stable_baselines3 import PPO
    from torch.optim import optimizer as optimisers

    updates, update = Updates(), PPO.train
    with ExitStack() as stack:
        watch = partial(updates.watch, update)
        stack.enter_context(mock.patch.object(PPO, "train", lambda model: watch(model)))
        hook = optimisers.register_optimizer_step_post_hook(lambda *_: beat())
        stack.callback(hook.remove)
        yield updates


def learnt(module, name, environment, robot, seed, episodes, ppo):
    """Call a function of the submission that learns in an environment; a driver.

    environment: the name that the grader's stands for. robot, episodes: arguments of Turned.
    ppo: whether to watch PPO. Returns the answer, the first action of each episode, and what
    Updates.change_of returns of the answer.
    """
    import contextlib

    import gymnasium

    from botschool.grading.run.learning import BrokenOff, Turned, watching_ppo
    from botschool.grading.run.pulse import alive

    made, answer = [], None

    def make(render_mode=None):
        made.append(Turned(**robot, episodes=episodes, render_mode=render_mode))
        made[-1].actions = made[0].actions
        return made[-1]

    gymnasium.registry.pop(environment, None)
    gymnasium.register(environment, make, max_episode_steps=500)
    watched = watching_ppo() if ppo else contextlib.nullcontext()
    with watched as updates, alive(), contextlib.suppress(BrokenOff):  # imports take seconds
        answer = getattr(module, name)(seed)
    actions = made[0].actions if made else []
    return [answer, actions, updates.change_of(answer) if ppo else 0.0]
