"""Choose the settings of a training and build Stable-Baselines3's models from them."""

from __future__ import annotations

import importlib
import inspect
import sys
import warnings
from collections.abc import Sequence
from importlib.metadata import version
from typing import TYPE_CHECKING, Any

import gymnasium
import numpy as np
from gymnasium import spaces

from botschool import problems
from botschool.errors import BotschoolError, said
from botschool.inifile import shown
from botschool.problems.native import gym_id
from botschool.problems.spaces import has_limits, is_image
from botschool.rl import spellings
from botschool.rl.environments import described, make
from botschool.rl.native import choosing
from botschool.rl.parameters import ACTIVATIONS, OF_GOALS, OF_POLICY, complete, linear
from botschool.rl.policies import WITH_IMAGES, check_policy, has_memory, policy_of
from botschool.rl.settings import VEC_ENVS, Settings, check_algorithm, defaults

if TYPE_CHECKING:
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.vec_env import VecEnv

ANY = (spaces.Discrete, spaces.Box, spaces.MultiDiscrete, spaces.MultiBinary)
ACTIONS = {
    **dict.fromkeys(("ppo", "a2c", "trpo"), ANY),
    **dict.fromkeys(("sac", "td3", "ddpg", "tqc"), (spaces.Box,)),
    **dict.fromkeys(("dqn", "qrdqn"), (spaces.Discrete,)),
    **dict.fromkeys(("ars", "her"), (spaces.Box, spaces.Discrete)),
}
"""The action spaces that an algorithm can handle."""

CONTRIB = {"trpo": "TRPO", "qrdqn": "QRDQN", "tqc": "TQC", "ars": "ARS"}
"""Classes in sb3-contrib, the part of Stable-Baselines3 for newer algorithms."""

SCALED = ("sac", "td3", "ddpg", "tqc", "ars", "her")
"""Algorithms whose networks give numbers from -1 to 1, to be scaled to the limits of actions."""

GOAL_PARTS = {"observation", "achieved_goal", "desired_goal"}


def require(*packages: str) -> None:
    """Raise BotschoolError unless the packages can be imported."""
    for package in packages:
        try:
            importlib.import_module(package)
        except ImportError as error:
            missing = (error.name or package).partition(".")[0]
            raise BotschoolError(
                f"botschool rl needs the package {missing}: install it with `pip install "
                "torch stable-baselines3 sb3-contrib optuna`, or all packages that botschool "
                "can use with `pip install 'botschool[rl]'`."
            ) from None


def choose(
    algo: str,
    env: str,
    policy: str | None = None,
    params: dict[str, Any] | None = None,
    envs: int | None = None,
    steps: int | None = None,
    seed: int = 1,
    evaluations: int = 20,
    episodes: int = 20,
    wrappers: str = "",
    vec_env: str = "dummy",
    engine: str = "auto",
    own: dict[str, str] | None = None,
) -> Settings:
    """Return the settings of a training; defaults.yaml and benchmarks.yaml complete them.

    wrappers: replace the wrappers that the files name for the environment; "none" means no
    wrappers. engine: native (botschool.rl.native), sb3 (Stable-Baselines3), or auto (native where
    possible). own: `reward`, `ends` and `physics` of a native problem. Raises BotschoolError.
    """
    algo, env = check_algorithm(algo), gym_id(env)
    given, options = spellings.translated(params or {})
    steps, envs = steps or options.get("steps"), envs or options.get("envs")
    policy = policy or options.get("policy")
    policy = None if policy is None else check_policy(policy, algo)
    if vec_env not in VEC_ENVS:
        raise BotschoolError(f"--vec-env is '{shown(vec_env)}', but must be dummy or subproc.")
    chosen = {name: str(text) for name, text in (own or {}).items() if text not in ("", None)}
    if chosen:
        check_own(env, chosen)
    native = choosing.is_wanted(engine, algo, env, policy, given, wrappers, vec_env)
    entry = choosing.entry_of(env) if native else defaults(algo, env)
    length, width = entry.pop("steps"), entry.pop("envs")
    width = width if envs is None else envs
    parts = (
        choosing.settings_of(entry, given, width)
        if native
        else _settings_of(algo, env, policy, entry, given, width, wrappers)
    )
    return Settings(
        algo=algo,
        env=env,
        seed=seed,
        steps=length if steps is None else steps,
        envs=width,
        evaluations=evaluations,
        episodes=episodes,
        given=given,
        vec_env=vec_env,
        own=chosen,
        **parts,
    )


def check_own(env: str, own: dict[str, str]) -> None:
    """Raise BotschoolError if the environment cannot have this reward, end or physics."""
    problems.make(env, **own)


def _settings_of(
    algo: str,
    env: str,
    policy: str | None,
    entry: dict[str, Any],
    given: dict[str, Any],
    envs: int,
    wrappers: str,
) -> dict[str, Any]:
    """Return the part of the settings that Stable-Baselines3 needs; arguments as in `choose`.

    entry: the defaults, which change.
    """
    usual = [entry.pop(name, "") for name in ("wrappers", "training_wrappers")]
    wrappers, training_wrappers = usual if not wrappers else [wrappers, ""]
    wrappers = "" if wrappers == "none" else wrappers
    env_made = make(env, wrappers)
    _check_spaces(algo, env, env_made)
    require("torch", "stable_baselines3")
    policy = policy or ("cnn" if is_image(env_made.observation_space) else "mlp")
    if policy in WITH_IMAGES and not is_image(env_made.observation_space):
        raise BotschoolError(
            f"{env} shows no images, so it cannot be trained with a {policy} policy (its "
            f"observations are {described(env_made.observation_space)}): leave out --policy."
        )
    normalize = _normalize(given, entry.pop("normalize", False), env_made)
    entry |= {name: value for name, value in given.items() if name != "normalize"}
    model_class = algorithm_class(algo, policy, isinstance(env_made.action_space, spaces.Discrete))
    if "nminibatches" in entry:
        _share_batches(entry, model_class, envs)
    policy_class = policy_of(model_class, policy, env_made)
    if policy_class is None:
        raise BotschoolError(
            f"{algo} reads vectors only, but the observations of {env} are "
            f"{described(env_made.observation_space)}: add --wrapper FlattenObservation."
        )
    env_made.close()
    packages = ("stable_baselines3", "torch", "gymnasium", "numpy")
    return {
        "policy": policy,
        "normalize": normalize,
        "parameters": complete(model_class, policy_class, entry, algo == "her"),
        "versions": {package: version(package) for package in packages},
        "wrappers": wrappers,
        "training_wrappers": training_wrappers,
    }


def _share_batches(entry: dict[str, Any], model_class: type[BaseAlgorithm], envs: int) -> None:
    """Replace nminibatches by the batch_size that it means."""
    known = inspect.signature(model_class.__init__).parameters
    if not {"n_steps", "n_epochs", "batch_size"} <= known.keys():
        raise BotschoolError(f"nminibatches is for ppo, not for {model_class.__name__}.")
    n_steps = entry.get("n_steps", known["n_steps"].default)
    if isinstance(n_steps, int):  # other values are refused by their own check
        entry["batch_size"] = spellings.batch_size(entry.pop("nminibatches"), n_steps, envs)


def _normalize(given: dict[str, Any], usual: bool, env: gymnasium.Env) -> bool:
    seen = env.observation_space
    # Stable-Baselines3 turns the axes of pictures, of small ones, too, after it has scaled them.
    picture = isinstance(seen, spaces.Box) and len(seen.shape) == 3 and seen.dtype == np.uint8
    possible = isinstance(seen, spaces.Box) and not picture
    wanted = given.get("normalize", usual and possible)
    if not isinstance(wanted, bool):
        raise BotschoolError(f"normalize is {wanted}, but must be true or false.")
    if wanted and not possible:
        raise BotschoolError(
            f"normalize is true, but only vectors of numbers can be normalised, not observations "
            f"in {described(env.observation_space)}: leave it out."
        )
    return wanted


def _check_spaces(algo: str, name: str, env: gymnasium.Env) -> None:
    own = env.env.action_space
    if not isinstance(own, ACTIONS[algo]):
        kind = type(own)
        able = [other for other, kinds in ACTIONS.items() if kind in kinds and other != "her"]
        remedy = f"use --algo {' or '.join(able)}" if able else "wrap the environment"
        raise BotschoolError(
            f"{algo} cannot be trained on {name}, whose actions are {described(own)}: {remedy}."
        )
    if algo in SCALED and isinstance(own, spaces.Box) and not has_limits(own):
        raise BotschoolError(
            f"{algo} scales its actions to their limits, but some actions of {name} have none: use "
            "--algo ppo, or give the environment's action_space limits."
        )
    if algo == "her" and not _has_goals(env):
        raise BotschoolError(
            f"her cannot be trained on {name}, which has no goals: its observations must be a Dict "
            f"of {', '.join(sorted(GOAL_PARTS))}, and it needs compute_reward, as FetchReach-v4."
        )


def _has_goals(env: gymnasium.Env) -> bool:
    space = env.observation_space
    return (
        isinstance(space, spaces.Dict)
        and space.keys() >= GOAL_PARTS - {"observation"}  # it may be a nest of its own
        and env.env.has_wrapper_attr("compute_reward")
    )


def algorithm_class(algo: str, policy: str, discrete: bool = False) -> type[BaseAlgorithm]:
    """Return the library's class for an algorithm. Raises BotschoolError if it is not installed.

    Hindsight experience replay is SAC with goals, or DQN for discrete actions.
    """
    check_algorithm(algo)
    require("torch", "stable_baselines3")
    if algo in CONTRIB or (algo == "ppo" and has_memory(policy)):
        require("sb3_contrib")
        return getattr(importlib.import_module("sb3_contrib"), CONTRIB.get(algo, "RecurrentPPO"))
    if algo == "her":
        algo = "dqn" if discrete else "sac"
    return getattr(importlib.import_module("stable_baselines3"), algo.upper())


def build(settings: Settings, env: VecEnv | gymnasium.Env, small: bool = False) -> BaseAlgorithm:
    """Return an untrained model; `small`: one that only acts. Raises BotschoolError."""
    require("torch", "stable_baselines3")
    import torch

    chosen = dict(settings.parameters)
    policy = {name: chosen.pop(name) for name in OF_POLICY if name in chosen}
    if "activation_fn" in policy:
        policy["activation_fn"] = getattr(torch.nn, ACTIVATIONS[policy["activation_fn"]])
    goals = {name: chosen.pop(name) for name in OF_GOALS if name in chosen}
    chosen = {name: _live(name, value, env) for name, value in chosen.items()}
    if goals and not small:
        from stable_baselines3 import HerReplayBuffer

        chosen |= {"replay_buffer_class": HerReplayBuffer, "replay_buffer_kwargs": goals}
    if small and "buffer_size" in chosen:
        chosen["buffer_size"] = 1
    chosen.setdefault("device", "auto" if settings.policy in WITH_IMAGES else "cpu")
    discrete = isinstance(env.action_space, spaces.Discrete)
    model_class = algorithm_class(settings.algo, settings.policy, discrete)
    if small:  # another version of the library may have other learning parameters
        known = inspect.signature(model_class.__init__).parameters
        chosen = {name: value for name, value in chosen.items() if name in known}
        chosen["device"] = "cpu"
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", UserWarning)
            model = model_class(
                policy_of(model_class, settings.policy, env),
                env,
                seed=settings.seed,
                policy_kwargs=policy or None,
                **chosen,
            )
    except (AssertionError, ValueError, TypeError, RuntimeError, MemoryError) as error:
        raise BotschoolError(
            f"{settings.algo} cannot be set up for {settings.env} with these hyperparameters "
            f"({said(error)}): change them with --params."
        ) from error
    if not small:
        _pass_on(caught)
    return model


def _pass_on(caught: Sequence[warnings.WarningMessage]) -> None:
    for warning in caught:
        if issubclass(warning.category, UserWarning):
            print(f"note: {' '.join(str(warning.message).split())}", file=sys.stderr)


def _live(name: str, value: Any, env: VecEnv | gymnasium.Env) -> Any:
    """Return the object that the library expects in place of plain data."""
    from stable_baselines3.common.noise import NormalActionNoise
    from stable_baselines3.common.utils import LinearSchedule

    if name == "action_noise" and value is not None:
        size = env.action_space.shape
        return NormalActionNoise(np.zeros(size), np.full(size, value))
    if linear(value) is not None:
        return LinearSchedule(linear(value), 0.0, 1.0)
    return tuple(value) if name == "train_freq" and isinstance(value, list) else value
