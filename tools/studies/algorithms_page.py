"""Tables and figure of docs/reports/algorithms.md, from runs of algorithms.py."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
from algorithms import (
    LONG_METHODS,
    LONG_PROBLEMS,
    LONGER,
    METHODS,
    MORE,
    POINTS,
    PROBLEMS,
    PYCMA,
    SETTINGS,
    TRIED,
    WITH_PYCMA,
    chosen,
)
from matplotlib.figure import Figure
from report import Table
from results_figures import COLOURS, GREY, panel

DOCS = Path(__file__).parents[2] / "docs"
PAGE = DOCS / "reports" / "algorithms.md"
DATA = Path(__file__).parent / "data" / "algorithms"
NAMES = [method.name for method in METHODS]


def markdown(columns: list[str], rows: list[list[str]]) -> str:
    return Table("", "", columns, rows).markdown()


def differ(a, b) -> float:
    """Mann and Whitney's two-sided p of two samples, with the normal approximation and ties."""
    both = np.concatenate([a, b])
    ranks = np.array([(both < x).sum() + ((both == x).sum() + 1) / 2 for x in both])
    n, m = len(a), len(b)
    _, ties = np.unique(both, return_counts=True)
    share = (ties**3 - ties).sum() / ((n + m) * (n + m - 1))
    variance = n * m / 12 * (n + m + 1 - share)
    if variance == 0:
        return 1.0
    distance = abs(ranks[:n].sum() - n * (n + m + 1) / 2)
    return math.erfc(max(0, distance - 0.5) / math.sqrt(2 * variance))


def returns(done, problem, name: str) -> np.ndarray:
    """In new episodes, of each seed."""
    return np.array([r["new"] for r in done.of(problem.file, name)])


def cell(values: np.ndarray, best: np.ndarray) -> str:
    """Mean and deviation; bold if the best ones are not surely better."""
    text = f"{values.mean():.1f} +- {values.std(ddof=1):.1f}"
    return f"**{text}**" if differ(values, best) >= 0.05 else text


def reached(done) -> str:
    """A row for each problem: mean return of the best robots in new episodes."""
    rows = []
    for problem in PROBLEMS:
        found = {name: returns(done, problem, name) for name in NAMES}
        best = max(found.values(), key=np.mean)
        cells = [cell(values, best) for values in found.values()]
        rows.append([problem.file, f"{problem.steps:g} M", *cells])
    return markdown(["problem", "steps", *NAMES], rows)


def order(done) -> str:
    """Of each problem: who is better than whom."""
    rows = []
    for problem in PROBLEMS:
        found = {name: returns(done, problem, name) for name in NAMES}
        ranked = sorted(NAMES, key=lambda name: -found[name].mean())
        openai = found["OpenAI-ES"]
        better, worse = [], []
        for name in ranked:
            if name != "OpenAI-ES" and differ(found[name], openai) < 0.05:
                (better if found[name].mean() > openai.mean() else worse).append(name)
        rows.append([
            problem.file, " > ".join(f"{n}" for n in ranked),
            ", ".join(better) or "none", ", ".join(worse) or "none",
        ])  # fmt: skip
    return markdown(
        ["problem", "by their means", "better than OpenAI-ES", "worse than OpenAI-ES"], rows
    )


def pycma(tried, done, longer) -> str:
    """CMA-ES and xNES beside pycma: means, ranges, and whether they differ from it."""
    rows = []
    for problem in PROBLEMS:
        if problem.file not in WITH_PYCMA:
            continue
        other = returns(done, problem, PYCMA.name)
        found = {}
        for method in [m for m in METHODS if m.name in ("CMA-ES", "xNES")] + [PYCMA]:
            name = f"{method.name}, sigma {chosen(tried, problem, method):g}"
            found[name] = returns(done, problem, method.name)
        for again in longer.of(problem.file, "xNES")[:1]:
            name = f"xNES, sigma {again['setting']:g}"
            found[name] = returns(longer, problem, "xNES")
        for name, of in found.items():
            p = "-" if name.startswith(PYCMA.name) else f"{differ(of, other):.2f}"
            spread = f"{of.mean():.1f} +- {of.std(ddof=1):.1f}"
            limits = f"{of.min():.1f} to {of.max():.1f}"
            rows.append([problem.file, name, str(len(of)), spread, limits, p])
    return markdown(["problem", "", "seeds", "in new episodes", "range", "p"], rows)


def long(longer) -> str:
    """Runs of LONGER times as many steps."""
    rows = []
    for problem in PROBLEMS:
        if problem.file in LONG_PROBLEMS:
            found = {name: returns(longer, problem, name) for name in LONG_METHODS}
            best = max(found.values(), key=np.mean)
            cells = [cell(values, best) for values in found.values()]
            count = str(min(map(len, found.values())))
            rows.append([problem.file, f"{LONGER * problem.steps:g} M", count, *cells])
    return markdown(["problem", "steps", "seeds", *LONG_METHODS], rows)


def settings(tried) -> str:
    """What was tried and chosen."""
    rows = [
        [problem.file, *(f"{chosen(tried, problem, method):g}" for method in METHODS)]
        for problem in PROBLEMS
    ]
    return markdown(["problem", *NAMES], rows)


def seconds(done) -> str:
    """Processor time of a run."""
    rows = []
    for problem in PROBLEMS:
        times = [np.mean([r["seconds"] for r in done.of(problem.file, n)]) for n in NAMES]
        rows.append([problem.file, *(f"{t:.1f} s" for t in times)])
    return markdown(["problem", *NAMES], rows)


def figure(done) -> Figure:
    """Learning curves: the median of the seeds, and the middle half of them."""
    made = Figure(figsize=(11, 6), layout="constrained")
    for axes, problem in zip(made.subplots(2, 3).ravel(), PROBLEMS, strict=True):
        steps = np.linspace(0, problem.steps, POINTS + 1)[1:]
        for name, colour in zip(NAMES, (*COLOURS, GREY), strict=True):
            rows = np.array([r["curve"] for r in done.of(problem.file, name)], dtype=float)
            low, middle, high = np.nanpercentile(rows, (25, 50, 75), axis=0)
            axes.fill_between(steps, low, high, color=colour, alpha=0.15, lw=0)
            axes.plot(steps, middle, color=colour, linewidth=1.8, label=name)
        panel(axes, title=problem.file)
    made.supxlabel("million steps")
    made.supylabel("best post-evaluated so far")
    handles, labels = axes.get_legend_handles_labels()
    made.legend(handles, labels, frameon=False, ncols=len(NAMES), loc="outside upper center")
    return made


def seeds(done) -> int:
    """Seeds that every method has run on every problem."""
    return min(len(done.of(problem.file, name)) for problem in PROBLEMS for name in NAMES)


def more(tried, done) -> str:
    """The algorithms with fewer seeds, beside some of the others on the same seeds."""
    names = [method.name for method in MORE]
    count = min(len(done.of(problem.file, name)) for problem in PROBLEMS for name in names)
    rows = []
    for problem in PROBLEMS:
        beside = ("OpenAI-ES", "sNES", "SSS", *names)
        found = [returns(done, problem, name)[:count] for name in beside]
        means = [f"{values.mean():.1f} +- {values.std(ddof=1):.1f}" for values in found]
        sizes = ", ".join(f"{chosen(tried, problem, method):g}" for method in MORE)
        rows.append([problem.file, f"{problem.steps:g} M", str(count), *means, sizes])
    columns = ["problem", "steps", "seeds", "OpenAI-ES", "sNES", "SSS", *names]
    return markdown([*columns, f"keys of {', '.join(names)}"], rows)


BLOCKS = {
    "more": lambda tried, done, longer: more(tried, done),
    "reached": lambda tried, done, longer: reached(done),
    "order": lambda tried, done, longer: order(done),
    "longer": lambda tried, done, longer: long(longer),
    "pycma": pycma,
    "settings": lambda tried, done, longer: settings(tried),
    "seconds": lambda tried, done, longer: seconds(done),
}


def filled(text: str, tried, done, longer) -> str:
    """The page with its blocks made anew."""
    for name, block in BLOCKS.items():
        pattern = rf"(<!-- {name} -->\n).*?(<!-- end -->)"
        content = block(tried, done, longer)
        text, count = re.subn(pattern, lambda m, c=content: f"{m[1]}{c}\n{m[2]}", text, flags=re.S)
        assert count == 1, name
    return text


def write(tried, done, longer) -> None:
    """Keeps the runs in docs, writes the tables, draws the figure."""
    DATA.mkdir(parents=True, exist_ok=True)
    for name, of in (("tried", tried), ("runs", done), ("longer", longer)):
        lines = [json.dumps(each) for each in of.runs]
        (DATA / f"{name}.jsonl").write_text("\n".join(lines) + "\n", encoding="utf-8")
    print(f"{seeds(done)} seeds, {len(SETTINGS)} settings tried on {len(TRIED)} seeds")
    text = filled(PAGE.read_text(encoding="utf-8"), tried, done, longer)
    PAGE.write_text(text, encoding="utf-8")
    figure(done).savefig(DOCS / "images" / "algorithms.png", dpi=110, metadata={"Software": None})
