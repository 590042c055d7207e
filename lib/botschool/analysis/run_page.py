"""Write one page about a run: curve, best robot, settings, the command to repeat it.

The page is a single file that needs no other: you can open, mail and keep it.
"""

from __future__ import annotations

import io
import shlex
import tempfile
from contextlib import redirect_stdout
from dataclasses import fields
from html import escape
from importlib.resources import files
from math import ceil, floor, log10
from pathlib import Path
from string import Template

import numpy as np

from botschool.analysis.runs import (
    BEST_POST,
    GENERATION_AVERAGE,
    GENERATION_BEST,
    STEPS,
    read_stat,
)
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.record import RunFiles
from botschool.output import save_bytes
from botschool.terminal import readable

WIDTH, HEIGHT, LEFT, BOTTOM = 720, 260, 84, 30
"""Size of the curve in pixels, and the space that its labels take."""
POINTS = 400
"""Largest number of points of a curve."""
LINES = (
    (BEST_POST, "best", "best so far, post-evaluated"),
    (GENERATION_BEST, "own", "best of the generation"),
    (GENERATION_AVERAGE, "mean", "mean of the generation"),
)
EPISODES = 2


def has_begun(folder: Path, seed: int) -> bool:
    """Return whether the run has saved a generation."""
    return np.load(folder / f"statS{seed}.npy", allow_pickle=False).size > 0


def write_page(experiment: Experiment, seed: int, folder: Path, robot: bool = True) -> Path:
    """Write pageSS.html from what the run has saved so far, and return its path.

    robot: whether the page plays the best robot. Raises BotschoolError if the folder holds no such
    run, if no generation is saved yet, or if the page cannot be written.
    """
    rows = read_stat(folder / f"statS{seed}.npy")
    path = folder / f"pageS{seed}.html"
    last = rows[-1]
    facts = {
        "generations": len(rows),
        "steps": f"{int(last[STEPS]):,}",
        "best post-evaluated": readable(last[BEST_POST]),
        "mean of the last generation": readable(last[GENERATION_AVERAGE]),
    }
    name = experiment.path.name if experiment.path else "experiment.ini"
    command = f"botschool es -f {shlex.quote(name)} -s {seed}"
    text = Template((files("botschool.analysis") / "run_page.html").read_text(encoding="utf-8"))
    filled = text.substitute(
        title=escape(f"{experiment.exp.environment}, seed {seed}"),
        facts="".join(f"<div><b>{value}</b>{key}</div>" for key, value in facts.items()),
        curve=curve(rows),
        robot=_replay(experiment, seed, folder) if robot else "",
        command=escape(command),
        watch=escape(f"{command} -p -g {RunFiles(folder, seed).bestg.name}"),
        settings="".join(_settings(part, getattr(experiment, part)) for part in experiment.parts),
    )
    save_bytes(path, filled.encode())
    return path


def curve(rows: np.ndarray) -> str:
    """Return fitness against steps as SVG; rows: of a stat file, shape (generations, 6)."""
    rows = rows[np.unique(np.linspace(0, len(rows) - 1, POINTS).round().astype(int))]
    values = rows[:, [column for column, _, _ in LINES]]
    low, high = np.nanmin(values), np.nanmax(values)
    high = high if high > low else low + max(1.0, abs(low))
    right = max(rows[-1, STEPS], 1.0)

    def place(step: float, value: float) -> str:
        x = LEFT + (WIDTH - LEFT - 10) * step / right
        y = 10 + (HEIGHT - BOTTOM - 10) * (high - value) / (high - low)
        return f"{x:.1f},{y:.1f}"

    parts = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" role="img" aria-label="fitness against steps">']
    for value in ticks(low, high):
        left, end = place(0, value), place(right, value)
        parts.append(f'<polyline class="grid" points="{left} {end}"/>')
        y = float(left.split(",")[1]) + 4
        parts.append(f'<text x="{LEFT - 8}" y="{y:.1f}" class="end">{value:.10g}</text>')
    for steps in (marks := ticks(0, right)):
        x = float(place(steps, low).split(",")[0])
        label = f"{steps / 1e6:g} M" if right >= 1e5 else f"{steps:g}"
        label += " steps" if steps == marks[-1] else ""
        anchor = "start" if steps == 0 else "end" if x > WIDTH - 50 else "middle"
        parts.append(f'<text x="{x:.1f}" y="{HEIGHT - 8}" text-anchor="{anchor}">{label}</text>')
    for column, kind, _ in reversed(LINES):
        points = [place(row[STEPS], row[column]) for row in rows if np.isfinite(row[column])]
        parts.append(f'<polyline class="{kind}" points="{" ".join(points)}"/>')
    legend = " ".join(f'<span class="{kind}">{words}</span>' for _, kind, words in LINES)
    return "".join(parts) + f"</svg><p class=legend>{legend}</p>"


def ticks(low: float, high: float) -> list[float]:
    """Return two to five round numbers between two limits: multiples of 1, 2 or 5 times 10^n."""
    size = 10.0 ** floor(log10((high - low) / 4))
    step = min(s * size for s in (1, 2, 5, 10) if s * size >= (high - low) / 4)
    return [float(f"{k * step:.10g}") for k in range(ceil(low / step), floor(high / step) + 1)]


def _replay(experiment: Experiment, seed: int, folder: Path) -> str:
    """Return the best robot's replay, a page within the page; or the reason why there is none."""
    from botschool.render.watch import PostEvaluation, read_genotype

    best = RunFiles(folder, seed).bestg
    if not best.exists():
        return "<p>No robot is saved yet.</p>"
    try:
        watched = PostEvaluation(experiment, seed, read_genotype(best), best.name)
        with tempfile.TemporaryDirectory() as scratch, redirect_stdout(io.StringIO()):
            path = Path(scratch) / "replay.html"
            watched.write_replay(path, min(watched.available, EPISODES))
            page = path.read_text(encoding="utf-8")
    except BotschoolError as error:
        return f"<p>The robot cannot be shown: {escape(str(error))}</p>"
    return f'<iframe title="the best robot" srcdoc="{escape(page)}"></iframe>'


def _settings(part: str, config) -> str:
    """Return a section's keys and values; values that are not the default are emphasised."""
    rows = []
    for f in fields(config):
        value = getattr(config, f.name)
        if value in ("", None, ()):
            continue
        kind = "" if value == f.default else " class=own"
        rows.append(f"<tr{kind}><td>{escape(f.name)}</td><td>{escape(str(value))}</td></tr>")
    return f"<table><caption>[{part.upper()}]</caption>{''.join(rows)}</table>"
