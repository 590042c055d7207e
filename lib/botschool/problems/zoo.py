"""Find PettingZoo environments by name, with clear errors.

A name is a module with a function `parallel_env` (`mpe2.simple_tag_v3`), `module:name` of a
function or class that makes an environment, or an id of PettingZoo's registry (`classic/rps-v2`).
The module may lie in the current folder.
"""

from __future__ import annotations

import importlib
import re
import warnings
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from types import ModuleType
from typing import Any

import gymnasium

from botschool.errors import BotschoolError, said
from botschool.inifile import nearest, shown
from botschool.paths import look_here
from botschool.problems import faces  # noqa: F401  (registers our own)

NAMES = (
    "name a module with parallel_env (as mpe2.simple_tag_v3), module:function or an id of "
    "PettingZoo (as classic/rps-v2)"
)


def make_parallel(name: str, /, **options: Any) -> Any:
    """Return the pettingzoo.ParallelEnv with that name; options go to its constructor.

    An environment whose agents take turns (AECEnv) is made parallel if it declares that it can be.
    Raises BotschoolError.
    """
    try:
        from pettingzoo import AECEnv, ParallelEnv
        from pettingzoo.utils.conversions import aec_to_parallel
    except ImportError:
        raise BotschoolError(
            f"{name} needs PettingZoo, which is not installed: install it with "
            "`pip install 'botschool[pettingzoo]'`."
        ) from None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # errors report problems in a sentence
        maker = _maker(name)
        try:
            env = maker(**options)
        except ModuleNotFoundError as error:
            raise _without(name, error) from None
        except (Exception, SystemExit) as error:
            if isinstance(error.__cause__, ModuleNotFoundError):
                raise _without(name, error.__cause__) from None
            given = " with these options" if options else ""
            raise BotschoolError(f"{name} cannot be made{given}: {said(error)}.") from error
        if isinstance(env, AECEnv):
            if not env.metadata.get("is_parallelizable"):
                raise BotschoolError(
                    f"The agents of {name} take turns, but agents that evolve must act at the same "
                    "time: choose a parallel environment."
                )
            return aec_to_parallel(env)
    if isinstance(env, gymnasium.Env):
        raise _alone(name)
    if not isinstance(env, ParallelEnv):
        raise BotschoolError(
            f"{name} makes no ParallelEnv of PettingZoo, but an object of type "
            f"{type(env).__name__}: {NAMES}."
        )
    return env


def is_parallel(name: str) -> bool:
    """Return whether an environment with this name can be made."""
    if not re.search(r"[.:/]", name):
        return False
    with suppress(BotschoolError):
        return make_parallel(name) is not None
    return False


def _maker(name: str) -> Callable[..., Any]:
    module, colon, attribute = name.partition(":")
    if not colon and "/" in name:
        return _registered(name)
    if not colon:
        if name in gymnasium.registry:
            raise _alone(name)
        return _callable(_import(module, name), name)
    found = _import(module, name)
    if hasattr(found, attribute):
        return _callable(getattr(found, attribute), name)
    if attribute in gymnasium.registry:
        raise _alone(name)
    with suppress(BotschoolError):
        return _registered(attribute)
    known = [key for key, value in vars(found).items() if callable(value) and key[0] != "_"]
    near = nearest(attribute, known)
    raise BotschoolError(
        f"There is no '{shown(attribute)}' in {module}"
        f"{f'; {near}' if near.endswith('?') else f': {NAMES}.'}"
    )


def _callable(found: Any, name: str) -> Callable[..., Any]:
    """Return the maker of the environment: a module's function, or the object after the colon."""
    if isinstance(found, ModuleType):
        for kind in ("parallel_env", "env"):
            if callable(getattr(found, kind, None)):
                return getattr(found, kind)
        raise BotschoolError(f"The module {name} has no function parallel_env: {NAMES}.")
    if not callable(found):
        raise BotschoolError(
            f"{name} is an object of type {type(found).__name__}, which makes no environment: "
            f"{NAMES}."
        )
    return found


def _registered(name: str) -> Callable[..., Any]:
    """Return the maker of the environment with this id in PettingZoo's registry."""
    import pettingzoo

    if name in gymnasium.registry:
        raise _alone(name)
    if not hasattr(pettingzoo, "parallel_registry"):
        raise BotschoolError(
            f"This version of PettingZoo has no ids, so '{shown(name)}' cannot be found: name a "
            "module, as pettingzoo.classic.rps_v2, or install a newer PettingZoo."
        )
    for kind in ("parallel", "aec"):
        with suppress(Exception):
            pettingzoo.spec(kind, name)
            return partial(pettingzoo.make, kind, name)
    near = nearest(name, [*pettingzoo.parallel_registry])
    raise BotschoolError(
        f"There is no environment '{shown(name)}' in PettingZoo"
        f"{f'; {near}' if near.endswith('?') else f': {NAMES}.'}"
    )


def _import(module: str, name: str) -> ModuleType:
    look_here(module)
    try:
        return importlib.import_module(module)
    except ModuleNotFoundError as error:
        raise _without(name, error) from None
    except Exception as error:
        raise BotschoolError(f"{name} cannot be imported: {said(error)}.") from error


def _without(name: str, error: ModuleNotFoundError) -> BotschoolError:
    """Return the error for a missing module, or for a module that it needs."""
    missing, module = error.name or "", name.partition(":")[0]
    if missing == "mpe2":
        return BotschoolError(
            f"{name} comes with the package mpe2: install it with "
            "`pip install 'botschool[pettingzoo]'`."
        )
    if not f"{module}.".startswith(f"{missing}."):
        part = module.split(".")[1] if module.startswith("pettingzoo.") else name.split("/")[0]
        extra = part if "/" in name or module.startswith("pettingzoo.") else ""
        install = f"`pip install 'pettingzoo[{extra}]'`" if extra else f"`pip install {missing}`"
        return BotschoolError(
            f"{name} needs {missing or 'a module'}, which is not installed: install it with "
            f"{install}."
        )
    return BotschoolError(
        f"There is no environment '{shown(name)}' in PettingZoo (no module {missing}): {NAMES}."
    )


def _alone(name: str) -> BotschoolError:
    return BotschoolError(
        f"{name} is an environment of one robot, but two evolve against each other here: set "
        "environment = ErPredprey or one of PettingZoo with two agents, or algo = OpenAI-ES or SSS."
    )
