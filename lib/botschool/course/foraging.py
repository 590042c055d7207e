"""Give exercise 6 evolved robots, and pictures of their paths and memories."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from botschool.arenas import arena as arenas
from botschool.course.files import genotype_file
from botschool.paths import course_root
from botschool.render.shapes import PALETTE


def replications(folder: str) -> dict[str, np.ndarray]:
    """Return name -> genotype of the best robot of each run in the folder, ordered by seed.

    folder: inside the course; without runs in it, the function loads the course's three robots.
    Raises BotschoolError.
    """
    files = list((course_root() / folder).glob("bestgS*.npy"))
    if not files:
        files = [genotype_file(f"discrimS{seed}.npy") for seed in (1, 2, 3)]
    seeds = {int(file.stem.rpartition("S")[2]): file for file in files}
    return {f"seed {seed}": np.load(seeds[seed]) for seed in sorted(seeds)}


def draw_trajectories(
    file: str | Path, panels: dict[str, list[dict]], cylinder: tuple[float, float], columns: int
) -> None:
    """Draw a robot's paths in the arena from above, redder where its infrared reads more.

    panels: title -> recorded episodes, dicts with "poses" (T + 1, 3), "observations" (T, 8) and
    "rewards" (T,). A ring marks a start, a disc an end, a cross a collision.
    """
    from matplotlib.figure import Figure

    rows = -(-len(panels) // columns)
    figure = Figure(figsize=(3.6 * columns + 0.8, 3.8 * rows), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False)
    lines = None
    for axes, (title, episodes) in zip(grid.ravel(), panels.items(), strict=False):
        _draw_arena(axes, cylinder)
        for each in episodes:
            lines = _draw_way(axes, each)
        reward = np.mean([each["rewards"].sum() for each in episodes])
        axes.set_title(f"{title}: {reward:.0f} steps near", fontsize=11)
    for axes in grid.ravel():
        axes.axis("off")
    bar = figure.colorbar(lines, ax=grid, shrink=0.5, aspect=30)
    bar.set_label("strongest infrared reading")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _colour(name: str) -> tuple[float, ...]:
    return tuple(part / 255 for part in PALETTE[name][0])


def _draw_arena(axes, cylinder: tuple[float, float]) -> None:
    from matplotlib.patches import Circle, Rectangle

    arena = arenas.make("discrim")
    radius = arena.objects[0, 4]
    near = arena.models[0].radius + radius + 60
    floor = Rectangle(
        (0, 0),
        arena.width,
        arena.height,
        facecolor=_colour("floor"),
        edgecolor=_colour("wall"),
        lw=3,
    )
    axes.add_patch(floor)
    zone = Circle(cylinder, near, color=_colour("goal"), alpha=0.15, lw=0)
    zone.set_clip_path(floor)
    axes.add_patch(zone)
    axes.add_patch(Circle(cylinder, radius, color=_colour("object")))
    axes.set(xlim=(-8, arena.width + 8), ylim=(-8, arena.height + 8), aspect="equal")


def _draw_way(axes, episode: dict):
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap

    colours = LinearSegmentedColormap.from_list("infrared", [_colour("blue"), (0.9, 0.1, 0.1)])
    poses = episode["poses"]
    pieces = np.stack([poses[:-1, :2], poses[1:, :2]], axis=1)
    lines = LineCollection(list(pieces), cmap=colours, linewidths=1.2, alpha=0.8)
    lines.set_array(episode["observations"].max(axis=1))
    lines.set_clim(0, 1)
    axes.add_collection(lines)
    x, y, heading = poses[0]
    axes.plot(x, y, "o", markersize=6, markerfacecolor="white", markeredgecolor="black")
    axes.plot([x, x + 16 * np.cos(heading)], [y, y + 16 * np.sin(heading)], color="black", lw=1.2)
    bumped = episode["rewards"][-1] == 0 and np.array_equal(poses[-1], poses[-2])
    mark = {"marker": "X", "color": "#c1272d"} if bumped else {"marker": "o", "color": "black"}
    axes.plot(*poses[-1, :2], **mark, markersize=8 if bumped else 5, zorder=5)
    return lines


def draw_mind(file: str | Path, title: str, episode: dict, reactions: np.ndarray) -> None:
    """Draw one episode over time: infrared, memory cells, wheels, and reactions to seeing nothing.

    episode: as in draw_trajectories, with "memories" (T, 2, units) and "actions" (T, 2).
    reactions: (T, 2), the actions if the robot saw nothing, with the memory of each step.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 8), layout="constrained")
    panels = figure.subplots(4, 1, sharex=True, height_ratios=(2, 2, 1.6, 1.6))
    steps = len(episode["rewards"])
    cells = episode["memories"][:, 0]
    span = max(float(np.abs(cells).max()), 1e-9)
    bands = (
        ("infrared sensor", episode["observations"], "Reds", 0.0, 1.0),
        ("memory cell", cells, "RdBu_r", -span, span),
    )
    for axes, (label, values, colours, low, high) in zip(panels, bands, strict=False):
        extent = (0, steps, values.shape[1] + 0.5, 0.5)
        image = axes.imshow(
            values.T, aspect="auto", cmap=colours, vmin=low, vmax=high, extent=extent,
            interpolation="nearest",
        )  # fmt: skip
        axes.set_ylabel(label)
        figure.colorbar(image, ax=axes, pad=0.01)
    for axes, (label, values) in zip(
        panels[2:],
        (("wheels", episode["actions"]), ("wheels, seeing nothing", reactions)),
        strict=True,
    ):
        for name, wheel, colour in zip(
            ("left", "right"), values.T, ("#0072b2", "#d55e00"), strict=True
        ):
            axes.plot(np.arange(steps) + 0.5, wheel, color=colour, lw=1.2, label=name)
        axes.axhline(0, color="black", lw=0.6)
        axes.set(ylabel=label, ylim=(-1.1, 1.1))  # the same for both, to compare
        axes.spines[["top", "right"]].set_visible(False)
        for step in np.flatnonzero(np.diff(np.r_[0, episode["rewards"], 0]) > 0):
            axes.axvline(step, color=_colour("goal"), lw=1.5, ls="--")
    panels[2].legend(frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 0.9))
    panels[-1].set_xlabel("step (dashed green: the robot comes near the cylinder)")
    figure.suptitle(f"{title}: one episode")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")
