"""Write an experiment as one self-contained page: it evolves in the browser, with the command's
bits, and you can modify its robot (docs/page.md).

The core is lib/web, compiled to WebAssembly by `make web`. The page's scripts lie beside this file.
"""

from __future__ import annotations

import gzip
import json
from base64 import b64encode
from dataclasses import fields
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from botschool import _core, problems
from botschool.config import Experiment, to_dict
from botschool.errors import BotschoolError
from botschool.output import check_output, save_bytes
from botschool.page.twins import twin
from botschool.policies.hyperparameters import NETWORK
from botschool.problems.native import NativeProblem
from botschool.render.panel import neuron_groups
from botschool.render.replay import drawing, palette, scene_description
from botschool.render.scenes import make_scene
from botschool.seeds import POST_EVALUATION_SEED

SCRIPTS = ("scenes.js", "files.js", "hands.js", "tournament.js", "evolve.js", "page.js")
ALGORITHMS = ("OpenAI-ES", "SSS", "coevo2")
"""Algorithms that a page can run."""
LENGTHS = ("maxmsteps", "ngenerations", "saveeach")
"""Hyperparameters that say how long a run is: the page itself counts."""


def write_page(
    path: Path | str,
    experiment: Experiment,
    seed: int = 1,
    saved: np.ndarray | None = None,
    name: str = "",
) -> None:
    """Write the page of an experiment on a native problem.

    saved: the robot at the start, as run files hold it, called `name`; of populations of predators
    and prey, shape (2 n, parameters), the first of each. None means the random robot from which the
    seed's run starts. Raises BotschoolError.
    """
    path = check_output(path, (".html",))
    problem = _checked(experiment)
    policy = problem.policy(experiment.policy)
    given = saved is not None
    if saved is None:
        normalisation = np.repeat([0.0, 1.0], policy.spec.inputs) if policy.spec.normalize else None
        saved = policy.join(policy.initial(seed), normalisation)
    elif np.ndim(saved) == 2 and experiment.competitive:
        saved = np.asarray(saved)[[0, len(saved) // 2]].ravel()
    name = name or ("the robot that was given" if given else "")
    genotype, normalisation = policy.split(np.asarray(saved, dtype=np.float64))
    data = describe(experiment, problem, policy) | {
        "fields": _fields(experiment, problem),
        "ini": {name.upper(): values for name, values in _written(experiment).items()},
    }
    data["who"] = name or "a random robot, with which evolution starts"
    if name:
        data |= encoded(policy.join(genotype, normalisation))
    first = next(
        problem.play(policy, genotype, normalisation, seed + POST_EVALUATION_SEED, 0, 1), None
    )
    if first is not None:
        data["first"] = problem_scene(problem).numbers(first.state).tolist()
    save_bytes(path, assemble(data, seed))


def part_of(problem: str) -> str:
    """Return which core has a problem that pages draw (lib/CMakeLists.txt)."""
    for part in ("planar", "spatial"):
        if problem.lower().startswith(part):
            return part
    return {"ErDiscrim": "discrim", "ErPredprey": "predprey"}.get(problem, "classic")


def core(problem: str) -> bytes:
    """Return the compiled core of a problem."""
    return core_file(part_of(problem))


def core_file(part: str) -> bytes:
    """Return the compiled core of a part."""
    return (files("botschool.page") / f"{part}.wasm").read_bytes()


def problem_scene(problem: NativeProblem) -> Any:
    """Return the picture of a native problem. Raises BotschoolError if it has none in pages."""
    return make_scene(problem.dynamics, problem.robots, problem.plan)


def _checked(experiment: Experiment) -> NativeProblem:
    problem = problems.of(experiment)
    own = isinstance(problem, NativeProblem) and (problem.plan or problem.race)
    if not isinstance(problem, NativeProblem) or own or experiment.exp.robots:
        raise BotschoolError(
            f"{experiment.exp.environment} cannot go into a page: pages have the native problems "
            "with robots, arenas and ground of their own, such as Acrobot-v1, ErDiscrim or "
            "PlanarHopper-v5."
        )
    if not experiment.competitive and experiment.exp.algo not in ALGORITHMS:
        raise BotschoolError(
            f"{experiment.exp.algo} cannot evolve in a page: set algo = OpenAI-ES or SSS."
        )
    return problem


def describe(experiment: Experiment, problem: NativeProblem, policy: Any) -> dict:
    """Return what a page knows of an experiment, without what a user can change."""
    scene, drawn = problem_scene(problem), picture(problem)
    inputs, outputs = policy.neurons
    neurons = len(policy.network.activations)
    robots = problem.interface.robots
    groups = neuron_groups(robots * neurons, inputs, outputs, scene.robots)
    return drawn | {
        "title": problem.name,
        "about": _about(experiment),
        "name": experiment.path.stem if experiment.path else "experiment",
        "groups": [[label, size] for label, size in groups],
        "networks": policy.networks,
        "sides": experiment.competitive,
        "neurons": neurons,
        "inputs": inputs,
        "normalized": bool(policy.spec.normalize),
        "remembers": experiment.policy.architecture in (1, 2, 3),
        "first": drawn["first"](np.zeros(scene.state_size)),
        "experiment": for_core(experiment, problem),
    }


def for_core(experiment: Experiment, problem: NativeProblem) -> dict:
    """Return what the core needs to know of an experiment."""
    p = experiment.policy
    limit = problem.steps(p.maxsteps)
    return {
        "problem": problem.dynamics,
        "reward": problem.reward,
        "ends": problem.ends,
        "spec": named("network", {key: getattr(p, key) for key in NETWORK}),
        "evaluation": named(
            "evaluation",
            {
                "episodes": p.episodes,
                "pepisodes": p.pepisodes,
                "limit": limit,
                "post_limit": problem.steps(p.post_steps),
                "heterogeneous": p.heterogeneous,
                "alive": problem.alive,
            },
        ),
        "algo": experiment.exp.algo,
        "algorithm": _algorithm(experiment),
        "steps": max(1, round(getattr(experiment.algo, "maxmsteps", 1) * 1e6)),
        "generations": getattr(experiment.algo, "ngenerations", 0),
        "saveeach": getattr(experiment.algo, "saveeach", 0),
        "limit": limit,
        "heterogeneous": p.heterogeneous,
    }


def picture(problem: NativeProblem) -> dict[str, Any]:
    """Return what a page draws; `first` turns a state into the numbers of a picture."""
    scene = problem_scene(problem)
    return {
        "palette": palette(),
        "scene": _rounded(scene_description(scene)) | twin(problem, scene),
        "fps": scene.fps,
        "drag": "the cylinder or the robot" if problem.name == "ErDiscrim" else "what moves",
        "first": lambda state: scene.numbers(state).tolist(),
    }


def _rounded(description: dict) -> dict:
    """Return the shapes rounded to six digits after the point: less than a pixel, and shorter."""
    return json.loads(json.dumps(description), parse_float=lambda text: round(float(text), 6))


def encoded(saved: np.ndarray) -> dict[str, str]:
    """Return a robot in base 64, in single precision if that is exact."""
    single = saved.astype("<f4")
    if (single == saved).all():
        return {"robot": packed(single.tobytes())}
    return {"exact": packed(saved.astype("<f8").tobytes())}


def packed(content: bytes) -> str:
    """Return the packed content that `unzipped` in core.js reads."""
    return b64encode(gzip.compress(content, 9, mtime=0)).decode()


def named(group: str, settings: dict[str, Any]) -> dict[str, Any]:
    """Return the settings of a group, which the core takes by their names
    (lib/evolution/settings.hpp).

    Raises BotschoolError for a setting that the core does not know, and for one that is missing.
    """
    known = _core.settings(group).split(",")[:-1]
    odd = sorted({*known} ^ {*settings})
    if odd:
        raise BotschoolError(
            f"A page cannot have this experiment: the core of pages and {group} differ in "
            f"{', '.join(odd)} (lib/evolution/settings.hpp)."
        )
    return settings


def _algorithm(experiment: Experiment) -> dict[str, float] | None:
    """Return the algorithm's own hyperparameters; None for one that pages do not have. A choice
    between words is its place.
    """
    if experiment.exp.algo not in ALGORITHMS:
        return None
    own = [f for f in fields(experiment.algo) if f.name not in LENGTHS]
    values = {f.name: (getattr(experiment.algo, f.name), f.metadata) for f in own}
    return named(
        experiment.exp.algo,
        {
            name: list(known["choices"]).index(value) if isinstance(value, str) else value
            for name, (value, known) in values.items()
        },
    )


def _about(experiment: Experiment) -> str:
    """Return what the page's robots do, in words."""
    what = "evolves in this page, with the bits of the command"
    if experiment.exp.algo not in ALGORITHMS:
        what = f"acts in this page ({experiment.exp.algo} evolves it outside)"
    return f"{what}; nothing leaves your computer"


def _written(experiment: Experiment) -> dict[str, dict[str, Any]]:
    """Return the experiment without empty texts."""
    parts = to_dict(experiment)
    return {
        part: {key: value for key, value in values.items() if value != ""}
        for part, values in parts.items()
    }


def _fields(experiment: Experiment, problem: NativeProblem) -> list[dict]:
    """Return the fields that a user can change: [group, name, factor, most] for each."""
    most = problem.limit
    post = [] if experiment.policy.pmaxsteps else [["evaluation", "post_limit", 1, most]]
    places: dict[str, list] = {
        "episodes": [["evaluation", "episodes", 1, None]],
        "pepisodes": [["evaluation", "pepisodes", 1, None]],
        "maxsteps": [["evaluation", "limit", 1, most], *post],
        "maxmsteps": [["steps", "", 1e6, None]],
        "ngenerations": [["generations", "", 1, None]],
    }
    places |= {name: [["spec", name, 1, None]] for name in NETWORK}
    algorithm = _algorithm(experiment)
    if algorithm is None:
        return []
    places |= {name: [["algorithm", name, 1, None]] for name in algorithm}
    found = []
    for section, config in (("POLICY", experiment.policy), ("ALGO", experiment.algo)):
        for f in fields(config):
            if f.name not in places:
                continue
            limits, value = f.metadata, getattr(config, f.name)
            allowed = list(limits["choices"]) if "choices" in limits else None
            low, high = limits.get("low", -1e300), limits.get("high", 1e300)
            found.append(
                {
                    "section": section,
                    "key": f.name,
                    "value": value,
                    "help": limits["help"],
                    "whole": isinstance(value, int),
                    "low": low,
                    "high": high,
                    "above": limits.get("above"),
                    "allowed": allowed,
                    "needs": _needs(limits, isinstance(value, int)),
                    "into": places[f.name],
                }
            )
    return found


def _needs(limits: Any, whole: bool) -> str:
    """Return the requirement of a field in words."""
    if "choices" in limits:
        return "one of " + ", ".join(f"{v} ({text})" for v, text in limits["choices"].items())
    kind = "a whole number" if whole else "a number"
    low = f"above {limits['above']:g}" if "above" in limits else f"from {limits['low']:g} on"
    return f"{kind} {low}, at most {limits['high']:g}"


def shorter(script: str) -> str:
    """Return a script without indentation and comment lines."""
    lines = (line.strip() for line in script.splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("//")) + "\n"


def assemble(data: dict, seed: int) -> bytes:
    """Return the page of these data."""
    folder = files("botschool.page")
    read = {name: shorter((folder / name).read_text("utf-8")) for name in (*SCRIPTS, "worker.js")}
    scripts = "\n".join([*(read[name] for name in SCRIPTS), shorter(drawing(data["scene"]))])
    # a picture can have hundreds of shapes, as a ruler has marks
    shapes = json.dumps(data["scene"]["shapes"], separators=(",", ":")).encode()
    data = data | {"scene": data["scene"] | {"shapes": packed(shapes)}}
    # "<" never appears in the JSON, so nothing in it can end its element.
    text = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
    page = (folder / "page.html").read_text(encoding="utf-8")
    page = page.replace('step="1" value="1"', f'step="1" value="{seed}"')
    for place, content in (
        ("/*TITLE*/", data["title"]),
        ("/*SHARED*/", shorter((folder / "core.js").read_text("utf-8"))),
        ("/*WORKER*/", read["worker.js"]),
        ("/*SCRIPTS*/", scripts),
        ("/*CORE*/", packed(core(data["experiment"]["problem"]))),
        ("/*DATA*/", text),
    ):
        page = page.replace(place, content)
    return page.encode()
