"""Hyperparameters: how they are declared, and those of every policy.

Each is declared once, with its default, its allowed values and a line of explanation; reading,
checking and listing experiment files (botschool.config) follow from these declarations. Those of an
algorithm stand in its file (botschool.evolution.algorithms).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

NO_YES = {0: "no", 1: "yes"}
WEIGHT_DECAY = {0: "none", 1: "by 0.005 x centre", 2: "by 0.005 x sign(centre)"}


def hyper(default: Any, help: str, **limits: Any) -> Any:
    """A hyperparameter: a dataclass field with an explanation and limits.

    Further arguments: `alias`, another name of the key; `free`, whether it may change when a run
    is resumed. Limits are `low` and `high` (both allowed), `above` (itself not allowed), or
    `choices`, a dict from each allowed value to its meaning. The value has the type of the default;
    `default=MISSING` stands for a text that must be given.
    """
    return field(default=default, metadata={"help": help, **limits})


@dataclass
class PolicyConfig:
    """Section [POLICY]: the network and how its robot is evaluated."""

    nrobots: int = hyper(1, "robots in the environment, one network each", low=1, high=1000)
    heterogeneous: int = hyper(0, "each robot has parameters of its own", choices=NO_YES)
    episodes: int = hyper(1, "episodes a candidate's fitness averages", low=1, high=1000000)
    pepisodes: int = hyper(1, "episodes of a post-evaluation", low=1, high=1000000)
    maxsteps: int = hyper(1000, "steps after which an episode is cut", low=1, high=100000000)
    nhiddens: int = hyper(
        50, "hidden neurons per layer (0 = inputs go straight to outputs)", low=0, high=10000
    )
    nhiddens2: int = hyper(
        0,
        "neurons of the second of two layers, the first gets the others (0 = equal layers)",
        low=0,
        high=20000,
    )
    nlayers: int = hyper(1, "hidden layers; recurrent networks have one", low=1, high=16)
    bias: int = hyper(0, "hidden and output neurons have a bias", choices=NO_YES)
    out_type: int = hyper(
        2, "activation of outputs", choices={1: "logistic", 2: "tanh", 3: "linear", 4: "binary"}
    )
    nbins: int = hyper(
        1,
        "output neurons per actuator; from 2 on the strongest picks the action",
        low=1,
        high=1000,
    )
    architecture: int = hyper(
        0,
        "wiring of the network",
        choices={0: "feed-forward", 1: "recurrent", 2: "fully recurrent", 3: "LSTM"},
    )
    afunction: int = hyper(
        2, "activation of hidden neurons", choices={1: "logistic", 2: "tanh", 3: "linear"}
    )
    winit: int = hyper(
        0, "initial weights", choices={0: "Xavier", 1: "norm-incoming", 2: "uniform"}
    )
    action_noise: int = hyper(
        0,
        "noise added to actions",
        choices={0: "none", 1: "Gaussian", 2: "Gaussian, evolved size"},
    )
    action_noise_range: float = hyper(
        0.01, "standard deviation of the noise when action_noise = 1", low=0, high=1000
    )
    normalize: int = hyper(0, "observations are scaled to mean 0 and spread 1", choices=NO_YES)
    clip: int = hyper(0, "inputs are kept within -5 to 5, scaled or not", choices=NO_YES)
    wrange: float = hyper(
        1.0, "initial weights lie within -wrange to wrange when winit = 2", low=0, high=1000
    )
