"""Hyperparameters: how they are declared, and those of every policy.

Each is declared once, with its default, its allowed values and a line of explanation; reading,
checking and listing experiment files (botschool.config) follow from these declarations. Those of an
algorithm stand in its file (botschool.evolution.algorithms).
"""

from __future__ import annotations

from dataclasses import dataclass, field, make_dataclass
from typing import Any

from botschool import _core

NO_YES = {0: "no", 1: "yes"}
WEIGHT_DECAY = {0: "none", 1: "by 0.005 x centre", 2: "by 0.005 x sign(centre)"}


def hyper(default: Any, help: str, **limits: Any) -> Any:
    """A hyperparameter: a dataclass field with an explanation and limits.

    Further arguments: `alias`, another name of the key; `free`, whether it may change when a run
    is resumed. Limits are `low` and `high` (both allowed), `above` (itself not allowed), `choices`,
    a dict from each allowed value to its meaning, `each`, names of which several may be given, or
    `check`, a function that raises for a text that cannot be, with `form`, words for what can.
    The value has the type of the default;
    `default=MISSING` stands for a text that must be given.
    """
    return field(default=default, metadata={"help": help, **limits})


def _of_networks() -> list[tuple[str, type, Any]]:
    """Name, type and declaration of each hyperparameter of a policy network."""
    declared = []
    for name, default, low, high, explanation, choices in _core.hyperparameters():
        limits: dict[str, Any] = {"low": low, "high": high}
        if choices:
            pairs = (choice.split(": ", 1) for choice in choices.split(" | "))
            limits = {"choices": {int(value): meaning for value, meaning in pairs}}
        declared.append((name, type(default), hyper(default, explanation, **limits)))
    return declared


NETWORK = tuple(name for name, _, _ in _of_networks())
"""Names of those of a policy network; lib/evonet/hyperparameters.hpp declares them."""


@dataclass
class _Evaluation:
    nrobots: int = hyper(1, "robots in the environment, one network each", low=1, high=1000)
    heterogeneous: int = hyper(0, "each robot has parameters of its own", choices=NO_YES)
    episodes: int = hyper(1, "episodes a candidate's fitness averages", low=1, high=1000000)
    pepisodes: int = hyper(1, "episodes of a post-evaluation", low=1, high=1000000)
    maxsteps: int = hyper(1000, "steps after which an episode is cut", low=1, high=100000000)
    pmaxsteps: int = hyper(
        0, "the same for post-evaluations (0 = as maxsteps)", low=0, high=100000000
    )

    @property
    def post_steps(self) -> int:
        """Steps after which an episode of a post-evaluation is cut."""
        return self.pmaxsteps or self.maxsteps


PolicyConfig = make_dataclass(
    "PolicyConfig", _of_networks(), bases=(_Evaluation,), namespace={"__module__": __name__}
)
PolicyConfig.__doc__ = """Section [POLICY]: the network and how its robot is evaluated."""
