"""Read hyperparameters from `key=value` and check them against the algorithm's class."""

from __future__ import annotations

import collections.abc
import inspect
import math
import re
import typing
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import yaml

from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.npy import opened

NOT_HERE = {
    "policy": "use --policy",
    "env": "use --env",
    "seed": "use -s",
    "steps": "use --steps",
    "total_timesteps": "use --steps",
    "envs": "use --envs",
    "policy_kwargs": "give its parts themselves, as net_arch=[32,32]",
    "tensorboard_log": "every training is logged in its folder",
    "verbose": "leave it out",
    "_init_setup_model": "leave it out",
}
"""Hyperparameters of Stable-Baselines3 that are not set here, and what to do instead."""

OBJECTS = ("buffer_class", "buffer_kwargs")
"""Endings of names whose values are Python objects, which a file cannot hold."""

OF_POLICY = {
    "net_arch": "a list of whole numbers, as [64, 64]",
    "activation_fn": "tanh, relu, elu or gelu",
    "log_std_init": "a number",
    "ortho_init": "true or false",
    "n_critics": "a whole number",
    "lstm_hidden_size": "a whole number",
    "n_lstm_layers": "a whole number",
    "shared_lstm": "true or false",
    "enable_critic_lstm": "true or false",
    "with_bias": "true or false",
    "n_quantiles": "a whole number",
}
"""Parameters of the policy's class; the algorithm decides which of them exist."""

OF_GOALS = {"n_sampled_goal": 4, "goal_selection_strategy": "future"}
"""Parameters of hindsight experience replay, with their defaults."""

GOALS = ("future", "final", "episode")
"""Strategies that choose the goals of hindsight experience replay."""

ACTIVATIONS = {"tanh": "Tanh", "relu": "ReLU", "elu": "ELU", "gelu": "GELU"}

_PROBABILITY = (0.0, 1.0)
RANGES = {
    **dict.fromkeys(("gamma", "gae_lambda", "tau", "exploration_fraction"), _PROBABILITY),
    **dict.fromkeys(("exploration_initial_eps", "exploration_final_eps"), _PROBABILITY),
    **dict.fromkeys(("n_steps", "batch_size", "n_epochs", "buffer_size", "n_critics"), (1, None)),
    **dict.fromkeys(("policy_delay", "stats_window_size", "lstm_hidden_size"), (1, None)),
    **dict.fromkeys(("n_lstm_layers", "target_update_interval"), (1, None)),
    **dict.fromkeys(("learning_starts", "learning_rate", "clip_range", "action_noise"), (0, None)),
    **dict.fromkeys(("max_grad_norm", "vf_coef", "target_policy_noise"), (0, None)),
    **dict.fromkeys(("n_delta", "n_top", "n_eval_episodes", "n_quantiles"), (1, None)),
    **dict.fromkeys(("n_sampled_goal", "cg_max_steps", "n_critic_updates"), (1, None)),
    **dict.fromkeys(("delta_std", "target_kl"), (0, None)),
}
"""Smallest and largest value, None for no limit."""


def parse(items: Iterable[str]) -> dict[str, Any]:
    """Read ["gamma=0.9", "net_arch=[32,32]"] as {"gamma": 0.9, ...}; name:value works, too.

    Raises BotschoolError.
    """
    values = {}
    for item in items:
        name, equals, text = re.match(r"([^=:]*)([=:]?)(.*)", item, re.DOTALL).groups()
        if not equals or not name.strip() or not text.strip():
            raise BotschoolError(
                f"'{shown(item)}' is not a hyperparameter: write --params name=value, as in "
                "--params learning_rate=0.001 gamma=0.98."
            )
        try:
            value = yaml.safe_load(text)
        except yaml.YAMLError:
            raise BotschoolError(
                f"The value of {name.strip()}, {shown(text)}, cannot be read: write a number, "
                "true, false, a word or a list in brackets."
            ) from None
        values[name.strip()] = _number_if_possible(value)
    return values


def read_settings(path: Path) -> dict[str, Any]:
    """Read the hyperparameters in a YAML file of `name: value`. Raises BotschoolError."""
    try:
        with opened(path) as file:
            found = yaml.safe_load(file) or {}
    except (OSError, UnicodeDecodeError, yaml.YAMLError) as error:
        reason = getattr(error, "strerror", None) or "it is not YAML"
        raise BotschoolError(
            f"{path} cannot be read ({reason}): give a file with lines of name: value."
        ) from (None)
    if not isinstance(found, dict) or not all(isinstance(name, str) for name in found):
        raise BotschoolError(
            f"{path} holds no hyperparameters: give a file with lines of name: value."
        )
    return {name: _number_if_possible(value) for name, value in found.items()}


def _number_if_possible(value: Any) -> Any:
    """Convert a word such as 1e-3, which YAML reads as a string, to a number."""
    if isinstance(value, str):
        try:
            return float(value)
        except ValueError:
            pass
    return value


def accepted(model_class: Any, policy_class: Any, goals: bool = False) -> dict[str, Any]:
    """Return name -> its type annotation, or the words for it if it belongs to the policy.

    goals: include the parameters of hindsight experience replay.
    """
    found: dict[str, Any] = {name: type(value) for name, value in OF_GOALS.items()} if goals else {}
    for name, parameter in inspect.signature(model_class.__init__).parameters.items():
        if name != "self" and name not in NOT_HERE and not name.endswith(OBJECTS):
            found[name] = parameter.annotation
    if "action_noise" in found:
        found["action_noise"] = float | None
    of_policy = set()
    for each in policy_class.__mro__:  # a user's class may pass keyword arguments on to its base
        of_each = inspect.signature(each.__init__).parameters.values()
        of_policy |= {parameter.name for parameter in of_each}
        if not any(parameter.kind is parameter.VAR_KEYWORD for parameter in of_each):
            break
    return found | {name: words for name, words in OF_POLICY.items() if name in of_policy}


def complete(
    model_class: Any, policy_class: Any, chosen: Mapping[str, Any], goals: bool = False
) -> dict[str, Any]:
    """Return the chosen hyperparameters, checked, completed by the algorithm's own defaults.

    Raises BotschoolError that suggests the nearest name or the values allowed.
    """
    known = accepted(model_class, policy_class, goals)
    signature = inspect.signature(model_class.__init__).parameters
    values = {
        name: signature[name].default
        for name in known
        if name in signature and _plain(signature[name].default) and name != "device"
    }
    values |= OF_GOALS if goals else {}
    for name, value in chosen.items():
        if name in NOT_HERE:
            raise BotschoolError(f"{name} is not set by --params: {NOT_HERE[name]}.")
        if name not in known and "lstm" in name and name in OF_POLICY:
            raise BotschoolError(f"{name} is for networks with memory: add --policy lstm.")
        if name not in known:
            hint = nearest(name, [*known, "normalize"])
            end = "" if hint.endswith("?") else "."
            raise BotschoolError(
                f"{model_class.__name__} has no hyperparameter {shown(name)}; {hint}{end}"
            )
        values[name] = _checked(name, value, known[name])
    return values


def _plain(value: Any) -> bool:
    return value is None or isinstance(value, (bool, int, float, str))


def _checked(name: str, value: Any, annotation: Any) -> Any:
    """Return the value in the type that the algorithm expects. Raises BotschoolError."""
    if value is None and not isinstance(annotation, str) and type(None) in _types(annotation):
        return None
    words = annotation if isinstance(annotation, str) else _words(annotation)
    fitting = _of_policy(name, value) if name in OF_POLICY else _of_type(value, annotation)
    if fitting is None:
        raise BotschoolError(f"{name} is {shown(value)}, but must be {words}.")
    if name == "goal_selection_strategy" and fitting not in GOALS:
        raise BotschoolError(f"{name} is {shown(value)}, but must be {' or '.join(GOALS)}.")
    number = linear(fitting) or fitting
    low, high = RANGES.get(name, (None, None))
    if _is_number(number) and not (-math.inf if low is None else low) <= number <= (
        high or math.inf
    ):
        limits = f"from {low:g} to {high:g}" if high else f"at least {low}"
        raise BotschoolError(f"{name} is {shown(value)}, but must be {limits}.")
    return fitting


def linear(value: Any) -> float | None:
    """Return 0.001 for "linear 0.001", None for other values."""
    words = value.split() if isinstance(value, str) else []
    if len(words) == 2 and words[0] == "linear":
        try:
            return float(words[1])
        except ValueError:
            pass
    return None


def _types(annotation: Any) -> set[Any]:
    if typing.get_origin(annotation) is collections.abc.Callable:
        return {"schedule"}
    parts = typing.get_args(annotation)
    if typing.get_origin(annotation) is tuple or not parts:
        return {tuple if parts else annotation}
    return set().union(*(_types(part) for part in parts))


def _of_type(value: Any, annotation: Any) -> Any:
    """Return the value in the first type that fits, None if none does."""
    types = _types(annotation)
    if isinstance(value, bool):
        return value if bool in types else None
    if _is_number(value):
        if not math.isfinite(value):
            return None
        if float in types and not (int in types and isinstance(value, int)):
            return float(value)
        return int(value) if int in types and value == int(value) else None
    if isinstance(value, str):
        return value if str in types or ("schedule" in types and linear(value)) else None
    if isinstance(value, list) and tuple in types:
        fits = len(value) == 2 and isinstance(value[0], int) and isinstance(value[1], str)
        return value if fits else None
    return None


def _words(annotation: Any) -> str:
    words = {
        bool: "true or false",
        int: "a whole number",
        float: "a number",
        "schedule": "'linear X' with the number it falls from",
        tuple: "a pair as [1, episode]",
        str: "a word",
        type(None): "null",
    }
    types = _types(annotation)
    return " or ".join(text for kind, text in words.items() if kind in types)


def _of_policy(name: str, value: Any) -> Any:
    words = OF_POLICY[name]
    if name == "net_arch":
        sizes = [size for part in value.values() for size in part] if _is_pair(value) else value
        good = isinstance(sizes, list) and all(_is_whole(size) and size > 0 for size in sizes)
        return value if good else None
    if name == "activation_fn":
        return value.lower() if str(value).lower() in ACTIVATIONS else None
    kind = {"a number": float, "a whole number": int, "true or false": bool}[words]
    return _of_type(value, kind)


def _is_pair(value: Any) -> bool:
    """Return whether it is {"pi": [...], "vf": [...]}, separate layers for actor and critic."""
    return isinstance(value, dict) and all(isinstance(part, list) for part in value.values())


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _is_whole(value: Any) -> bool:
    return isinstance(value, int) and not isinstance(value, bool)
