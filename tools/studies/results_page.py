"""Sections and figures of docs/reports/results.md and bodies.md, made from data/."""

from __future__ import annotations

import json
from functools import partial

import numpy as np
from evolved import BOX2D, ROWS, grid
from matplotlib.figure import Figure
from planar_runs import GAIT, RUNNERS
from study import COLOURS, DATA, REPORTS, Page, panel, spread, table
from trained import PROBLEMS

PARTS = ("box2d", "evolved", "planar", "planarspeed", "ppo", "speed", "trained")
PUBLISHED_PPO = {"CartPole-v1": "500", "Pendulum-v1": "-172 +- 104", "Acrobot-v1": "-73.5 +- 18"}
SPEED = ("others", "gymnasium", "workers", "runs", "memory")
PLANAR_SPEED = ("runners", "runnerworkers")
"""Parts of the bench that the pages show."""
SURE = 0.9
"""Share of new episodes in which a runner must go ten body lengths, or never fall, to count."""
SHARES = (10, 25, 50, 75, 100)


def conditions(parts: dict) -> str:
    """Where each part was measured."""
    rows = [
        [name, str(s["minutes"] or "-"), s["date"], s["commit"], s["machine"], s["note"]]
        for name, s in ((name, part["measured"]) for name, part in parts.items())
    ]
    return table(["part", "minutes", "date", "commit", "machine", "meanwhile"], rows)


def solved(row, runs: list[dict]) -> str:
    """How many runs solved the problem, and the steps that took."""
    if row.solved is None:
        return "-"
    after = [each["solved"] / 1e6 for each in runs if each["solved"] is not None]
    count = f"{row.solved:g} on {len(after)} of {len(runs)}"
    return f"{count}: {np.median(after):.2g} M, {max(after):.2g} M" if after else count


def evolved(parts: dict) -> str:
    """A row for each experiment file."""
    lines = []
    found = parts["evolved"]["data"] | parts["box2d"]["data"]
    for row in ROWS + BOX2D:
        of, runs = found[row.file], found[row.file]["runs"]
        best, new, seconds = ([each[key] for each in runs] for key in ("best", "new", "seconds"))
        lines.append([
            f"{row.file}.ini", of["algorithm"], f"{of['steps']:g} M", str(len(runs)), spread(best),
            f"{min(best):.1f} to {max(best):.1f}", f"{np.mean(new):.1f}", solved(row, runs),
            row.published, f"{np.mean(seconds):.1f} s",
        ])  # fmt: skip
    return table(
        [
            "experiment", "algorithm", "steps", "seeds", "best post-evaluated", "range",
            "in new episodes", "solved (steps)", "published", "a run, one core",
        ],
        lines,
    )  # fmt: skip


def planar(parts: dict) -> str:
    """A row for each runner, and where that was measured."""
    rows = []
    for file, of in parts["planar"]["data"].items():
        runs = of["runs"]
        best, new, metres, seconds = (
            [each[key] for each in runs] for key in ("best", "new", "metres", "seconds")
        )
        sure, whole = (sum(each[key] >= SURE for each in runs) for key in ("lengths", "upright"))
        finer = [100 * each["finer"][1] / each["finer"][0] for each in runs]
        rows.append([
            f"{file}.ini", f"{of['steps']:g} M", str(len(runs)), spread(best, 0),
            f"{min(best):.0f} to {max(best):.0f}", spread(new, 0), spread(metres),
            f"{min(metres):.1f} to {max(metres):.1f}", f"{sure} of {len(runs)}",
            f"{whole} of {len(runs)}", f"{min(finer):.0f} to {max(finer):.0f} %",
            f"{np.mean(seconds):.0f} s",
        ])  # fmt: skip
    columns = [
        "experiment", "steps", "seeds", "best post-evaluated", "range", "in new episodes",
        "metres", "range", "ten lengths", "no falls", "half the substep", "a run, one core",
    ]  # fmt: skip
    at = parts["planar"]["measured"]
    stamp = f"({at['date']}, commit {at['commit']}, {at['minutes']} minutes. {at['note']})"
    return f"{table(columns, rows)}\n\n{stamp}"


def tables(part: str, measured: str = "speed"):
    """A function that gives the tables of a part of the bench, without its internal targets."""

    def shown(parts: dict) -> str:
        texts = []
        for of in parts[measured]["data"][part]:
            kept = [i for i, name in enumerate(of["columns"]) if name not in ("", "target")]
            columns = [of["columns"][i] for i in kept]
            rows = [[row[i] for i in kept] for row in of["rows"]]
            texts.append(f"**{of['title']}**\n\n{table(columns, rows)}\n\n{of['about']}")
        return "\n\n".join(texts)

    return shown


def trained(parts: dict) -> str:
    """PPO's defaults."""
    rows = []
    for problem, runs in parts["trained"]["data"].items():
        best, last = ([each[key] for each in runs] for key in ("best", "last"))
        rows.append([
            problem, str(len(runs)), spread(best), f"{min(best):.1f} to {max(best):.1f}",
            spread(last), f"{min(last):.1f} to {max(last):.1f}", str(PROBLEMS[problem]),
            PUBLISHED_PPO[problem],
        ])  # fmt: skip
    columns = ["problem", "seeds", "best model", "range", "last model", "range", "aim", "rl-zoo"]
    return table(columns, rows)


def ppo(parts: dict) -> str:
    """Two PPOs side by side."""
    rows, sentences = [], []
    for problem, found in parts["ppo"]["data"].items():
        for library, of in found["libraries"].items():
            curves = np.array(of["curves"])
            at = [curves[:, curves.shape[1] * share // 100 - 1] for share in SHARES]
            rows.append([problem, library, *(spread(each, 0) for each in at), spread(of["new"])])
        sentences.append(found["agreement"])
    columns = ["problem", "PPO of", *(f"{share} %" for share in SHARES), "new episodes"]
    return "\n\n".join([table(columns, rows), *sentences])


def curves(axes, steps, rows, colour: str, label: str | None = None) -> None:
    """A thin line for each seed, a thick one for their median."""
    rows = np.array(rows, dtype=float)
    axes.plot(steps, rows.T, color=colour, linewidth=0.6, alpha=0.5)
    axes.plot(steps, np.median(rows, axis=0), color=colour, linewidth=2.2, label=label)


def evolved_figure(parts: dict) -> Figure:
    """Learning curves of every experiment."""
    found = parts["evolved"]["data"] | parts["box2d"]["data"]
    rows = ROWS + BOX2D
    columns = 4 if len(rows) > 6 else 3
    lines = -(-len(rows) // columns)
    figure = Figure(figsize=(3.1 * columns, 2.6 * lines), layout="constrained")
    panels = figure.subplots(lines, columns, squeeze=False).ravel()
    for axes, row in zip(panels, rows, strict=False):
        of = found[row.file]
        curves(axes, grid(of["steps"]) / 1e6, [run["curve"] for run in of["runs"]], COLOURS[0])
        if row.level is not None:
            axes.axhline(row.level, color=COLOURS[1], linestyle="--", linewidth=1.2)
        panel(axes, title=f"{row.file}.ini", xscale="log")
        axes.xaxis.set_major_formatter("{x:g}")
    for axes in panels[len(rows) :]:
        axes.set_visible(False)
    figure.supxlabel("million steps")
    figure.supylabel("best post-evaluated so far")
    return figure


def speed_figure(parts: dict) -> Figure:
    """Steps/s of all contestants on one core."""
    measured = parts["speed"]["data"]["others"][0]["numbers"]
    names = list(next(iter(measured.values())))
    figure = Figure(figsize=(9, 3.8), layout="constrained")
    axes = figure.subplots()
    width = 0.8 / len(names)
    for i, name in enumerate(names):
        rates = [found[name]["rate"] for found in measured.values()]
        places = np.arange(len(rates)) + (i - (len(names) - 1) / 2) * width
        bars = axes.bar(places, rates, width * 0.92, color=COLOURS[i], label=name)
        axes.bar_label(bars, [short(rate) for rate in rates], fontsize=7, padding=2)
    axes.set_xticks(range(len(measured)), list(measured))
    panel(axes, yscale="log", ylabel="steps / s, one core", ylim=(1e4, None))
    axes.grid(visible=False, axis="x")
    axes.legend(frameon=False, ncols=len(names), loc="lower center", bbox_to_anchor=(0.5, 1))
    return figure


def short(rate: float) -> str:
    """A number above a bar: 12 M, 480 k."""
    unit, letter = (1e6, "M") if rate >= 1e6 else (1e3, "k")
    return f"{rate / unit:.2g} {letter}" if rate / unit < 10 else f"{rate / unit:.0f} {letter}"


def es_and_ppo_figure(parts: dict) -> Figure:
    """Acrobot: both against steps and against time."""
    es = parts["evolved"]["data"]["acrobot"]
    runs = parts["trained"]["data"]["Acrobot-v1"]
    figure = Figure(figsize=(9, 3.6), layout="constrained")
    steps = grid(es["steps"])
    ppo_steps = np.mean([run["steps"] for run in runs], axis=0)
    best = [np.maximum.accumulate(run["curve"]) for run in runs]
    for axes, label, seconds in zip(
        figure.subplots(1, 2, sharey=True), ("steps", "seconds on one core"), (False, True),
        strict=True,
    ):  # fmt: skip
        for colour, name, at, rows, of in (
            (COLOURS[0], "OpenAI-ES", steps, [run["curve"] for run in es["runs"]], es["runs"]),
            (COLOURS[1], "PPO", ppo_steps, best, runs),
        ):
            time = np.mean([run["seconds"] for run in of])
            curves(axes, at / at[-1] * time if seconds else at, rows, colour, name)
        panel(axes, xscale="log", xlabel=label)
    figure.axes[0].set_ylabel("best post-evaluated so far")
    figure.axes[0].legend(frameon=False, loc="lower right")
    return figure


def ppo_figure(parts: dict) -> Figure:
    """Training curves of two PPOs."""
    found = parts["ppo"]["data"]
    figure = Figure(figsize=(10, 4), layout="constrained")
    for axes, (problem, of) in zip(figure.subplots(1, len(found)), found.items(), strict=True):
        for colour, (library, those) in zip(COLOURS, of["libraries"].items(), strict=False):
            rows = np.array(those["curves"])
            steps = np.arange(1, rows.shape[1] + 1) * of["steps"] / rows.shape[1] / 1000
            axes.fill_between(steps, rows.min(0), rows.max(0), alpha=0.2, color=colour, lw=0)
            axes.plot(steps, rows.T, color=colour, linewidth=0.5, alpha=0.5)
            axes.plot(steps, rows.mean(0), color=colour, linewidth=2.2, label=library)
        panel(axes, title=problem, xlabel="thousand steps")
        axes.legend(frameon=False, loc="lower right")
    figure.axes[0].set_ylabel("return, last 20 training episodes")
    return figure


def planar_figure(parts: dict) -> Figure:
    """Learning curves of the planar runners, and below when their feet touch the ground."""
    found = parts["planar"]["data"]
    figure = Figure(figsize=(10, 5.6), layout="constrained")
    upper, lower = figure.subplots(2, len(found))
    for above, below, (file, of) in zip(upper, lower, found.items(), strict=True):
        curves(above, grid(of["steps"]) / 1e6, [run["curve"] for run in of["runs"]], COLOURS[0])
        panel(above, title=f"{file}.ini", xscale="log", xlabel="million steps")
        above.xaxis.set_major_formatter("{x:g}")
        for run in of["runs"]:
            feet = run["gait"].values()
            for i, (colour, steps) in enumerate(zip(COLOURS, feet, strict=False)):
                place = run["seed"] - 0.4 + 0.8 * i / len(feet)
                seconds = RUNNERS[file].substep * RUNNERS[file].substeps
                touches = [(k * seconds, seconds) for k, touch in enumerate(steps) if touch == "1"]
                below.broken_barh(touches, (place, 0.8 / len(feet)), color=colour)
        panel(below, xlabel="seconds", yticks=[run["seed"] for run in of["runs"]], xlim=(0, GAIT))
        below.invert_yaxis()
    upper[0].set_ylabel("best post-evaluated so far")
    lower[0].set_ylabel("seed")
    return figure


SECTIONS = {
    "results": {
        "conditions": conditions,
        "evolved": evolved,
        "trained": trained,
        "ppo": ppo,
        **{part: tables(part) for part in SPEED},
    },
    "bodies": {
        "planar": planar,
        **{part: tables(part, "planarspeed") for part in PLANAR_SPEED},
    },
}
"""Report -> section -> who makes it."""
FIGURES = {
    "results": {
        "evolved": evolved_figure,
        "speed": speed_figure,
        "es_and_ppo": es_and_ppo_figure,
        "ppo_compare": ppo_figure,
    },
    "bodies": {"planar": planar_figure},
}


def pages() -> list[Page]:
    """Return both pages."""
    files = {name: (DATA / f"{name}.json").read_text(encoding="utf-8") for name in PARTS}
    parts = {name: json.loads(text) for name, text in files.items()}
    return [
        Page(
            REPORTS / f"{report}.md",
            {name: make(parts) for name, make in sections.items()},
            {name: partial(draw, parts) for name, draw in FIGURES[report].items()},
        )
        for report, sections in SECTIONS.items()
    ]
