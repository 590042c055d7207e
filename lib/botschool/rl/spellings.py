"""Translate the spellings of Stable Baselines 2 and its Zoo, which the chapter uses, to ours."""

from __future__ import annotations

import ast
from collections.abc import Mapping
from typing import Any

from botschool.errors import BotschoolError
from botschool.inifile import shown

ALGORITHMS = {"ppo1": "ppo", "ppo2": "ppo"}
GONE = {
    "acer": "use --algo a2c or ppo instead",
    "acktr": "use --algo trpo or ppo instead",
    "actkr": "use --algo trpo or ppo instead",
    "gail": "it imitates an expert, as the package imitation does; to learn from rewards, "
    "use --algo ppo or sac",
}
"""Algorithms that Stable-Baselines3 no longer has, and what to use instead."""

POLICIES = {
    "mlppolicy": "mlp",
    "cnnpolicy": "cnn",
    "mlplstmpolicy": "lstm",
    "cnnlstmpolicy": "cnnlstm",
    "multiinputpolicy": "mlp",
    "custommlppolicy": "mlp",
}
PARAMETERS = {
    "noptepochs": "n_epochs",
    "lam": "gae_lambda",
    "cliprange": "clip_range",
    "cliprange_vf": "clip_range_vf",
    "layers": "net_arch",
    "act_fun": "activation_fn",
}
OPTIONS = {"n_timesteps": "steps", "n_envs": "envs"}
"""Hyperparameters in the Zoo that are options of the command here."""

KWARGS = "policy_kwargs"


def algorithm(name: str) -> str:
    """Return the algorithm's name here. Raises BotschoolError if it no longer exists."""
    word = name.lower()
    if word in GONE:
        raise BotschoolError(f"Stable-Baselines3 has no {word} any more: {GONE[word]}.")
    return ALGORITHMS.get(word, word)


def translated(given: Mapping[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return (hyperparameters, options of the command) by their names here.

    Options are steps, envs and policy. Raises BotschoolError for a value that is given twice.
    """
    parts = dict(given)
    if KWARGS in parts:
        _join(parts, _policy_kwargs(parts.pop(KWARGS)))
    parameters: dict[str, Any] = {}
    options: dict[str, Any] = {}
    for name, value in parts.items():
        if name in OPTIONS:
            options[OPTIONS[name]] = _count(name, value)
        elif name == "policy":
            options["policy"] = POLICIES.get(str(value).lower(), str(value))
            if str(value).lower() == "custommlppolicy":
                parameters.setdefault("net_arch", [16])
        elif name != "feature_extraction":
            own = PARAMETERS.get(name, name)
            if own != name and own in parts:
                raise BotschoolError(f"{name} means {own}: give one of them.")
            parameters[own] = _value(own, value)
    return parameters, options


def batch_size(nminibatches: Any, n_steps: int, envs: int) -> int:
    """Return the batch size that divides a rollout into `nminibatches`. Raises BotschoolError."""
    collected = n_steps * envs
    good = isinstance(nminibatches, int) and not isinstance(nminibatches, bool)
    if not good or nminibatches < 1 or collected % nminibatches:
        raise BotschoolError(
            f"nminibatches is {shown(nminibatches)}, but must divide n_steps times envs, "
            f"{n_steps} x {envs} = {collected}."
        )
    return collected // nminibatches


def _join(parts: dict[str, Any], more: Mapping[str, Any]) -> None:
    for name, value in more.items():
        if name in parts:
            raise BotschoolError(f"{name} is given both inside {KWARGS} and outside: give it once.")
        parts[name] = value


def _count(name: str, value: Any) -> int:
    number = float(value) if isinstance(value, (int, float)) else 0.5
    if isinstance(value, bool) or number != int(number) or number < 1:
        raise BotschoolError(f"{name} is {shown(value)}, but must be a whole number from 1 on.")
    return int(number)


def _value(name: str, value: Any) -> Any:
    if isinstance(value, str) and value.startswith("lin_"):
        return f"linear {value.removeprefix('lin_')}"
    if name == "net_arch" and isinstance(value, list) and any(isinstance(e, dict) for e in value):
        return value[0] if len(value) == 1 else value  # [dict(pi=[64], vf=[64])]
    return None if value == "None" else value


def _policy_kwargs(value: Any) -> dict[str, Any]:
    """Return {"net_arch": [32, 32]} for "dict(net_arch=[32, 32])"; a dictionary stays as it is."""
    if isinstance(value, str):
        try:
            value = _literal(ast.parse(value, mode="eval").body)
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            value = None
    if not isinstance(value, dict):
        raise BotschoolError(
            f"{KWARGS} must be written as dict(net_arch=[32, 32]); or give its parts "
            "themselves, as in net_arch=[32,32]."
        )
    return value


def _literal(node: ast.expr) -> Any:
    """Evaluate literals and dict(...); nn.ReLU and the like become a word such as relu.

    Raises ValueError for other code.
    """
    if isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id != "dict" or node.args:
            raise ValueError("no dict(...)")
        if any(each.arg is None for each in node.keywords):
            raise ValueError("no name")
        return {each.arg: _literal(each.value) for each in node.keywords}
    if isinstance(node, (ast.List, ast.Tuple)):
        return [_literal(each) for each in node.elts]
    if isinstance(node, ast.Attribute):
        return node.attr.lower()
    return ast.literal_eval(node)
