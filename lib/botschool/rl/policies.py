"""Find policies: the library's by name, the user's own as module:Class.

    botschool rl train --algo ppo --env CartPole-v1 --policy my_policy:TwoSpeeds
    botschool rl enjoy --algo ppo --env CartPole-v1 --policy my_policy:TwoSpeeds

The module is installed or lies in the current folder. Importing it runs its code. So a saved agent
never causes an import by itself: its class is imported only if --policy names it again.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

import gymnasium
from gymnasium import spaces

from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.paths import import_here
from botschool.rl import spellings

if TYPE_CHECKING:
    from stable_baselines3.common.base_class import BaseAlgorithm
    from stable_baselines3.common.policies import BasePolicy
    from stable_baselines3.common.vec_env import VecEnv

POLICIES = ("mlp", "lstm", "cnn", "cnnlstm")
WITH_MEMORY = ("lstm", "cnnlstm")
WITH_IMAGES = ("cnn", "cnnlstm")


def is_own(policy: str) -> bool:
    """Return whether the name has the form module:Class."""
    return ":" in policy


def check_policy(policy: str, algo: str) -> str:
    """Return the policy's name in lower case if the algorithm has it; module:Class stays as it is.

    Raises BotschoolError.
    """
    if is_own(policy):
        if not re.fullmatch(r"[A-Za-z_][\w.]*:[A-Za-z_]\w*", policy):
            raise BotschoolError(
                f"The policy {shown(policy)} does not name a class: write module:Class, such "
                "as my_policy:MyPolicy."
            )
        return policy
    policy = spellings.POLICIES.get(policy.lower(), policy)
    if policy.lower() not in POLICIES:
        hint = nearest(policy, POLICIES)
        if not hint.endswith("?"):
            hint += ", or module:Class for one of your own."
        raise BotschoolError(f"There is no policy '{shown(policy)}'; {hint}")
    policy = policy.lower()
    if policy in WITH_MEMORY and algo != "ppo":
        raise BotschoolError(
            f"{algo} has no {policy} policy: use --algo ppo with --policy {policy}."
        )
    if policy == "cnn" and algo == "ars":
        raise BotschoolError("ars has no cnn policy: use --algo ppo, or a wrapper that flattens.")
    return policy


def load(policy: str) -> type[BasePolicy]:
    """Import the module of module:Class and return the class. Raises BotschoolError."""
    from stable_baselines3.common.policies import BasePolicy

    name, _, own = policy.partition(":")
    module = import_here(name, f"take the policy {own} from")
    found = getattr(module, own, None)
    if found is None:
        classes = [each for each, value in vars(module).items() if isinstance(value, type)]
        hint = nearest(own, classes) if classes else "it has no classes"
        end = "" if hint.endswith("?") else "."
        raise BotschoolError(f"The module {name} has no policy '{own}'; {hint}{end}")
    if not isinstance(found, type) or not issubclass(found, BasePolicy):
        raise BotschoolError(
            f"{policy} is not a policy of Stable-Baselines3: derive its class from "
            "stable_baselines3.common.policies.ActorCriticPolicy (ppo, a2c, trpo), or from "
            "the policy of your algorithm."
        )
    return found


def has_memory(policy: str) -> bool:
    """Return whether the policy has memory and needs sb3-contrib's RecurrentPPO."""
    if not is_own(policy):
        return policy in WITH_MEMORY
    return any(each.__name__ == "RecurrentActorCriticPolicy" for each in load(policy).__mro__)


def policy_of(
    model_class: type[BaseAlgorithm], policy: str, env: gymnasium.Env | VecEnv
) -> type[BasePolicy] | None:
    """Return the class of a policy for this algorithm and these observations, or None.

    Raises BotschoolError if the user's own class does not fit the algorithm.
    """
    aliases = model_class.policy_aliases
    if not is_own(policy):
        return aliases.get(_name(policy, env))
    found = load(policy)
    base = aliases.get("MlpPolicy") or aliases["MlpLstmPolicy"]
    if not issubclass(found, base):
        raise BotschoolError(
            f"{policy} cannot be trained with {model_class.__name__}: derive it from "
            f"{base.__module__}.{base.__name__}, or choose another --algo."
        )
    return found


def _name(policy: str, env: gymnasium.Env | VecEnv) -> str:
    several = isinstance(env.observation_space, spaces.Dict)
    kind = "MultiInput" if several else "Cnn" if policy in WITH_IMAGES else "Mlp"
    return f"{kind}{'Lstm' if policy in WITH_MEMORY else ''}Policy"


def check_trusted(model: Any, saved: str, named: str | None) -> None:
    """Raise BotschoolError if a saved agent needs code that the user has not named.

    model: the agent's file; saved: the policy in its settings; named: the value of --policy.
    """
    if named is None and is_own(saved):
        raise BotschoolError(
            f"The policy of {model} is {shown(saved)}, a class that is not part of botschool: "
            f"if you trust its code, add --policy {shown(saved)}."
        )
    if named is not None and named != saved:
        raise BotschoolError(
            f"The policy of {model} is {shown(saved)}, not {shown(named)}: "
            + (f"write --policy {shown(saved)}." if is_own(saved) else "leave out --policy.")
        )
