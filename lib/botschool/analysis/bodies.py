"""Draw BodyBrain robots, and the returns of brains in each other's bodies."""

from __future__ import annotations

from pathlib import Path

import numpy as np

TORSO, NEAR, FAR = "#d5783c", np.array([127, 76, 180]) / 255, np.array([90, 170, 200]) / 255
"""The colours of botschool.envs.bodybrain_view."""


def draw_walkers(file: str | Path, walkers: list[dict]) -> None:
    """Draw bodies at rest, with the range of each joint as a grey fan.

    walkers: for each body a dict with "title"; "outline", corners in metres, shape (11, 4, 2), the
    torso first; "lower" and "upper", radians around the default angle, shape (10,).
    """
    from matplotlib.figure import Figure

    sides = np.array([np.ptp(walker["outline"], axis=(0, 1)) for walker in walkers])
    width, height = sides.max(axis=0) + 1
    scale = 3.8 / max(width, height)  # inches per metre
    figure = Figure(
        figsize=(scale * width * len(walkers) + 0.5, scale * height + 1), layout="constrained"
    )
    panels = figure.subplots(1, len(walkers), squeeze=False)[0]
    for axes, walker in zip(panels, walkers, strict=True):
        corners = np.asarray(walker["outline"])
        low, high = corners.min(axis=(0, 1)), corners.max(axis=(0, 1))
        _draw_fans(axes, corners, walker["lower"], walker["upper"])
        _draw_segments(axes, corners)
        axes.axhspan(low[1] - height, low[1], color="#8bba67", zorder=0)
        middle = (low[0] + high[0]) / 2
        axes.set(
            xlim=(middle - width / 2, middle + width / 2),
            ylim=(low[1] - 0.5, low[1] - 0.5 + height),
            aspect="equal",
            title=walker["title"],
            xlabel="metres",
        )
        axes.spines[["top", "right", "left"]].set_visible(False)
        axes.set_yticks([])
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _draw_segments(axes, corners: np.ndarray) -> None:
    from matplotlib.patches import Polygon

    last = len(corners) - 1
    for i, box in enumerate(corners):
        share = max(i - 1, 0) / (last - 1)
        colour = TORSO if i == 0 else (1 - share) * NEAR + share * FAR
        axes.add_patch(Polygon(box, facecolor=colour, edgecolor="#2c2040", linewidth=0.8, zorder=3))
    hinges = corners[:-1, 1:3].mean(axis=1)
    axes.plot(*hinges.T, "o", color="#2c2040", markersize=3, zorder=4)


def _draw_fans(axes, corners: np.ndarray, lower: np.ndarray, upper: np.ndarray) -> None:
    from matplotlib.patches import Wedge

    beginnings, ends = corners[:, [0, 3]].mean(axis=1), corners[:, 1:3].mean(axis=1)
    headings = np.degrees(np.arctan2(*(ends - beginnings).T[::-1]))
    for i, (low, high) in enumerate(zip(np.degrees(lower), np.degrees(upper), strict=True)):
        heading = headings[i + 1]
        fan = Wedge(beginnings[i + 1], 0.45, heading + low, heading + high)
        fan.set(facecolor="#999999", alpha=0.45, zorder=2)
        axes.add_patch(fan)


def draw_matrix(file: str | Path, matrix: np.ndarray) -> None:
    """Draw the return of each brain (row) in each body (column) as a coloured table."""
    from matplotlib.figure import Figure
    from matplotlib.patches import Rectangle

    n = len(matrix)
    figure = Figure(figsize=(1.6 * n + 1.8, 1.4 * n + 1.2), layout="constrained")
    axes = figure.subplots()
    image = axes.imshow(matrix, cmap="viridis")
    middle = (np.min(matrix) + np.max(matrix)) / 2
    for i in range(n):
        for j in range(n):
            colour = "black" if matrix[i, j] > middle else "white"
            axes.text(j, i, f"{matrix[i, j]:.1f}", ha="center", va="center", color=colour)
        own = Rectangle((i - 0.47, i - 0.47), 0.94, 0.94, fill=False, edgecolor=TORSO, linewidth=3)
        axes.add_patch(own)
    names = [str(i + 1) for i in range(n)]
    axes.set_xticks(range(n), names)
    axes.set_yticks(range(n), names)
    axes.set(xlabel="body of walker", ylabel="brain of walker", title="Brains in bodies")
    axes.spines[:].set_visible(False)
    figure.colorbar(image, label="mean return", shrink=0.85)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")
