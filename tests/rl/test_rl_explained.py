"""`botschool rl --explain`: what it says of defaults is true, and nothing is forgotten."""

import inspect
from dataclasses import fields

import pytest

from botschool.rl.explained import EXPLAINED, OF, REPLAY, ROLLOUTS, TRAINING
from botschool.rl.native import Hyperparameters
from running import call

pytestmark = pytest.mark.slow

SHARED = {"share_layers"}
"""Of the native learner alone."""


def text(value) -> str:
    """Return a default as the table shows it."""
    if value is None:
        return ""
    if isinstance(value, bool):
        return str(value).lower()
    return f"{value:g}" if isinstance(value, float) else str(value)


def told(group: str) -> dict[str, str]:
    return {name: default for of, name, default, *_ in EXPLAINED if of == group}


def test_every_hyperparameter_of_ppo_is_explained_with_its_default():
    known = {each.name: getattr(Hyperparameters(), each.name) for each in fields(Hyperparameters)}
    rows = told(TRAINING) | told(ROLLOUTS)
    assert {name: rows.get(name) for name in known if name not in SHARED} == {
        name: text(value) for name, value in known.items() if name not in SHARED
    }


def test_defaults_of_the_other_algorithms_are_those_of_the_library():
    sb3 = pytest.importorskip("stable_baselines3")
    defaults = {}
    for algorithm in (sb3.DQN, sb3.TD3, sb3.SAC):
        for name, each in inspect.signature(algorithm.__init__).parameters.items():
            if not (algorithm is sb3.SAC and name == "target_update_interval"):
                defaults[name] = text(each.default) if each.default is not each.empty else None
    assert {name: defaults.get(name) for name in told(REPLAY)} == told(REPLAY)


def test_the_command_prints_every_row():
    code, out, _ = call("rl", "--explain")
    assert code == 0
    first = {line.split()[1].strip("…") for line in out.splitlines() if line.startswith("│")}
    assert all(any(name.startswith(each) for each in first) for _, name, *_ in EXPLAINED)
    assert all(f"Of {algorithms}" in out for algorithms in OF.values())
