"""Draw the pictures of the exercises on reinforcement learning."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from pathlib import Path

import numpy as np

BLUE, ORANGE, GREY = "#0072b2", "#d55e00", "#999999"


def draw_learning(
    file: str | Path,
    runs: dict[str, tuple[list[list[float]], float]],
    maps: dict[str, tuple[np.ndarray, tuple[str, str], tuple[float, ...], str]],
) -> None:
    """Draw every episode of some trainings as a dot, with the elite coloured; policies below.

    runs: title -> (for each iteration the returns of its episodes, percentile of the elite). maps:
    title -> (what the policy does over two observed numbers, shape (rows, columns), the first row
    at the bottom; the names of both numbers; their limits (left, right, bottom, top); the meaning
    of the colours).
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.6 * len(runs), 7), layout="constrained")
    grid = figure.subplots(2, len(runs), squeeze=False)
    for (title, (returns, percentile)), axes in zip(runs.items(), grid[0], strict=True):
        for iteration, values in enumerate(np.asarray(each) for each in returns):
            kept = values >= np.percentile(values, percentile)
            for these, colour in ((values[~kept], GREY), (values[kept], ORANGE)):
                axes.plot(np.full(len(these), iteration), these, ".", color=colour, markersize=4)
        means = [np.mean(each) for each in returns]
        axes.plot(means, color=BLUE, linewidth=2)
        axes.set(title=title, xlabel="iteration", ylabel="return")
        axes.spines[["top", "right"]].set_visible(False)
    marks = [axes.plot([], [], style, color=colour)[0] for style, colour in
             ((".", ORANGE), (".", GREY), ("-", BLUE))]  # fmt: skip
    figure.legend(marks, ("elite", "other episodes", "mean"), loc="outside upper center", ncols=3,
                  frameon=False)  # fmt: skip
    for (values, labels, limits, meaning), axes in zip(maps.values(), grid[1], strict=True):
        largest = float(np.abs(values).max())
        image = axes.imshow(values, extent=limits, origin="lower", aspect="auto", cmap="RdBu_r",
                            vmin=-largest, vmax=largest)  # fmt: skip
        axes.set(xlabel=labels[0], ylabel=labels[1])
        figure.colorbar(image, ax=axes, label=meaning)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def draw_hidden_layer(
    file: str | Path,
    stages: dict[str, tuple[list, np.ndarray, np.ndarray, np.ndarray]],
    names: list[str],
    axes: tuple[int, int],
    hidden: Callable[[list, np.ndarray], list[np.ndarray]],
    shown: int = 5,
) -> None:
    """Draw what the last hidden layer of a policy responds to, at some stages of training.

    stages: title -> (layers, observations (N, observed), activations (N, neurons), responses
    (neurons, observed)). On the left are the sorted responses of all neurons. On the right are the
    activations of `shown` neurons over the two observed numbers `axes` (a neuron that follows
    another number best: over that one and axes[1]), with the others 0 and the observations as
    dots: first the neuron that follows each observed number best, then the neurons
    whose activation varies most. hidden(layers, observations) returns the activations of each
    layer. names: the names of the observed numbers.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(3.4 + 2.5 * shown, 3.3 * len(stages) + 0.4), layout="constrained")
    parts = figure.subfigures(len(stages), 1, squeeze=False)[:, 0]
    for part, (title, (layers, seen, activations, responses)) in zip(
        parts, stages.items(), strict=True
    ):
        part.suptitle(title, fontsize=12)
        whole, *panels = part.subplots(1, shown + 1, width_ratios=[1.5, *[1] * shown])
        strongest = np.abs(responses).argmax(axis=1)
        order = np.lexsort((responses[np.arange(len(responses)), strongest], strongest))
        image = whole.imshow(responses[order], aspect="auto", cmap="RdBu_r", vmin=-1, vmax=1)
        whole.set_xticks(range(len(names)), [name.replace(" ", "\n") for name in names], fontsize=7)
        whole.set(ylabel="hidden neurons, sorted", yticks=[])
        part.colorbar(image, ax=whole, label="correlation")
        for neuron, panel in zip(_telling(activations, responses, shown), panels, strict=True):
            best = int(strongest[neuron])
            plane = axes if best in axes else (best, axes[1])
            _draw_field(panel, neuron, layers, seen, plane, hidden)
            value = responses[neuron, best]
            panel.set_title(f"neuron {neuron} follows\n{names[best]} ({value:+.2f})", fontsize=8)
            panel.set_xlabel(names[plane[0]], fontsize=8)
            panel.tick_params(labelsize=7)
        panels[0].set_ylabel(names[axes[1]], fontsize=8)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _telling(activations: np.ndarray, responses: np.ndarray, count: int) -> list[int]:
    """Return the best follower of each observed number, then the neurons that vary most."""
    chosen = list(dict.fromkeys(np.abs(responses).argmax(axis=0).tolist()))
    lively = np.argsort(-activations.std(axis=0)).tolist()
    return [*chosen, *(each for each in lively if each not in chosen)][:count]


def _draw_field(panel, neuron: int, layers: list, seen: np.ndarray, axes, hidden) -> None:
    limits = [(seen[:, axis].min(), seen[:, axis].max()) for axis in axes]
    across, up = (np.linspace(*limit, 60) for limit in limits)
    points = np.zeros((60 * 60, seen.shape[1]))
    points[:, axes[0]], points[:, axes[1]] = np.tile(across, 60), np.repeat(up, 60)
    field = np.asarray(hidden(layers, points)[-1])[:, neuron].reshape(60, 60)
    panel.imshow(
        field, extent=(*limits[0], *limits[1]), origin="lower", aspect="auto", cmap="RdBu_r",
        vmin=-1, vmax=1,
    )  # fmt: skip
    some = seen[:: max(1, len(seen) // 300)]
    panel.plot(some[:, axes[0]], some[:, axes[1]], ".", color="black", markersize=1, alpha=0.5)


VARIANTS = (BLUE, ORANGE, "#009e73", "#cc79a7", "#e69f00", "#56b4e9")
"""A colour for each variation of hyperparameters."""


def draw_indicators(
    file: str | Path,
    trainings: dict[str, tuple[list[dict], list[dict]]],
    names: tuple[str, ...],
) -> None:
    """Draw what trainings have logged: panels for each problem, a colour for each variation.

    trainings: problem -> (runs, each with its "variant"; for each run name of the indicator ->
    {"steps", "values"}). names: the names of the indicators.
    """
    from matplotlib.figure import Figure

    rows = -(-len(names) // 4)
    figure = Figure(figsize=(12, (2.2 * rows + 0.8) * len(trainings)), layout="constrained")
    parts = figure.subfigures(len(trainings), 1, squeeze=False)[:, 0]
    of_all = _colours(trainings)
    for part, (title, (runs, logs)) in zip(parts, trainings.items(), strict=True):
        part.suptitle(title, fontsize=12)
        colours = {run["variant"]: of_all[run["variant"]] for run in runs}
        panels = part.subplots(rows, 4, squeeze=False).ravel()
        for name, panel in zip(names, panels, strict=False):
            for run, log in zip(runs, logs, strict=True):
                if name in log:
                    steps, values = log[name]["steps"], log[name]["values"]
                    colour = colours[run["variant"]]
                    panel.plot(steps, values, color=colour, linewidth=1, alpha=0.8)
            panel.set_title(name.split("/")[-1], fontsize=9)
            panel.tick_params(labelsize=7)
            panel.spines[["top", "right"]].set_visible(False)
            panel.set_xlabel("steps", fontsize=8)
            if name == "train/approx_kl":
                panel.set_yscale("symlog", linthresh=0.01)
                panel.set_ylim(bottom=0)
            if name == "train/explained_variance":
                panel.set_ylim(-1, 1.05)
        lines = [panel.plot([], [], color=colour)[0] for colour in colours.values()]
        part.legend(lines, colours, loc="outside lower center", ncols=6, frameon=False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def draw_trainings(
    file: str | Path,
    trainings: dict[str, tuple[list[dict], list[dict]]],
    together: dict[str, np.ndarray],
    curves: dict[str, list[dict]],
) -> None:
    """Draw how trainings ended, a panel for each problem; then learning curves of several kinds.

    trainings: as for draw_indicators, runs with their "return". curves: name -> for each run
    {"steps", "best"}. together: the "steps" that all runs share, and for each name the best of its
    runs at these steps, shape (runs, steps).
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.2 * len(trainings) + 5.6, 4.2), layout="constrained")
    colours = _colours(trainings)
    *panels, last = figure.subplots(1, len(trainings) + 1, width_ratios=[3] * len(trainings) + [4])
    for panel, (title, (runs, _)) in zip(panels, trainings.items(), strict=True):
        names = list(dict.fromkeys(run["variant"] for run in runs))
        for place, variant in enumerate(names):
            returns = [run["return"] for run in runs if run["variant"] == variant]
            colour = colours[variant]
            panel.plot(np.full(len(returns), place), returns, "o", color=colour, alpha=0.6)
            panel.hlines(np.mean(returns), place - 0.3, place + 0.3, color=colour, linewidth=3)
        labels = [variant.replace(" ", "\n") for variant in names]
        panel.set_xticks(range(len(names)), labels, fontsize=8)
        panel.set(title=title, ylabel="return of the last post-evaluation")
        if min(run["return"] for run in runs) >= 0:
            panel.set_ylim(0, None)
        panel.set_xlim(-0.6, len(names) - 0.4)
    for (name, group), colour in zip(curves.items(), VARIANTS, strict=False):
        for curve in group:
            last.step(curve["steps"], curve["best"], where="post", color=colour, lw=1, alpha=0.35)
        mean = together[name].mean(axis=0)
        last.plot(together["steps"], mean, color=colour, linewidth=3, label=f"{name}, mean")
    last.axvspan(together["steps"][0], together["steps"][-1], color=GREY, alpha=0.15, lw=0)
    last.set(xscale="log", xlabel="steps, including post-evaluations")
    last.set(ylabel="best post-evaluation so far", title="equal steps (grey), and beyond")
    last.legend(frameon=False, loc="upper left")
    for panel in (*panels, last):
        panel.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def film_training(file: str | Path, folder: str | Path) -> None:
    """Film an episode of the best model in a training's folder."""
    from botschool.course.films import film_agent
    from botschool.rl.agent import Agent
    from botschool.rl.folder import RunFolder

    found = RunFolder(folder)
    agent = Agent.load(found.best)
    act = lambda observation: agent.act(np.asarray(observation)[None])[0][0]  # noqa: E731
    film_agent(file, found.settings().env, act, seed=1, maxsteps=500)


def _colours(trainings: dict[str, tuple[list[dict], list[dict]]]) -> dict[str, str]:
    """Return variant -> colour, the same for all problems."""
    variants = dict.fromkeys(run["variant"] for runs, _ in trainings.values() for run in runs)
    return dict(zip(variants, itertools.cycle(VARIANTS), strict=False))
