"""Watch in the confined child where steps along gradients lead the parameters of networks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from typing import Any
from unittest.mock import patch

import numpy as np

from botschool.grading.declare.checks import expect
from botschool.grading.run.pulse import alive, beat
from botschool.grading.run.replaced import replaced

MOST_WALKS, MOST_PLACES, MOST_NETWORKS = 50, 3000, 20
"""What is kept: of walks, of the last places of each, and of the first weights of networks."""
LEAP = 5
"""How many times as long as all steps before it a step is that begins a new walk."""
GRADIENTS = 30
"""That a training computes at least; exercise 11's solution computes 300 before its first look."""
COME, NEAR = 0.15, 1e-4
"""Shares of the size of a walk's end: how far it comes at least; what counts as no distance."""


@dataclass
class Walk:
    """Places, each a step from the one before."""

    start: np.ndarray
    last: list[np.ndarray]
    steps: int = 0
    longest: float = 0.0


@dataclass
class Walks:
    """Where gradients were computed: the numbers of all parameters are a place."""

    gradients: int = 0
    networks: int = 0
    repeated: bool = False
    """Whether a network learns from the very weights that an earlier one began with."""
    _walks: dict[int, list[Walk]] = field(default_factory=dict)
    _beginnings: list[np.ndarray] = field(default_factory=list)
    _again: list[np.ndarray] = field(default_factory=list)

    def note(self, values: list[Any]) -> None:
        """Go on with a walk, or begin one; values: the parameters as they are now."""
        values = sorted(values, key=lambda each: tuple(each.shape))
        place = np.concatenate([np.ravel(np.array(each, float)) for each in values])
        self.repeated |= any(np.array_equal(np.sort(place), each) for each in self._again)
        own = self._walks.setdefault(len(place), [])
        step = float(np.linalg.norm(place - own[-1].last[-1])) if own else 0.0
        if not own or (own[-1].steps >= 5 and step > LEAP * own[-1].longest > 0):
            own.append(Walk(place, [place]))
            del own[:-MOST_WALKS]
            return
        walk = own[-1]
        walk.last = [*walk.last[-MOST_PLACES:], place]
        walk.steps, walk.longest = walk.steps + 1, max(walk.longest, step)

    def led_to(self, parameters: list[np.ndarray]) -> bool:
        """Return whether a walk has come far from its start, and ends a step from parameters."""
        place = np.sort(np.concatenate([each.ravel() for each in parameters]))
        ends = [(walk, end) for walk in self._walks.get(len(place), []) for end in walk.last]
        if not ends:
            return False
        aways = [float(np.linalg.norm(np.sort(end) - place)) for _, end in ends]
        away = min(aways)
        walk, end = next(ends[i] for i in reversed(range(len(ends))) if aways[i] == away)
        size = float(np.linalg.norm(end))
        near = away <= max(walk.longest, NEAR * size)
        return near and float(np.linalg.norm(end - walk.start)) >= COME * size

    def begin(self, stuck: int, initialise: Callable[..., None], network: Any, *given: Any) -> None:
        """Make a network; the first `stuck` of all have hidden neurons that are all alike."""
        import torch

        initialise(network, *given)
        self.networks += 1
        values = [np.ravel(each.detach().numpy().copy()) for each in network.parameters()]
        first = np.sort(np.concatenate([*values, []]).astype(float))
        if self.networks <= MOST_NETWORKS:
            if any(np.array_equal(first, each) for each in self._beginnings):
                self._again.append(first)
            self._beginnings.append(first)
        if self.networks <= stuck:
            with torch.no_grad():
                for parameter in network.parameters():
                    parameter.fill_(0.1)

    def by_torch(self, function: Callable[..., Any], *given: Any, **named: Any) -> Any:
        """Compute a gradient by torch, and note the parameters that it is one of."""
        self._count(_leaves(next(iter([*given, *named.values()]), ())))
        return function(*given, **named)

    def by_hand(self, function: Callable[..., Any], *given: Any, **named: Any) -> Any:
        """Compute a gradient by the student's function of inputs, targets and parameters."""
        others = [named[name] for name in named if name not in ("inputs", "targets")]
        self._count([*given[2:], *others])
        return function(*given, **named)

    def _count(self, values: list[Any]) -> None:
        beat()
        self.gradients += 1
        if values:
            self.note(values)


def _leaves(tensors: Any) -> list[np.ndarray]:
    """Return the values of the parameters from which tensors were computed."""
    import torch

    found: list[np.ndarray] = []
    seen: set[Any] = set()
    ahead = [each.grad_fn for each in ([tensors] if torch.is_tensor(tensors) else tensors)]
    while ahead:
        node = ahead.pop()
        if node is None or node in seen:
            continue
        seen.add(node)
        if hasattr(node, "variable"):
            found.append(node.variable.detach().numpy())
        ahead += [before for before, _ in node.next_functions]
    return found


@contextmanager
def watching(module: Any, functions: tuple[str, ...], stuck: int) -> Iterator[Walks]:
    """Record within the block where gradients are computed.

    functions: names of the module's that compute them, too. stuck: how many of the first networks
    that module.Network makes learn no more than one hidden neuron.
    """
    import torch

    walks, made = Walks(), module.Network.__init__

    def begin(network: Any, *given: Any, **named: Any) -> None:
        walks.begin(stuck, partial(made, **named), network, *given)

    with ExitStack() as stack:
        stack.enter_context(alive())
        stack.enter_context(patch.object(module.Network, "__init__", begin))
        for name in ("backward", "grad"):
            stack.enter_context(replaced(torch.autograd, name, partial(partial, walks.by_torch)))
        for name in filter(partial(hasattr, module), functions):
            stack.enter_context(replaced(module, name, partial(partial, walks.by_hand)))
        yield walks


def expect_walked(said: str, gradients: int, led: bool) -> None:
    """Raise Wrong unless small steps, at gradients, have led far from a start to an answer."""
    expect(
        gradients >= GRADIENTS,
        f"{said} computed {gradients} gradients, by torch or by your functions of 11.2 and 11.3, "
        f"but a training needs at least {GRADIENTS}.",
    )
    expect(led, f"{said}: no steps along gradients led from a random start to these weights.")


def watched(module, name, arguments, stuck):
    """Return as numbers what a function of exercise 11 returns, and how it was trained."""
    import numpy
    import torch

    from botschool.grading.run.walks import watching

    if name == "learn":
        arguments[:2] = [torch.tensor(each, dtype=torch.float32) for each in arguments[:2]]
    with watching(module, ("gradient_by_hand", "gradient_by_torch"), stuck) as walks:
        answer = getattr(module, name)(*arguments)
    found, *more = answer if name == "fit" else (answer, walks.repeated)
    layers = (found.hidden.weight, found.hidden.bias, found.output.weight, found.output.bias)
    parameters = [layer.detach().numpy() for layer in layers]
    return [parameters, walks.gradients, walks.led_to(parameters), *map(numpy.asarray, more)]


def multiplied(module, factor, *arguments):
    """gradient_by_torch(...), where torch multiplies all gradients by {0},"""
    import torch

    from botschool.grading.run.replaced import replaced

    def larger(tensors):
        with torch.enable_grad():
            one = torch.is_tensor(tensors)
            return factor * tensors if one else [factor * each for each in tensors]

    def instead(own):
        def of_larger(*given, **named):
            for name in {"tensors", "outputs"} & {*named}:
                named[name] = larger(named[name])
            return own(*map(larger, given[:1]), *given[1:], **named)

        return of_larger

    with replaced(torch.autograd, "backward", instead), replaced(torch.autograd, "grad", instead):
        return module.gradient_by_torch(*arguments)
