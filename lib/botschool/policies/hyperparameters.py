"""Declare hyperparameters, in particular the ones of every policy.

Each is declared once, with its default, its allowed values and a line of explanation. Reading,
checking and listing experiment files (botschool.config) use these declarations. Each algorithm
declares its own hyperparameters in its file (botschool.evolution.algorithms).
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field, fields, replace
from typing import Any

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


DECLARED: dict[str, tuple] = {row[0]: row[1:] for row in _core.hyperparameters()}
"""Name -> default, limits, explanation and choices, as lib/evonet/hyperparameters.hpp has them."""
NETWORK = tuple(DECLARED)
"""Names of the hyperparameters of every network."""
CONVOLUTIONS = ("filters", "kernels", "strides")
"""Names of the hyperparameters of convolutional layers, a number for each layer."""


def _of_network(name: str) -> Any:
    """Return the declaration of a hyperparameter of every network."""
    default, low, high, explanation, choices = DECLARED[name]
    if not choices:
        return hyper(default, explanation, low=low, high=high)
    pairs = (choice.split(": ", 1) for choice in choices.split(" | "))
    return hyper(default, explanation, choices={int(value): text for value, text in pairs})


def _of_layers(default: str, explanation: str) -> Any:
    """Return the declaration of a hyperparameter with a number for each convolutional layer."""
    form = "whole numbers from 1 to 1000 separated by commas, one for each convolutional layer"
    return hyper(default, f"{explanation} (architecture = 4)", check=numbers, form=form)


@dataclass
class PolicyConfig:
    """Section [POLICY]: the network and how its robot is evaluated."""

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
    nhiddens: int = _of_network("nhiddens")
    nhiddens2: int = _of_network("nhiddens2")
    nlayers: int = _of_network("nlayers")
    bias: int = _of_network("bias")
    out_type: int = _of_network("out_type")
    nbins: int = _of_network("nbins")
    architecture: int = _of_network("architecture")
    afunction: int = _of_network("afunction")
    winit: int = _of_network("winit")
    action_noise: int = _of_network("action_noise")
    action_noise_range: float = _of_network("action_noise_range")
    normalize: int = _of_network("normalize")
    clip: int = _of_network("clip")
    wrange: float = _of_network("wrange")
    filters: str = _of_layers("16, 32", "filters of the convolutional layers")
    kernels: str = _of_layers("8, 4", "sides of their square kernels, in pixels")
    strides: str = _of_layers("4, 2", "pixels from one place of a kernel to the next")

    @property
    def post_steps(self) -> int:
        """Return the steps after which an episode of a post-evaluation is cut."""
        return self.pmaxsteps or self.maxsteps


if lacking := set(NETWORK) - {f.name for f in fields(PolicyConfig)}:
    raise ImportError(f"PolicyConfig lacks {', '.join(lacking)}: add a line for each.")


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
    if p.architecture != CONVOLUTIONAL:
        for f in fields(p):
            if f.name in CONVOLUTIONS and getattr(p, f.name) != f.default:
                yield (
                    (f.name,),
                    f"{f.name} = {getattr(p, f.name)} needs architecture = {CONVOLUTIONAL} "
                    f"(convolutional), but architecture is {p.architecture}: set it, or remove "
                    "the line",
                )
        return
    if len({len(numbers(getattr(p, name))) for name in CONVOLUTIONS}) > 1:
        said = [f"{name} = {getattr(p, name)}" for name in CONVOLUTIONS]
        yield (
            CONVOLUTIONS,
            f"{said[0]}; {said[1]}; {said[2]}: give as many numbers in each, one for every "
            "convolutional layer",
        )
