"""Draw pictures that several exercises need."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from botschool.course.films import first_frame

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_curves(
    file: str | Path,
    mean: np.ndarray,
    deviation: np.ndarray,
    title: str = "",
) -> None:
    """Draw a mean curve over generations with its band of one standard deviation."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 5), layout="constrained")
    axes = figure.subplots()
    mean, deviation = np.asarray(mean), np.asarray(deviation)
    generations = np.arange(1, len(mean) + 1)
    axes.fill_between(generations, mean - deviation, mean + deviation, alpha=0.25, color="#0072b2")
    axes.plot(generations, mean, color="#0072b2", linewidth=2)
    axes.set(xlabel="generation", ylabel="fitness", title=title)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def draw_distributions(
    file: str | Path, values: dict[str, np.ndarray], title: str = "", label: str = "return"
) -> None:
    """Draw a row of histograms, one for each Gymnasium environment, with its picture above.

    values: environment id -> any number of values.
    """
    from matplotlib.figure import Figure
    from matplotlib.ticker import MaxNLocator

    figure = Figure(figsize=(2.8 * len(values), 5.2), layout="constrained")
    grid = figure.subplots(2, len(values), squeeze=False, height_ratios=(1, 1.1))
    for (environment, numbers), picture, axes in zip(values.items(), *grid, strict=True):
        frame = first_frame(environment)
        picture.imshow(frame)
        height, width = frame.shape[:2]
        margin = max(0.0, 0.75 * height - 0.5 * width)  # all of the shape 3 : 2
        picture.set(xlim=(-margin, width + margin))
        picture.set_title(environment, fontsize=11)
        picture.axis("off")
        mean, alike = float(np.mean(numbers)), np.ptp(numbers) == 0
        span = (mean - 10, mean + 10) if alike else None
        axes.hist(numbers, bins=21, range=span, color="#0072b2", alpha=0.85)
        axes.axvline(mean, color="#d55e00", linewidth=2)
        axes.set_title(f"mean {mean:.1f}, best {np.max(numbers):.1f}", fontsize=10)
        axes.set_xlabel(label)
        axes.xaxis.set_major_locator(MaxNLocator(4))
        axes.yaxis.set_major_locator(MaxNLocator(4, integer=True))
        axes.spines[["top", "right"]].set_visible(False)
    grid[1, 0].set_ylabel("how many")
    figure.suptitle(title)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def draw_verdicts(
    file: str | Path,
    panels: dict[str, list[tuple[np.ndarray, dict]]],
    columns: int,
) -> None:
    """Draw fitness curves, coloured by their stability, with the largest fall of each marked.

    Of several rows, the panels of each share their vertical axis.

    panels: title -> (curve, verdict) of each replication. A verdict is a dict with "drop", "peak",
    "bottom" and "verdict" ("monotonic", "mild regressions" or "severe regressions").
    """
    from matplotlib.figure import Figure

    colours = {
        "monotonic": "#0072b2",
        "mild regressions": "#e69f00",
        "severe regressions": "#c1272d",
    }
    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(4.6 * columns, 3.0 * rows + 0.5), layout="constrained")
    grid = figure.subplots(
        rows, columns, squeeze=False, sharey="row" if rows > 1 else False
    ).ravel()
    for (title, curves), axes in zip(panels.items(), grid, strict=False):
        for curve, found in curves:
            colour = colours[found["verdict"]]
            axes.plot(curve, color=colour, linewidth=1.6)
            if found["verdict"] != "monotonic":
                peak, bottom = found["peak"], found["bottom"]
                axes.plot(
                    [peak, bottom], [curve[peak], curve[bottom]], "--o", color=colour, markersize=4
                )
        axes.set_title(title, fontsize=10)
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
        axes.margins(y=0.12)
    for curves, axes in zip(panels.values(), grid, strict=False):  # limits are shared in a row
        _label_falls(axes, [(curve, found, colours[found["verdict"]]) for curve, found in curves])
    for axes in grid[(rows - 1) * columns :]:
        axes.set_xlabel("generation")
    for axes in grid[::columns]:
        axes.set_ylabel("mean fitness")
    lines = [figure.axes[0].plot([], [], color=colour)[0] for colour in colours.values()]
    figure.legend(lines, colours, loc="outside upper center", ncols=3, frameon=False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _label_falls(axes: Axes, falls: list[tuple[np.ndarray, dict, str]]) -> None:
    """Write each curve's fall in percent below the place where it ends; labels never overlap.

    falls: curve, verdict and colour of each.
    """
    left, right = axes.get_xlim()
    low, high = axes.get_ylim()
    words: list[tuple[float, float, str, str]] = []
    for curve, found, colour in falls:
        if found["verdict"] == "monotonic":
            continue
        bottom = found["bottom"]
        x, y = (bottom - left) / (right - left), (curve[bottom] - low) / (high - low)
        words.append((x, y, f"{-100 * found['drop']:.0f} %", colour))
    taken: list[tuple[float, float]] = []
    for x, y, text, colour in sorted(words):
        x = min(x + 0.015, 0.84)
        y -= 0.07
        while any(abs(x - one) < 0.17 and abs(y - other) < 0.065 for one, other in taken):
            y += 0.07
        taken.append((x, y))
        axes.text(x, y, text, color=colour, fontsize=9, transform=axes.transAxes)


def draw_bands(
    file: str | Path,
    x: np.ndarray,
    curves: dict[str, tuple[np.ndarray, np.ndarray]],
    title: str = "",
    labels: tuple[str, str] = ("million steps", "fitness"),
    logarithmic: bool = False,
) -> None:
    """Draw mean curves, each with its band of one standard deviation.

    curves: name -> (mean, deviation), arrays as long as x. logarithmic: whether the x axis is.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 5), layout="constrained")
    axes = figure.subplots()
    colours = ("#0072b2", "#d55e00", "#009e73", "#cc79a7")
    for colour, (name, (mean, deviation)) in zip(colours, curves.items(), strict=False):
        axes.fill_between(x, mean - deviation, mean + deviation, alpha=0.2, color=colour, lw=0)
        axes.plot(x, mean, color=colour, linewidth=2, label=name)
    axes.set(xlabel=labels[0], ylabel=labels[1], title=title)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False)
    if logarithmic:
        axes.set_xscale("log")
        axes.xaxis.set_major_formatter("{x:g}")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


SHOWN = 8
"""Largest number of hidden neurons that draw_features shows."""


def draw_features(file: str | Path, rows: dict[str, tuple], low: float, high: float) -> None:
    """Draw the outputs and hidden neurons of networks over a plane of two inputs in [low, high].

    rows: title -> (inputs (n, 2), targets (n,), output (k, k), features (hiddens, k, k), weights
    (hiddens,)): the training set, the network's output and its hidden neurons over the plane (rows
    are the second input), and the output weights. The neurons with the largest weights come first.
    """
    from matplotlib.figure import Figure

    columns = 1 + min(SHOWN, max(len(row[3]) for row in rows.values()))
    figure = Figure(figsize=(1.9 * columns + 0.6, 2.25 * len(rows) + 0.3), layout="constrained")
    panels = figure.subfigures(len(rows), 1, squeeze=False)[:, 0]
    extent = (low, high, low, high)
    for panel, (title, (inputs, targets, output, features, weights)) in zip(
        panels, rows.items(), strict=True
    ):
        panel.suptitle(title, fontsize=12, x=0.01, ha="left", weight="bold")
        first, *others = panel.subplots(1, columns)
        first.imshow(output, origin="lower", extent=extent, cmap="RdBu_r", vmin=-0.3, vmax=1.3)
        first.contour(output, [0.5], extent=extent, colors="black", linewidths=1)
        first.scatter(
            *inputs.T,
            c=targets,
            cmap="RdBu_r",
            vmin=-0.3,
            vmax=1.3,
            s=20,
            lw=0.7,
            edgecolors="black",
        )
        first.set_title("output, training set", fontsize=9)
        order = np.argsort(-np.abs(weights), kind="stable")
        for axes, k in zip(others, order, strict=False):
            axes.imshow(features[k], origin="lower", extent=extent, cmap="viridis", vmin=0, vmax=1)
            axes.set_title(f"neuron {k + 1}, weight {weights[k]:+.1f}", fontsize=9)
        for axes in panel.axes:
            axes.set(xticks=(), yticks=(), xlim=(low, high), ylim=(low, high))
        for axes in others[len(order) :]:
            axes.axis("off")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")
