"""Store the settings of a training: algorithm, problem, policy and hyperparameters."""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass, field, fields
from fnmatch import fnmatchcase
from functools import cache
from importlib.resources import files
from pathlib import Path
from typing import Any

import yaml

from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.output import save_bytes
from botschool.rl import spellings
from botschool.rl.policies import WITH_MEMORY, is_own

ALGORITHMS = ("ppo", "a2c", "trpo", "ars", "sac", "td3", "ddpg", "tqc", "her", "dqn", "qrdqn")
VEC_ENVS = ("dummy", "subproc")
"""Where parallel environments run: all in this process, or each in a process of its own."""


LATER = {"wrappers", "vec_env", "training_wrappers", "engine", "own"}
"""Settings that trainings of older versions lack."""


COUNTS = {"seed": 0, "steps": 0, "envs": 1, "evaluations": 0, "episodes": 1}
"""Settings that are whole numbers, each with its minimum."""


@dataclass
class Settings:
    """The settings of a training, as config.yaml stores them."""

    algo: str
    """One of ALGORITHMS."""
    env: str
    """A Gymnasium id."""
    policy: str
    """One of policies.POLICIES, or module:Class."""
    seed: int
    steps: int
    """Length of the training without post-evaluations."""
    envs: int
    """Environments that step in parallel."""
    normalize: bool
    """Whether observations and rewards are scaled by their running mean and deviation."""
    evaluations: int
    """Post-evaluations during the training; one more comes before it."""
    episodes: int
    """Episodes of a post-evaluation."""
    parameters: dict[str, Any] = field(default_factory=dict)
    """Hyperparameters of the algorithm and its policy, including the library's own defaults."""
    given: dict[str, Any] = field(default_factory=dict)
    """Hyperparameters that the user set instead of the entry in defaults.yaml."""
    versions: dict[str, str] = field(default_factory=dict)
    """Versions of the packages that trained."""
    wrappers: str = ""
    """Wrappers around the environment, in the syntax of botschool.wrappers."""
    vec_env: str = "dummy"
    """One of VEC_ENVS; both give the same results."""
    training_wrappers: str = ""
    """Wrappers for training only, not for evaluation, such as clipped rewards of Atari games."""
    engine: str = "sb3"
    """The engine that trained: sb3 (Stable-Baselines3) or native (botschool.rl.native)."""
    own: dict[str, str] = field(default_factory=dict)
    """`reward`, `ends` and `physics` of a native problem, as in experiment files."""

    @property
    def variant(self) -> str:
        """Return the difference from the defaults, such as `lstm learning_rate=0.001`."""
        policy = [self.policy] if self.policy in WITH_MEMORY or is_own(self.policy) else []
        given = [f"{name}={value}" for name, value in self.given.items()]
        usual = defaults(self.algo, self.env).get("wrappers") if self.algo in ALGORITHMS else ""
        wrappers = [self.wrappers] if self.wrappers != usual else []
        own = [f"{name}={text}" for name, text in self.own.items()]
        return " ".join([*policy, *given, *filter(None, wrappers), *own])

    def save(self, path: Path) -> None:
        """Write the settings as a YAML file. Raises BotschoolError."""
        text = yaml.safe_dump(asdict(self), sort_keys=False, default_flow_style=None)
        save_bytes(path, text.encode())

    @classmethod
    def load(cls, path: Path) -> Settings:
        """Read the settings from a YAML file. Raises BotschoolError."""
        try:
            found = yaml.load(path.read_text(encoding="utf-8"), _PlainLoader)
        except FileNotFoundError:
            raise BotschoolError(
                f"{path.parent} is not the folder of a training (it has no {path.name}): name "
                "one that `botschool rl list` shows."
            ) from None
        except Exception as error:  # the file may hold anything
            raise BotschoolError(
                f"{path} cannot be read: {' '.join(str(error).split())}."
            ) from None
        needed, known = {f.name for f in fields(cls)} - LATER, {f.name for f in fields(cls)}
        if (
            not isinstance(found, dict)
            or not needed <= found.keys() <= known
            or not all(_is_right(name, found[name]) for name in found)
        ):
            raise BotschoolError(
                f"{path} does not describe a training: restore it, or train again with "
                "`botschool rl train`."
            )
        return cls(**found)


def _is_right(name: str, value: object) -> bool:
    """Return whether a training has such a setting."""
    if name in COUNTS:
        return type(value) is int and COUNTS[name] <= value < 2**63
    kinds = {"normalize": bool, "parameters": dict, "given": dict, "versions": dict, "own": dict}
    return isinstance(value, kinds.get(name, str))


class _PlainLoader(yaml.SafeLoader):
    """A YAML loader without aliases, a few lines of which make billions of values."""

    def compose_node(self, parent: object, index: object) -> yaml.Node:
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("it has an alias, which no training writes")
        return super().compose_node(parent, index)


def check_algorithm(algo: str) -> str:
    """Return the name of a known algorithm in lower case. Raises BotschoolError."""
    name = spellings.algorithm(algo)
    if name not in ALGORITHMS:
        hint = nearest(algo, ALGORITHMS)
        raise BotschoolError(f"There is no algorithm '{shown(algo)}'; {_ended(hint)}")
    return name


def defaults(algo: str, env: str) -> dict[str, Any]:
    """Return the entry of defaults.yaml or benchmarks.yaml for an algorithm and a Gymnasium id."""
    return dict(_defaults()[algo][_key(algo, env) or "default"])


def has_defaults(algo: str, env: str) -> bool:
    """Return whether the environment has an entry of its own."""
    return _key(algo, env) is not None


def _key(algo: str, env: str) -> str | None:
    entries = _defaults()[algo]
    name = env.rpartition(":")[2].removeprefix("botschool/")
    unversioned = re.sub(r"-v\d+$", "", name)
    patterns = [key for key in entries if "*" in key and fnmatchcase(name, key)]
    return next((key for key in (name, unversioned, *patterns) if key in entries), None)


@cache
def _defaults() -> dict[str, dict[str, dict[str, Any]]]:
    entries: dict[str, dict[str, dict[str, Any]]] = {}
    for file in ("defaults.yaml", "benchmarks.yaml"):
        text = files("botschool.rl").joinpath(file).read_text("utf-8")
        for algo, those in yaml.safe_load(text).items():
            entries.setdefault(algo, {}).update(those)
    return entries


def _ended(sentence: str) -> str:
    return sentence if sentence.endswith("?") else sentence + "."
