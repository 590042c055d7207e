"""Write an exercise's text as a self-contained page with figures that answer the hand.

A text names its figures, `<!-- figure: NAME -->`. Their script is figure.js beside it. Where they
need robots or numbers, figures/exNN.py says which (docs/architecture.md).
"""

from __future__ import annotations

import json
import re
from base64 import b64encode
from collections.abc import Callable
from importlib import import_module
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

from botschool import config, problems
from botschool.output import save_bytes
from botschool.page import core_file, describe, packed, shorter
from botschool.page.markdown import FIGURE, render
from botschool.paths import HINTS, material
from botschool.problems.native import NativeProblem
from botschool.render.replay import drawing, palette

SCRIPTS = (
    "core.js", "scenes.js", "hands.js", "figures/steps.js", "figures/kit.js", "figures/plot.js",
    "figures/robot.js",
)  # fmt: skip
PAGE = "page.html"
"""The page's name in the folder of its exercise."""
POINTER = re.compile(r"^\*\*See and touch it:\*\* .*?(`botschool start \d+`).*\n\n", re.MULTILINE)
"""The paragraph of a text that names the command which opens its page."""


def has_page(folder: Path) -> bool:
    """Return whether the text of an exercise names figures."""
    text = folder / "README.md"
    return text.is_file() and bool(FIGURE.search(text.read_text(encoding="utf-8")))


def write_exercise_page(
    folder: Path, path: Path | None = None, link: Callable[[str], str] = lambda target: target
) -> Path:
    """Write the page of an exercise and return its path.

    folder: exercises/exNN_name. path: the page; by default PAGE in the folder. link: as in
    `render`.
    """
    path = path or folder / PAGE
    save_bytes(path, exercise_page(folder, link).encode())
    return path


def linked(text: str, target: str) -> str:
    """Return a text whose pointer to the page is a link to it."""
    found = rf"**See and touch it:** [this text as a page]({target}) with figures that you can drag"
    return POINTER.sub(found + r"; \1 opens it.\n\n", text)


def exercise_page(folder: Path, link: Callable[[str], str] = lambda target: target) -> str:
    """Return the page of an exercise. Raises BotschoolError."""
    name = folder.name[:4]
    text = (folder / "README.md").read_text(encoding="utf-8")
    data, core = needs(name)
    place = files("botschool.page")
    read = [shorter((place / script).read_text("utf-8")) for script in SCRIPTS]
    own = folder / "figure.js"
    if own.is_file():
        read.append(shorter(own.read_text("utf-8")))
    page = (place / "exercise.html").read_text(encoding="utf-8")
    title = text.partition("\n")[0].lstrip("# ")
    for mark, content in (
        ("/*TITLE*/", title),
        ("/*TEXT*/", render(POINTER.sub("", text.partition(HINTS)[0]), folder, link)),
        ("/*DATA*/", packed(json.dumps(data, separators=(",", ":")).encode())),
        ("/*CORE*/", packed(core) if core else ""),
        ("/*SCRIPTS*/", "\n".join([_painter(data), *read])),
    ):
        page = page.replace(mark, content)
    return page


def needs(name: str) -> tuple[dict[str, Any], bytes]:
    """Return the data of an exercise's figures, and the core that they run (b"": none)."""
    data: dict[str, Any] = {"palette": palette() | {"line": ["#d6dae0", "#2d343e"]}}
    if find_spec(f"botschool.page.figures.{name}") is None:
        return data, b""
    module = import_module(f"botschool.page.figures.{name}")
    part = module.CORE
    core = core_file(part) if part else b""
    return data | module.data(), core


def robot(
    experiment: str, saved: str | np.ndarray | None = None, seed: int = 1, **policy: Any
) -> dict[str, Any]:
    """Return what `new Robot(...)` of figures/robot.js needs.

    experiment: a file of data/experiments. saved: a file of data/genotypes, or numbers as run files
    hold them; None is the random robot that the seed's run begins with. policy: changes of the
    experiment's section [POLICY].
    """
    read = config.load(material() / "data" / "experiments" / experiment)
    for key, value in policy.items():
        setattr(read.policy, key, value)
    problem = problems.of(read)
    assert isinstance(problem, NativeProblem)
    made = problem.policy(read.policy)
    found = describe(read, problem, made) | {"seed": seed}
    del found["palette"]
    if saved is None:
        return found
    file = material() / "data" / "genotypes" / saved if isinstance(saved, str) else None
    numbers = np.asarray(saved if file is None else np.load(file), dtype="<f8")
    if numbers.ndim == 2:
        numbers = numbers[[0, len(numbers) // 2]].ravel()
    single = numbers.astype("<f4")
    name, kept = ("robot", single) if (single == numbers).all() else ("exact", numbers)
    return found | {name: b64encode(kept.tobytes()).decode()}


def _painter(data: dict[str, Any]) -> str:
    """Return a function of JavaScript that makes a function which draws a scene's steps."""
    scenes = [each["scene"] for each in data.values() if isinstance(each, dict) and "scene" in each]
    if not scenes:
        return ""
    spatial = [scene for scene in scenes if "space" in scene]
    draw, _, charts = drawing((spatial or [None])[0]).partition("// The charts\n")
    both = shorter(draw + charts[charts.find("// Draws a body in space") :] if spatial else draw)
    return f"""
function painter(scene) {{
const data = {{ palette: page.palette, scene, groups: [] }};
const [clamp, byId] = [between, () => null];
let [shown, time, closeup] = [null, 0, -1];
const numbersAt = (step = time) => shown.steps[Math.floor(step)];
{both}
return (pen, width, height, steps, near = -1) => {{
const [rows, columns] = [steps.length, steps[0].length];
const values = new Float64Array(rows * columns);
steps.forEach((row, i) => row.forEach((value, column) => {{ values[column * rows + i] = value; }}));
[shown, time, closeup] = [{{ steps, rows, numbers: {{ rows, columns, values }} }}, rows - 1, near];
if (scene.space) drawSpace(pen, width, height);
else drawScene(pen, width, height);
}};
}}
"""
