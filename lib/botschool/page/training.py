"""A training by policy gradients as a page: PPO of the native engine, with the command's bits."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from botschool import _core
from botschool.errors import BotschoolError
from botschool.output import check_output, save_bytes
from botschool.page import assemble, encoded, named, picture
from botschool.problems.native import NativeProblem
from botschool.rl.model import choose
from botschool.rl.native import files
from botschool.rl.native.hyperparameters import Hyperparameters
from botschool.rl.native.ppo import PPO
from botschool.rl.native.problem import find
from botschool.rl.native.sb3 import names_of
from botschool.rl.parameters import RANGES, linear
from botschool.rl.settings import Settings
from botschool.rl.weights import NORMALISATION
from botschool.seeds import POST_EVALUATION_SEED

COUNTS = {
    "n_envs": "environments side by side",
    "n_steps": "steps of each environment between two updates",
    "batch_size": "steps in a minibatch",
    "n_epochs": "how often an update goes through its data",
}
NUMBERS = {
    "gamma": "discount of later rewards",
    "gae_lambda": "1: returns as they come, 0: the critic's prediction of the next step",
    "ent_coef": "weight of the entropy in the loss",
    "vf_coef": "weight of the critic's error in the loss",
    "max_grad_norm": "longer gradients are shortened to this length; 0: never",
}
SCHEDULED = {
    "learning_rate": 'step size of Adam; "linear X" falls from X to 0',
    "clip_range": "how far the ratio of probabilities may leave 1",
}
NETWORKS = ("net_arch", "share_layers", "activation_fn", "log_std_init", "ortho_init")
MOST = 1_000_000


def write_training_page(
    path: Path | str, env: str, seed: int = 1, model: Path | None = None
) -> None:
    """Write the page of a training of a native problem with one robot.

    env: its Gymnasium id. The settings come from `botschool rl train --algo ppo --env ENV`.
    model: a best_model.npz or last_model.npz that it begins with. Raises BotschoolError.
    """
    path = check_output(path, (".html",))
    settings = settings_of(env, seed)
    ppo = files.make(settings)
    data = page_data(settings, ppo)
    if model is not None:
        data |= encoded(_filled(ppo, model)) | {"who": model.name}
    save_bytes(path, assemble(data, seed))


def settings_of(env: str, seed: int) -> Settings:
    """Return what `botschool rl train` would train with. Raises BotschoolError."""
    find(env)
    return replace(choose("ppo", env, seed=seed, engine="native"), env=env)


def _filled(ppo: PPO, model: Path) -> np.ndarray:
    """Return the parameters of a saved model, and its normalisation where there is one."""
    try:
        files.fill(ppo, model)
    except Exception as error:  # a damaged file can fail in any way
        raise BotschoolError(
            f"{model} is damaged, or no model of a training on {ppo.env} with these networks."
        ) from error
    parts = [ppo.parameters, *(ppo.core.observed if ppo.normalize else ())]
    return np.concatenate(parts).astype(np.float64)


def page_data(settings: Settings, ppo: PPO) -> dict[str, Any]:
    """Return what the page knows of a training."""
    if "physics" in settings.own:
        raise BotschoolError(
            "A training with physics of its own cannot go into a page: pages have the robots' own "
            "worlds."
        )
    core, limit = find(settings.env)
    problem, h = NativeProblem(core), Hyperparameters.of(settings.parameters)
    shared, pi, vf = h.layers()
    info = problem.interface
    hidden = [*shared, *pi]
    groups = [("inputs", info.observations)]
    groups += [(f"hidden {i}", size) for i, size in enumerate(hidden, 1)]
    groups += [("outputs", ppo.outputs)]
    stepper = _core.make_stepper(core)
    stepper.set(limit)
    stepper.start(settings.seed + POST_EVALUATION_SEED, 0)
    drawn = picture(problem)
    return drawn | {
        "title": settings.env.removeprefix("botschool/"),
        "about": "learns by PPO in this page, with the bits of the command; nothing leaves your "
        "computer",
        "name": "training",
        "who": "an untrained agent",
        "groups": groups,
        "networks": 1,
        "sides": False,
        "neurons": sum(size for _, size in groups),
        "inputs": info.observations,
        "normalized": settings.normalize,
        "remembers": False,
        "first": drawn["first"](stepper.state),
        "parts": _parts(ppo),
        "scaling": NORMALISATION,
        "experiment": {
            "agent": True,
            "problem": core,
            "reward": settings.own.get("reward", ""),
            "ends": settings.own.get("ends", ""),
            "spec": named(
                "agent",
                {
                    "normalize": settings.normalize,
                    "ortho_init": h.ortho_init,
                    "relu": h.activation_fn == "relu",
                    "log_std_init": h.log_std_init,
                },
            ),
            "layers": [n for layers in (shared, pi, vf) for n in (len(layers), *layers)],
            "evaluation": named(
                "training",
                {
                    "evaluations": settings.evaluations,
                    "episodes": settings.episodes,
                    "limit": limit,
                    "steps": settings.steps,
                },
            ),
            "algo": "PPO",
            "algorithm": _algorithm(settings, h),
            "steps": settings.steps,
            "generations": 0,
            "limit": limit,
            "heterogeneous": 0,
        },
        "fields": _fields(settings, h),
        "ini": {},
    }


def _parts(ppo: PPO) -> list[tuple[str, list[int], int]]:
    """Return the arrays of a model file: name, shape, and where its first number stands."""
    names = names_of(list(ppo.weights))
    return [(name, list(shape), at) for own, shape, at in ppo.core.parts for name in names[own]]


def _algorithm(settings: Settings, h: Hyperparameters) -> dict[str, Any]:
    """Return all hyperparameters but those of the networks, which `spec` and `layers` have."""
    found = {key: value for key, value in vars(h).items() if key not in NETWORKS}
    for name in (*SCHEDULED, "clip_range_vf"):
        falling = linear(found[name])
        found[name] = float(found[name] or 0) if falling is None else falling
        found[f"{name}_falls"] = falling is not None
    return named("PPO", found | {"n_envs": settings.envs, "target_kl": h.target_kl or 0})


def _fields(settings: Settings, h: Hyperparameters) -> list[dict]:
    """Return what may be changed in the page, and in which group."""
    values = vars(h) | {"n_envs": settings.envs}
    found = [
        _field("steps", settings.steps, "length of the training", 1, 1e12, whole=True)
        | {"into": [["steps", "", 1, None], ["evaluation", "steps", 1, None]]}
    ]
    for name, text in (COUNTS | NUMBERS).items():
        low, high = RANGES.get(name, (None, None))
        if name in COUNTS:
            low, high = 1, MOST
        found.append(
            _field(name, values[name], text, low or 0, high or 1e30, whole=name in COUNTS)
            | {"into": [["algorithm", name, 1, None]]}
        )
    for name, text in SCHEDULED.items():
        found.append(
            _field(name, values[name] or 0, text, 0, 1e30)
            | {"into": [["algorithm", name, 1, None]], "falls": True}
        )
    return found


def _field(
    key: str, value: Any, text: str, low: float, high: float, whole: bool = False
) -> dict[str, Any]:
    kind = "a whole number" if whole else "a number"
    most = f", at most {high:g}" if high < 1e30 else ""
    return {
        "section": "",
        "key": key,
        "value": value,
        "help": text,
        "whole": whole,
        "low": low,
        "high": high,
        "above": None,
        "allowed": None,
        "needs": f"{kind} from {low:g} on{most}",
    }
