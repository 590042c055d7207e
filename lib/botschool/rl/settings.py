"""What a training is made of: algorithm, problem, policy and hyperparameters."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass, field, fields
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.output import save_bytes
from botschool.rl import spellings

ALGORITHMS = ("ppo", "a2c", "trpo", "ars", "sac", "td3", "ddpg", "tqc", "her", "dqn", "qrdqn")
POLICIES = ("mlp", "lstm", "cnn", "cnnlstm")
WITH_MEMORY = ("lstm", "cnnlstm")
VEC_ENVS = ("dummy", "subproc")
"""Where environments side by side run: all in this process, or each in one of its own."""


LATER = {"wrappers", "vec_env"}
"""Settings that trainings of older versions did not have."""


@dataclass
class Settings:
    """A training; config.yaml holds the same."""

    algo: str
    """One of ALGORITHMS."""
    env: str
    """A Gymnasium id."""
    policy: str
    """One of POLICIES."""
    seed: int
    steps: int
    """Length of the training, post-evaluations not counted."""
    envs: int
    """Environments that are stepped side by side."""
    normalize: bool
    """Whether observations and rewards are scaled by their running mean and deviation."""
    evaluations: int
    """Post-evaluations during the training, besides the one before it."""
    episodes: int
    """Episodes of a post-evaluation."""
    parameters: dict[str, Any] = field(default_factory=dict)
    """Hyperparameters of the algorithm and its policy, the library's own defaults among them."""
    given: dict[str, Any] = field(default_factory=dict)
    """Those that were given in place of the entry in defaults.yaml."""
    versions: dict[str, str] = field(default_factory=dict)
    """Of the packages that trained."""
    wrappers: str = ""
    """Around the environment, as botschool.wrappers reads them."""
    vec_env: str = "dummy"
    """One of VEC_ENVS; the results are the same."""

    @property
    def variant(self) -> str:
        """What sets it apart from a training with defaults, as `lstm learning_rate=0.001`."""
        policy = [self.policy] if self.policy in WITH_MEMORY else []
        given = [f"{name}={value}" for name, value in self.given.items()]
        return " ".join([*policy, *given, *filter(None, [self.wrappers])])

    def save(self, path: Path) -> None:
        """Writes a YAML file. Raises BotschoolError."""
        text = yaml.safe_dump(asdict(self), sort_keys=False, default_flow_style=None)
        save_bytes(path, text.encode())

    @classmethod
    def load(cls, path: Path) -> Settings:
        """The reverse of save. Raises BotschoolError."""
        try:
            found = yaml.load(path.read_text(encoding="utf-8"), _PlainLoader)
        except FileNotFoundError:
            raise BotschoolError(
                f"{path.parent} is no folder of a training (it has no {path.name}): name one that "
                "`botschool rl list` shows."
            ) from None
        except Exception as error:  # of a file that may hold anything
            raise BotschoolError(
                f"{path} cannot be read: {' '.join(str(error).split())}."
            ) from None
        needed, known = {f.name for f in fields(cls)} - LATER, {f.name for f in fields(cls)}
        if not isinstance(found, dict) or not needed <= found.keys() <= known:
            raise BotschoolError(
                f"{path} does not describe a training: restore it, or train again with "
                "`botschool rl train`."
            )
        return cls(**found)


class _PlainLoader(yaml.SafeLoader):
    """Without aliases: `save` writes none, and a few lines of them make billions of values."""

    def compose_node(self, parent: object, index: object) -> yaml.Node:
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("it has an alias, as no training writes")
        return super().compose_node(parent, index)


def check_algorithm(algo: str) -> str:
    """The name of a known algorithm in lower case. Raises BotschoolError."""
    name = spellings.algorithm(algo)
    if name not in ALGORITHMS:
        hint = nearest(algo, ALGORITHMS)
        raise BotschoolError(f"There is no algorithm '{shown(algo)}'; {_ended(hint)}")
    return name


def check_policy(policy: str, algo: str) -> str:
    """The name of a policy that the algorithm has, in lower case. Raises BotschoolError."""
    policy = spellings.POLICIES.get(policy.lower(), policy)
    if policy.lower() not in POLICIES:
        hint = nearest(policy, POLICIES)
        raise BotschoolError(f"There is no policy '{shown(policy)}'; {_ended(hint)}")
    policy = policy.lower()
    if policy in WITH_MEMORY and algo != "ppo":
        raise BotschoolError(
            f"{algo} has no {policy} policy: use --algo ppo with --policy {policy}."
        )
    if policy == "cnn" and algo == "ars":
        raise BotschoolError("ars has no cnn policy: use --algo ppo, or a wrapper that flattens.")
    return policy


def defaults(algo: str, env: str) -> dict[str, Any]:
    """The entry of defaults.yaml for an algorithm and a Gymnasium id."""
    entries = _defaults()[algo]
    name = env.rpartition(":")[2].removeprefix("botschool/")
    unversioned = re.sub(r"-v\d+$", "", name)
    return dict(entries.get(name, entries.get(unversioned, entries["default"])))


@cache
def _defaults() -> dict[str, dict[str, dict[str, Any]]]:
    return yaml.safe_load(files("botschool.rl").joinpath("defaults.yaml").read_text("utf-8"))


def _ended(sentence: str) -> str:
    return sentence if sentence.endswith("?") else sentence + "."
