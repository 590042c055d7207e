"""Declare hyperparameters, in particular the ones of every policy.

Each is declared once, with its default, its allowed values and a line of explanation. Reading,
checking and listing experiment files (botschool.config) use these declarations. Each algorithm
declares its own hyperparameters in its file (botschool.evolution.algorithms).
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, make_dataclass, replace
from typing import TYPE_CHECKING, Any

from botschool import _core
from botschool.inifile import shown

NO_YES = {0: "no", 1: "yes"}
CONVOLUTIONAL = 4
"""The `architecture` that reads images."""
MOST_NEURONS = 10_000
"""Largest number of neurons in a hidden layer, as lib/evonet/hyperparameters.hpp has it."""
WEIGHT_DECAY = {0: "none", 1: "by 0.005 x centre", 2: "by 0.005 x sign(centre)"}


def hyper(default: Any, help: str, **limits: Any) -> Any:
    """Return a hyperparameter: a dataclass field with an explanation and limits.

    Further arguments: `alias`, another name of the key; `free`, whether it may change when a run is
    resumed. Limits are `low` and `high` (both allowed), `above` (itself not allowed), `choices`, a
    dict from each allowed value to its meaning, `each`, names of which several may be given, or
    `check`, a function that raises for an impossible text, with `form`, words for the possible
    texts. The value has the type of the default; `default=MISSING` declares a text that must be
    given.
    """
    return field(default=default, metadata={"help": help, **limits})


def numbers(text: str) -> tuple[int, ...]:
    """Return the whole numbers above 0 that a text lists. Raises ValueError."""
    listed = [part.strip() for part in text.split(",")]
    if not all(re.fullmatch(r"0*([1-9][0-9]{0,2}|1000)", part, re.ASCII) for part in listed):
        raise ValueError(
            f"{shown(text)} is not a list of whole numbers from 1 to 1000: write them with "
            "commas between, as in 16, 32"
        )
    return tuple(map(int, listed))


def _of_networks() -> list[tuple[str, type, Any]]:
    """Return the name, type and declaration of each hyperparameter of a policy network."""
    declared = []
    for name, default, low, high, explanation, choices in _core.hyperparameters():
        limits: dict[str, Any] = {"low": low, "high": high}
        if choices:
            pairs = (choice.split(": ", 1) for choice in choices.split(" | "))
            limits = {"choices": {int(value): meaning for value, meaning in pairs}}
        declared.append((name, type(default), hyper(default, explanation, **limits)))
    return declared


def _of_convolutions() -> list[tuple[str, type, Any]]:
    """Return the same for hyperparameters with a number for each convolutional layer."""
    form = "whole numbers from 1 to 1000 separated by commas, one for each convolutional layer"
    return [
        (name, str, hyper(default, f"{help} (architecture = 4)", check=numbers, form=form))
        for name, default, help in (
            ("filters", "16, 32", "filters of the convolutional layers"),
            ("kernels", "8, 4", "sides of their square kernels, in pixels"),
            ("strides", "4, 2", "pixels from one place of a kernel to the next"),
        )
    ]


NETWORK: tuple[str, ...] = tuple(name for name, _, _ in _of_networks())
"""Names of the hyperparameters of every network; lib/evonet/hyperparameters.hpp declares them."""
CONVOLUTIONS = tuple(name for name, _, _ in _of_convolutions())
"""Names of the hyperparameters of convolutional layers."""


@dataclass
class _Evaluation:
    nrobots: int = hyper(1, "robots in the environment, one network each", low=1, high=1000)
    heterogeneous: int = hyper(0, "each robot has parameters of its own", choices=NO_YES)
    episodes: int = hyper(1, "episodes a candidate's fitness averages", low=1, high=1000000)
    pepisodes: int = hyper(
        20,
        "episodes of a post-evaluation (5 by default in Python, 1 for two sides)",
        low=1,
        high=1000000,
    )
    maxsteps: int = hyper(1000, "steps after which an episode is cut", low=1, high=100000000)
    pmaxsteps: int = hyper(
        0, "the same for post-evaluations (0 = as maxsteps)", low=0, high=100000000
    )

    @property
    def post_steps(self) -> int:
        """Return the steps after which an episode of a post-evaluation is cut."""
        return self.pmaxsteps or self.maxsteps


if TYPE_CHECKING:

    class PolicyConfig(_Evaluation):
        """Hides the fields that come from C++ from type checkers."""

        def __init__(self, **values: Any) -> None: ...
        def __getattr__(self, name: str) -> Any: ...

else:
    PolicyConfig = make_dataclass(
        "PolicyConfig",
        [*_of_networks(), *_of_convolutions()],
        bases=(_Evaluation,),
        namespace={"__module__": __name__},
    )
    PolicyConfig.__doc__ = """Section [POLICY]: the network and how its robot is evaluated."""


def conflicts(p: PolicyConfig) -> Iterator[tuple[tuple[str, ...], str]]:
    """Yield the policy's hyperparameters that exclude each other: names and a sentence."""
    if p.nhiddens2 and p.nlayers != 2:
        yield (
            ("nhiddens2",),
            f"nhiddens2 = {p.nhiddens2} needs nlayers = 2, but nlayers is {p.nlayers}: "
            "set nlayers = 2 or nhiddens2 = 0",
        )
    if p.nhiddens2 and p.nhiddens2 >= 2 * p.nhiddens:
        yield (
            ("nhiddens2",),
            f"nhiddens2 = {p.nhiddens2} leaves no neuron to the first layer: "
            f"it must be below 2 x nhiddens = {2 * p.nhiddens}",
        )
    if _recurrent(p) and p.nhiddens * p.nlayers > MOST_NEURONS:
        yield (
            ("nhiddens", "nlayers"),
            f"architecture = {p.architecture} puts all nhiddens x nlayers = "
            f"{p.nhiddens * p.nlayers} neurons into one hidden layer, which has at most "
            f"{MOST_NEURONS}: lower nhiddens",
        )
    yield from _convolutional(p)


def _recurrent(p: PolicyConfig) -> bool:
    """Return whether hyperparameters name several hidden layers of a recurrent network."""
    return p.architecture in (1, 2, 3) and p.nhiddens > 0 and p.nlayers > 1


def one_layer(p: PolicyConfig) -> tuple[PolicyConfig, list[str]]:
    """Return hyperparameters in which a recurrent network has one hidden layer, and a note if that
    is a change: as in evorobotpy2, the layer has the neurons of all layers.
    """
    if not _recurrent(p):
        return p, []
    neurons = p.nhiddens * p.nlayers
    note = (
        f"architecture = {p.architecture} is recurrent and has one hidden layer, so nlayers = "
        f"{p.nlayers} makes one of nhiddens x nlayers = {neurons} neurons."
    )
    changed: dict[str, Any] = {"nhiddens": neurons, "nlayers": 1, "nhiddens2": 0}
    return replace(p, **changed), [note]


def _convolutional(p: PolicyConfig) -> Iterator[tuple[tuple[str, ...], str]]:
    lists = ("filters", "kernels", "strides")
    if p.architecture != CONVOLUTIONAL:
        for f in fields(p):
            if f.name in lists and getattr(p, f.name) != f.default:
                yield (
                    (f.name,),
                    f"{f.name} = {getattr(p, f.name)} needs architecture = {CONVOLUTIONAL} "
                    f"(convolutional), but architecture is {p.architecture}: set it, or remove "
                    "the line",
                )
        return
    if len({len(numbers(getattr(p, name))) for name in lists}) > 1:
        said = [f"{name} = {getattr(p, name)}" for name in lists]
        yield (
            lists,
            f"{said[0]}; {said[1]}; {said[2]}: give as many numbers in each, one for every "
            "convolutional layer",
        )
