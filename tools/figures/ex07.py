"""Exercise 7: what is made, reading a portrait, the short way around."""

import numpy as np
from matplotlib.patches import Circle
from style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    above,
    arrow,
    frames,
    made,
    new,
    plain,
    result,
    save,
    write,
)  # fmt: skip

TICKS = [-np.pi, -np.pi / 2, 0, np.pi / 2, np.pi], ["-π", "-π/2", "0", "π/2", "π"]


def draw() -> None:
    film = frames(made(7, "pendulum.mp4"), np.linspace(0, 0.35, 7), 860, (0, 0, 1, 0.94))
    write(above(result(7, "portraits.png", 860), film), "ex07_result", 64)
    reading()
    around()


def reading() -> None:
    """Gravity alone, as a continuous flow."""
    figure, axes = new(8.6, 4.1)
    angle, speed = np.meshgrid(np.linspace(-np.pi, np.pi, 60), np.linspace(-8, 8, 60))
    pull = 15 * np.sin(angle)
    axes.streamplot(angle, speed, speed, pull, color="#b5b5b5", density=1.2, linewidth=0.8,
                    arrowsize=0.8)  # fmt: skip
    for x in (-np.pi, np.pi):
        axes.plot(x, 0, "o", ms=11, color=BLUE, clip_on=False, zorder=4)
    axes.plot(0, 0, "o", ms=11, mfc="white", mec=RED, mew=2.5, zorder=4)
    labels = (
        ("hanging down:\nan equilibrium", (-np.pi, 0), (-2.5, 2.4), BLUE),
        ("upright: an equilibrium too,\nthe least push is the end of it", (0, 0), (0.55, 2.7), RED),
        ("the left and the right edge\nare the same place", (np.pi, 0), (1.05, -2.9), BLUE),
    )
    for text, place, where, colour in labels:
        axes.annotate(text, place, where, color=colour, fontsize=10,
                      bbox={"fc": "white", "ec": "none", "alpha": 0.85, "pad": 1},
                      arrowprops={"arrowstyle": "-", "color": colour})  # fmt: skip
    axes.text(-0.6, 7.0, "positive velocity: everything drifts to the right", fontsize=10,
              color=GREEN, ha="center", bbox={"fc": "white", "ec": "none", "pad": 1})  # fmt: skip
    axes.set(xlim=(-np.pi, np.pi), ylim=(-8, 8), xlabel="angle", ylabel="velocity")
    axes.set_xticks(*TICKS)
    save(figure, "ex07_reading", 128)


def around() -> None:
    """A step across the cut, taken the long and the short way."""
    figure, (left, right) = new(8.6, 2.9, 1, 2, width_ratios=(1, 2.2))
    left.add_patch(Circle((0, 0), 1, fill=False, ec=GREY, lw=1.5))
    for angle, colour in ((2.9, BLUE), (-2.9, ORANGE)):
        x, y = -np.sin(angle), np.cos(angle)
        left.plot([0, x], [0, y], color=colour, lw=4, solid_capstyle="round")
        left.text(1.25 * x, 1.25 * y, f"{angle}", ha="center", va="center", color=colour)
    left.plot(0, -1, "|", ms=14, color="black")
    left.text(0, 1.1, "0", ha="center")
    left.text(0, -1.5, "π and -π", ha="center")
    left.set(xlim=(-1.7, 1.7), ylim=(-1.75, 1.45), aspect="equal")
    left.axis("off")
    right.plot([2.9], [2.5], "o", ms=9, color=BLUE)
    right.plot([-2.9], [3.2], "o", ms=9, color=ORANGE)
    arrow(right, (2.85, 2.52), (-2.84, 3.18), RED, 2)
    right.text(0, 2.15, "the long way: a step of -5.8", color=RED, ha="center")
    arrow(right, (2.9, 2.5), (3.14, 2.85), GREEN, 2.5)
    arrow(right, (-3.14, 2.85), (-2.94, 3.15), GREEN, 2.5)
    right.text(2.95, 4.05, "the short way: 0.5,\nout on the right, in on the left",
               color=GREEN, ha="right")  # fmt: skip
    right.set(xlim=(-np.pi, np.pi), ylim=(1.5, 5.2), xlabel="angle", yticks=[])
    right.set_ylabel("velocity")
    right.set_xticks(*TICKS)
    plain(right)
    save(figure, "ex07_short_way")
