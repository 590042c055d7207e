"""Decide whether the native engine trains a problem, and with which settings."""

from __future__ import annotations

import sys
from dataclasses import asdict
from importlib.metadata import version
from typing import Any

from botschool.errors import BotschoolError
from botschool.rl import spellings
from botschool.rl.native.hyperparameters import Hyperparameters
from botschool.rl.native.problem import native_problem
from botschool.rl.settings import Settings, defaults, has_defaults

ENGINES = ("auto", "native", "sb3")
ONLY_SB3 = ("use_sde", "sde_sample_freq", "stats_window_size", "device", "n_critics")
"""Hyperparameters of PPO that only Stable-Baselines3 has."""


def check_engine(engine: str) -> str:
    """Return the engine's name. Raises BotschoolError for an unknown one."""
    if engine not in ENGINES:
        raise BotschoolError(f"--engine is '{engine}', but must be {', '.join(ENGINES)}.")
    return engine


def reason_against(
    algo: str, env: str, policy: str | None, entry: dict[str, Any], wrappers: str, vec_env: str
) -> str:
    """Return why the native engine cannot train this, "" if it can."""
    if algo != "ppo":
        return f"it has no {algo}"
    if native_problem(env) is None:
        return f"{env} is not a native problem with one robot"
    if policy not in (None, "mlp"):
        return f"it has no {policy} policy"
    if wrappers not in ("", "none"):
        return "it takes no wrappers"
    if vec_env != "dummy":
        return "it runs all environments in one process"
    for name in ONLY_SB3:
        if entry.get(name):
            return f"it has no {name}"
    if entry.get("activation_fn", "tanh") in ("elu", "gelu"):
        return f"it has no {entry['activation_fn']}"
    return ""


def tell_engine(settings: Settings) -> None:
    """Print on stderr why Stable-Baselines3 trains a native problem; print nothing otherwise."""
    if settings.engine == "native" or native_problem(settings.env) is None:
        return
    policy = None if settings.policy == "mlp" else settings.policy
    chosen = entry_of(settings.env) | settings.given
    why = reason_against(
        settings.algo, settings.env, policy, chosen, settings.wrappers, settings.vec_env
    )
    if why:
        print(
            f"note: the native engine cannot train this ({why}), so Stable-Baselines3 does.",
            file=sys.stderr,
        )


def entry_of(env: str) -> dict[str, Any]:
    """Return the settings of an environment: the native engine's if there are any, else ppo's."""
    return defaults("native" if has_defaults("native", env) else "ppo", env)


def is_wanted(
    engine: str,
    algo: str,
    env: str,
    policy: str | None,
    given: dict[str, Any],
    wrappers: str,
    vec_env: str,
) -> bool:
    """Return whether the native engine trains this. Raises BotschoolError if it should but cannot.

    given: the user's hyperparameters.
    """
    if check_engine(engine) == "sb3":
        return False
    entry = entry_of(env) if native_problem(env) else {}
    against = reason_against(algo, env, policy, entry | given, wrappers, vec_env)
    if against and engine == "native":
        raise BotschoolError(
            f"The native engine cannot train this ({against}): choose another --engine."
        )
    return not against


def settings_of(entry: dict[str, Any], given: dict[str, Any], envs: int) -> dict[str, Any]:
    """Return the native engine's own part of the settings.

    entry: the defaults, which change; given: the user's hyperparameters. Raises BotschoolError.
    """
    normalize = given.get("normalize", entry.pop("normalize", False))
    if not isinstance(normalize, bool):
        raise BotschoolError(f"normalize is {normalize}, but must be true or false.")
    entry.pop("normalize", None)
    entry |= {name: value for name, value in given.items() if name != "normalize"}
    for name in ONLY_SB3:
        entry.pop(name, None)
    if "nminibatches" in entry:
        n_steps = entry.get("n_steps", Hyperparameters.n_steps)
        entry["batch_size"] = spellings.batch_size(entry.pop("nminibatches"), n_steps, envs)
    return {
        "policy": "mlp",
        "normalize": normalize,
        "parameters": asdict(Hyperparameters.of(entry)),
        "versions": {package: version(package) for package in ("botschool", "numpy")},
        "engine": "native",
    }
