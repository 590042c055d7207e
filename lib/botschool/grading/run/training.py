"""Watch a training in the confined child: where it acted, and where its losses have led.

The environment is changed, so that parameters which the student wrote down act wrongly in it. Who
trains in it does not notice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from dataclasses import dataclass, field
from functools import partial
from inspect import signature
from typing import Any
from unittest.mock import patch

import numpy as np

from botschool.grading.run.pulse import alive, beat
from botschool.grading.run.replaced import replaced

FEW = 100
"""First actions that a record holds."""


@dataclass
class Training:
    """What a training has done."""

    returns: list[float] = field(default_factory=list)
    """Of each episode."""
    seeds: list[int | None] = field(default_factory=list)
    """With which each episode began."""
    actions: list[float] = field(default_factory=list)
    """The first number of the first actions."""
    gradients: int = 0
    """How often torch has followed a loss back."""
    first: list[np.ndarray] = field(default_factory=list)
    """What torch's optimisers had before their first step."""
    values: dict[str, set[bytes]] = field(default_factory=dict)
    """The different values that an argument of a function had."""
    _tables: list[np.ndarray] = field(default_factory=list)

    def led_to(self, answer: Any) -> bool:
        """Return whether a table in an answer is one that an optimiser's step has made."""
        if isinstance(answer, (dict, list, tuple)):
            return any(map(self.led_to, answer.values() if isinstance(answer, dict) else answer))
        same = [each for each in self._tables if each.shape == np.shape(answer)]
        return any(np.allclose(each, answer, 1e-4, 1e-5) for each in same)

    def lost(self, function: Callable[..., Any], *given: Any, **named: Any) -> Any:
        """Call a loss, and count the gradients that go through it."""
        loss = function(*given, **named)
        if getattr(loss, "requires_grad", False):
            loss.register_hook(self._count)
        return loss

    def _count(self, _: Any) -> None:
        self.gradients += 1

    def noted(
        self, name: str, place: int, function: Callable[..., Any], *given: Any, **named: Any
    ) -> Any:
        """Call a function, and keep the value of the argument at a place."""
        import torch

        with suppress(Exception):  # of an argument that is not what it should be
            names = [*signature(function).parameters] if named else []
            value = named[names[place]] if len(given) <= place else given[place]
            numbers = torch.as_tensor(value).detach().numpy()
            self.values.setdefault(name, set()).add(numbers.tobytes())
        return function(*given, **named)

    def step_begins(self, optimiser: Any, *_: Any) -> None:
        """Keep the parameters if it is the first step."""
        self.first = self.first or _parameters(optimiser)

    def step_ends(self, optimiser: Any, *_: Any) -> None:
        """Keep the tables."""
        beat()
        self._tables += [each for each in _parameters(optimiser) if each.ndim == 2]


def _parameters(optimiser: Any) -> list[np.ndarray]:
    groups = [group["params"] for group in optimiser.param_groups]
    return [each.detach().numpy().copy() for group in groups for each in group]


class _Enough(BaseException):
    """The grader has seen enough of a training."""


@contextmanager
def watching(
    module: Any,
    environment: str,
    signs: np.ndarray,
    side: int,
    most: int,
    losses: tuple[str, ...],
    arguments: dict[str, int],
) -> Iterator[Training]:
    """Change an environment of Gymnasium within the block, and record what a training does.

    Each number observed is multiplied by its sign; with side -1, left and right of the action are
    exchanged. The block ends after `most` episodes. losses: names of functions of the module whose
    gradients count. arguments: names of others -> the place of the argument whose values are kept.
    """
    from gymnasium.envs import registration
    from torch.optim import optimizer as optimisers

    spec, seen = registration.spec(environment), Training()
    made = registration.load_env_creator(spec.entry_point)
    reset, step = made.reset, made.step

    def changed_reset(env: Any, **kwargs: Any) -> tuple:
        if len(seen.returns) >= most:
            raise _Enough
        observation, info = reset(env, **kwargs)
        env.number_of_the_grader = len(seen.returns)
        seen.returns.append(0.0)
        seen.seeds.append(kwargs.get("seed"))
        return (signs * observation).astype(observation.dtype), info

    def changed_step(env: Any, action: Any) -> tuple:
        beat()
        if len(seen.actions) < FEW:
            seen.actions.append(float(np.ravel(action)[0]))
        if side < 0:
            action = env.action_space.n - 1 - action if hasattr(env.action_space, "n") else -action
        observation, reward, *ends = step(env, action)
        seen.returns[env.number_of_the_grader] += float(reward)
        return (signs * observation).astype(observation.dtype), reward, *ends

    with ExitStack() as stack, suppress(_Enough):
        stack.enter_context(alive())
        stack.enter_context(patch.object(spec, "vector_entry_point", None))
        stack.enter_context(patch.multiple(made, reset=changed_reset, step=changed_step))
        for name, place in arguments.items():
            noted = partial(partial, seen.noted, name, place)
            stack.enter_context(replaced(module, name, noted))
        for name in losses:
            stack.enter_context(replaced(module, name, partial(partial, seen.lost)))
        stack.callback(optimisers.register_optimizer_step_pre_hook(seen.step_begins).remove)
        stack.callback(optimisers.register_optimizer_step_post_hook(seen.step_ends).remove)
        yield seen
