"""Exercise 6: what is made, the robot's sensors, one cell of its memory."""

import numpy as np
from matplotlib.patches import Circle, Wedge
from style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    arrow,
    box,
    new,
    plain,
    result,
    save,
    sketch,
    write,
)  # fmt: skip


def draw() -> None:
    write(result(6, "trajectories.png", 860, (0, 0, 0.885, 0.335)), "ex06_result")
    senses()
    memory()


def senses() -> None:
    from botschool import arena

    world = arena.make("discrim", noise=0)
    model = world.models[0]
    figure, (left, right) = new(9, 3.7, 1, 2, width_ratios=(1, 1.25))
    left.add_patch(Circle((0, 0), model.radius, fc="#dddddd", ec="#333333", lw=1.5, zorder=2))
    for degrees in model.directions:
        reach = model.radius + model.range
        left.add_patch(Wedge((0, 0), reach, degrees - 9, degrees + 9, fc=ORANGE, alpha=0.25))
        place = model.radius * np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
        left.plot(*place, "o", ms=6, color=RED, zorder=4)
    for side in (-1, 1):
        left.plot([-9, 9], [side * 22] * 2, color="black", lw=6, solid_capstyle="butt", zorder=3)
    arrow(left, (0, 0), (24, 0), BLUE, 2)
    left.annotate("", (-model.radius, -84), (model.radius, -84), arrowprops={"arrowstyle": "<->"})
    left.text(0, -97, f"{2 * model.radius:.0f} mm", ha="center")
    left.set(xlim=(-85, 85), ylim=(-104, 84), aspect="equal")
    left.set_title("eight sensors, two wheels")
    left.axis("off")
    distances = np.arange(2, 46, 1.0)
    for name, colour in (("wall", BLUE), ("cylinder", ORANGE)):
        readings = []
        for gap in distances:
            if name == "wall":
                world.objects[0, :2] = 60, 60
                world.robots = [[world.width - model.radius - gap, 200, 0]]
            else:
                world.objects[0, :2] = 200 + model.radius + gap + world.objects[0, 4], 200
                world.robots = [[200, 200, 0]]
            readings.append(world.sense().copy())
        readings = np.array(readings)
        right.plot(distances, readings.max(axis=1), color=colour, lw=2.2, label=f"{name} in front")
        right.plot(distances, np.sort(readings, axis=1)[:, -3], "--", color=colour, lw=1.5)
    right.set(xlabel="distance from the robot's edge (mm)", ylabel="reading", ylim=(0, 1.05))
    right.set_title("strongest sensor, and third strongest (dashed)")
    right.legend(frameon=False)
    plain(right)
    save(figure, "ex06_sensors")


def memory() -> None:
    """A cell with its three gates, as the text describes them."""
    figure, axes = new(9, 3.3)
    sketch(axes, 9, 3.3)
    arrow(axes, (0.4, 2.3), (8.5, 2.3), BLUE, 3)
    axes.text(0.35, 2.5, "cell, from the\nstep before", color=BLUE, fontsize=10)
    axes.text(7.75, 2.5, "cell, for the\nnext step", color=BLUE, fontsize=10)
    for x, sign in ((2.5, "×"), (4.6, "+")):
        axes.add_patch(Circle((x, 2.3), 0.2, fc="white", ec="#333333", zorder=3))
        axes.text(x, 2.29, sign, ha="center", va="center", fontsize=14, zorder=4)
    box(axes, 1.75, 1.0, 1.5, 0.6, "forget gate", "#fde8d8")
    arrow(axes, (2.5, 1.62), (2.5, 2.08), ORANGE, 2)
    axes.text(2.5, 0.72, "how much is kept", ha="center", fontsize=10, color=ORANGE)
    box(axes, 3.55, 1.0, 1.0, 0.6, "input gate", "#fde8d8", 10)
    box(axes, 4.7, 1.0, 1.1, 0.6, "candidate", "#e3f1e9", 10)
    axes.text(4.65, 1.28, "×", ha="center", va="center", fontsize=12)
    arrow(axes, (4.6, 1.62), (4.6, 2.08), GREEN, 2)
    axes.text(4.65, 0.72, "how much is let in", ha="center", fontsize=10, color=GREEN)
    arrow(axes, (6.9, 2.25), (6.9, 1.65), BLUE, 2)
    box(axes, 6.15, 1.0, 1.5, 0.6, "output gate", "#fde8d8")
    axes.text(6.9, 0.72, "how much is shown", ha="center", fontsize=10, color=ORANGE)
    arrow(axes, (7.7, 1.3), (8.5, 1.3), "#333333", 2)
    axes.text(8.1, 1.42, "output", ha="center", fontsize=10)
    axes.text(4.3, 0.2, "gates and candidate look at the observation, and at the outputs of the "
              "step before", ha="center", color=GREY)  # fmt: skip
    save(figure, "ex06_cell")
