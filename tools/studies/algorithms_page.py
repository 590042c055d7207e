"""Tables and figure of docs/reports/algorithms.md, from runs of algorithms.py."""

from __future__ import annotations

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
    WITH_PYCMA,
    chosen,
    load,
    runs_of,
)
from matplotlib.figure import Figure
from study import (
    COLOURS,
    GREY,
    REPORTS,
    Page,
    band,
    differ,
    legend_above,
    marked,
    panel,
    spread,
    table,
)

NAMES = [method.name for method in METHODS]


def returns(done, problem, name: str) -> np.ndarray:
    """In new episodes, of each seed."""
    return np.array([r["new"] for r in runs_of(done, problem, name)])


def cell(values: np.ndarray, best: np.ndarray) -> str:
    """Mean and deviation; bold if the best ones are not surely better."""
    return marked(spread(values), values, best)


def reached(done) -> str:
    """A row for each problem: mean return of the best robots in new episodes."""
    rows = []
    for problem in PROBLEMS:
        found = {name: returns(done, problem, name) for name in NAMES}
        best = max(found.values(), key=np.mean)
        cells = [cell(values, best) for values in found.values()]
        rows.append([problem.file, f"{problem.steps:g} M", *cells])
    return table(["problem", "steps", *NAMES], rows)


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
    return table(
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
        for again in runs_of(longer, problem, "xNES")[:1]:
            name = f"xNES, sigma {again['setting']:g}"
            found[name] = returns(longer, problem, "xNES")
        for name, of in found.items():
            p = "-" if name.startswith(PYCMA.name) else f"{differ(of, other):.2f}"
            limits = f"{of.min():.1f} to {of.max():.1f}"
            rows.append([problem.file, name, str(len(of)), spread(of), limits, p])
    return table(["problem", "", "seeds", "in new episodes", "range", "p"], rows)


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
    return table(["problem", "steps", "seeds", *LONG_METHODS], rows)


def settings(tried) -> str:
    """What was tried and chosen."""
    rows = [
        [problem.file, *(f"{chosen(tried, problem, method):g}" for method in METHODS)]
        for problem in PROBLEMS
    ]
    return table(["problem", *NAMES], rows)


def seconds(done) -> str:
    """Processor time of a run."""
    rows = []
    for problem in PROBLEMS:
        times = [np.mean([r["seconds"] for r in runs_of(done, problem, n)]) for n in NAMES]
        rows.append([problem.file, *(f"{t:.1f} s" for t in times)])
    return table(["problem", *NAMES], rows)


def figure(done) -> Figure:
    """Learning curves: the median of the seeds, and the middle half of them."""
    made = Figure(figsize=(11, 6), layout="constrained")
    for axes, problem in zip(made.subplots(2, 3).ravel(), PROBLEMS, strict=True):
        steps = np.linspace(0, problem.steps, POINTS + 1)[1:]
        for name, colour in zip(NAMES, (*COLOURS, GREY), strict=True):
            runs = runs_of(done, problem, name)
            band(axes, steps, [run["curve"] for run in runs], colour, name)
        panel(axes, title=problem.file)
    made.supxlabel("million steps")
    made.supylabel("best post-evaluated so far")
    legend_above(made, axes, len(NAMES))
    return made


def more(tried, done) -> str:
    """The algorithms with fewer seeds, beside some of the others on the same seeds."""
    names = [method.name for method in MORE]
    count = min(len(returns(done, problem, name)) for problem in PROBLEMS for name in names)
    rows = []
    for problem in PROBLEMS:
        beside = ("OpenAI-ES", "sNES", "SSS", *names)
        found = [returns(done, problem, name)[:count] for name in beside]
        sizes = ", ".join(f"{chosen(tried, problem, method):g}" for method in MORE)
        rows.append([problem.file, f"{problem.steps:g} M", str(count), *map(spread, found), sizes])
    columns = ["problem", "steps", "seeds", "OpenAI-ES", "sNES", "SSS", *names]
    return table([*columns, f"keys of {', '.join(names)}"], rows)


def pages() -> list[Page]:
    """Return the page, made from what is kept."""
    tried, done, longer = load()
    sections = {
        "more": more(tried, done),
        "reached": reached(done),
        "order": order(done),
        "longer": long(longer),
        "pycma": pycma(tried, done, longer),
        "settings": settings(tried),
        "seconds": seconds(done),
    }
    return [Page(REPORTS / "algorithms.md", sections, {"algorithms": lambda: figure(done)})]
