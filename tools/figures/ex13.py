"""Exercise 13: what is made, clipping, and how far TD errors reach back."""

import numpy as np
from style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    RED,
    new,
    plain,
    result,
    save,
    solution,
    write,
)  # fmt: skip


def draw() -> None:
    write(result(13, "own_training.png", 640), "ex13_own_training")
    write(result(13, "hidden_layer.png", 1000), "ex13_result")
    clipping()
    horizon()


def clipping() -> None:
    ratio = np.linspace(0.4, 1.6, 500)
    figure, panels = new(8.8, 3.2, 1, 2)
    for axes, advantage, title in zip(panels, (1.0, -1.0), ("a good action, A = 1",
                                      "a bad action, A = -1"), strict=True):  # fmt: skip
        plainly = ratio * advantage
        clipped = np.clip(ratio, 0.8, 1.2) * advantage
        axes.axvspan(0.8, 1.2, color=GREY, alpha=0.15, lw=0)
        axes.plot(ratio, plainly, "--", color=GREY, lw=1.5, label="ratio · A")
        axes.plot(ratio, np.minimum(plainly, clipped), color=BLUE, lw=3, label="what PPO maximises")
        axes.plot(1, advantage, "o", ms=9, color="black")
        axes.set(title=title, xlabel="ratio of now to then")
        plain(axes)
    panels[0].legend(frameon=False, loc="upper left")
    panels[0].text(1.25, 1.0, "no more\nto gain", color=RED)
    panels[1].text(0.42, -0.98, "no more\nto gain", color=RED)
    panels[1].text(1.22, -1.12, "can be\nput right", color=GREEN)
    panels[0].text(0.47, 0.75, "can be\nput right", color=GREEN)
    save(figure, "ex13_clipping")


def horizon() -> None:
    """One TD error at step 30: how much of it each earlier action is credited with."""
    student = solution(13)
    steps = 40
    rewards, values = np.zeros((steps, 1)), np.zeros((steps, 1))
    rewards[30] = 1
    starts = np.zeros((steps, 1))
    starts[12] = 1
    figure, axes = new(8.8, 2.8)
    for smoothing, colour in ((0.0, GREY), (0.8, GREEN), (0.95, BLUE), (1.0, ORANGE)):
        found = student.advantages(
            rewards, values, starts, np.zeros(1), np.zeros(1), 0.99, smoothing
        )
        axes.plot(found[:, 0], "-o", ms=3.5, lw=1.6, color=colour, label=f"λ = {smoothing}")
    axes.axvline(11.5, color=RED, ls=":", lw=1.5)
    axes.text(11, 0.9, "another episode:\nnot to be credited", color=RED, ha="right", va="top")
    axes.text(30.6, 0.97, "an unexpected reward")
    axes.set(xlabel="step", ylabel="advantage", xlim=(0, 40))
    axes.legend(frameon=False, loc="center left", bbox_to_anchor=(0.0, 0.35))
    plain(axes)
    save(figure, "ex13_horizon")
