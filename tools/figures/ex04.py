"""Exercise 4: what is made, the robot, the winner's curse."""

import numpy as np
from matplotlib.patches import Arc
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


def draw() -> None:
    film = frames(made(4, "acrobot.mp4"), (0, 0.06, 0.12, 0.18, 0.24, 0.3), 620, (0, 0, 1, 0.9))
    write(above(result(4, "curves.png", 620), film), "ex04_result")
    robot()
    dice()


def robot() -> None:
    figure, (hanging, bent) = new(8, 3.6, 1, 2)
    for axes, (first, second), title in (
        (hanging, (0.0, 0.0), "at the start: it hangs, nearly at rest"),
        (bent, (0.9, 0.8), "on the way"),
    ):
        hips = np.array([np.sin(first), -np.cos(first)])
        end = hips + np.array([np.sin(first + second), -np.cos(first + second)])
        axes.axhline(1, color=GREEN, lw=2)
        for start, stop, colour in (((0, 0), hips, BLUE), (hips, end, ORANGE)):
            axes.plot(*zip(start, stop, strict=True), color=colour, lw=11, solid_capstyle="round")
        axes.plot(0, 0, "o", ms=9, color="black")
        axes.plot(*hips, "o", ms=9, color="white", mec="black", mew=1.5)
        axes.plot(*end, "o", ms=6, color=RED)
        axes.set(xlim=(-2.2, 2.2), ylim=(-2.3, 1.75), aspect="equal")
        axes.text(0, 1.45, title, ha="center", fontsize=12)
        axes.axis("off")
    hanging.text(-2.1, 1.08, "the line to reach", color=GREEN)
    hanging.text(0.2, -0.08, "nail: turns freely")
    hanging.text(0.25, -1.08, "hips: a motor, -1, 0 or +1")
    hanging.text(0.25, -2.05, "free end", color=RED)
    bent.plot([0, 0], [0, -0.95], ":", color=GREY)
    hips = np.array([np.sin(0.9), -np.cos(0.9)])
    bent.plot(*zip(hips, 1.7 * hips, strict=True), ":", color=GREY)
    bent.add_patch(
        Arc((0, 0), 1.3, 1.3, theta1=270, theta2=270 + np.degrees(0.9), color=BLUE, lw=2)
    )
    heading = 270 + np.degrees(0.9)
    bent.add_patch(
        Arc(hips, 1.0, 1.0, theta1=heading, theta2=heading + np.degrees(0.8), color=ORANGE, lw=2)
    )
    bent.text(0.13, -0.98, r"$\theta_1$", color=BLUE, fontsize=14)
    bent.text(1.3, -1.12, r"$\theta_2$", color=ORANGE, fontsize=14)
    save(figure, "ex04_robot")


def dice() -> None:
    """The best of many throws, and the same dice thrown again."""
    rng = np.random.default_rng(1)
    throws = rng.integers(1, 7, (300, 1000, 10)).sum(axis=2)
    best = throws.max(axis=1)
    figure, axes = new(8, 2.9)
    bins = np.arange(9.5, 61.5)
    axes.hist(throws[0], bins, density=True, color=GREY, alpha=0.6, label="1000 throws of ten dice")
    axes.hist(
        best, bins, density=True, color=ORANGE, alpha=0.8, label="the highest of 1000, 300 times"
    )
    axes.axvline(35, color=BLUE, lw=2.5)
    axes.text(34.4, 0.16, "what the same dice\ngive next time: 35", color=BLUE, ha="right")
    axes.text(54.5, 0.2, f"what was promised:\n{best.mean():.0f} on average", color=ORANGE)
    arrow(axes, (51, 0.33), (36, 0.33), RED)
    axes.set(xlabel="sum", ylabel="share", xlim=(12, 62), ylim=(0, 0.4))
    axes.legend(frameon=False, loc="upper left")
    plain(axes)
    save(figure, "ex04_winners_curse")
