"""Exercise 1: what is made, the loop of agent and environment, how episodes end."""

import numpy as np
from style import (
    BLUE,
    GREY,
    ORANGE,
    PALE,
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
    write(result(1, "random_agents.png"), "ex01_result")
    loop()
    episodes()


def loop() -> None:
    from botschool.course.films import first_frame

    figure, axes = new(9, 3.1)
    sketch(axes, 9, 3.1)
    box(axes, 0.2, 1.0, 1.9, 1.1, "agent\n(your rule, later\na network)", "#fde8d8")
    frame = first_frame("CartPole-v1")[110:340, 100:500]
    axes.imshow(frame, extent=(6.1, 8.9, 0.75, 2.36), aspect="auto", zorder=2)
    axes.plot([6.1, 8.9, 8.9, 6.1, 6.1], [0.75, 0.75, 2.36, 2.36, 0.75], color="#555555", lw=1)
    axes.text(7.5, 2.5, "environment", ha="center", fontsize=12)
    arrow(axes, (2.2, 1.85), (6.0, 1.85), ORANGE, 2.2)
    axes.text(4.1, 2.0, "action: 0 pushes left, 1 pushes right", ha="center", color=ORANGE)
    arrow(axes, (6.0, 1.2), (2.2, 1.2), BLUE, 2.2)
    text = "observation: position and speed of the cart,\nangle and angular speed of the pole"
    axes.text(4.1, 0.62, text, ha="center", color=BLUE)
    axes.text(4.1, 0.2, "reward: 1;   terminated?   truncated?", ha="center", color=BLUE)
    save(figure, "ex01_loop")


def episodes() -> None:
    import gymnasium

    env = gymnasium.make("CartPole-v1").unwrapped
    figure, axes = new(9, 3.2)
    rules = {
        "always to the right": lambda seen: 1,
        "a rule that balances": lambda seen: int(seen[2] + 0.5 * seen[3] > 0),
    }
    for (name, rule), colour in zip(rules.items(), (RED, BLUE), strict=True):
        seen, _ = env.reset(seed=4)
        angles, ended = [np.degrees(seen[2])], False
        while not ended and len(angles) < 501:
            seen, _, ended, _, _ = env.step(rule(seen))
            angles.append(np.degrees(seen[2]))
        axes.plot(angles, color=colour, lw=2, label=name)
        end = len(angles) - 1
        if ended:
            axes.plot(end, angles[-1], "x", color=colour, ms=11, mew=3)
            axes.annotate(f"terminated: the pole has fallen (step {end})", (end, angles[-1]),
                          (end + 17, -14.6), color=colour)  # fmt: skip
        else:
            axes.plot(end, angles[-1], "o", color=colour, ms=9)
            axes.annotate("truncated: the time limit\nof 500 steps is reached", (end, angles[-1]),
                          (385, 3.2), color=colour)  # fmt: skip
    for limit in (-12, 12):
        axes.axhline(limit, color=GREY, ls="--", lw=1)
    axes.axhspan(-12, 12, color=PALE, alpha=0.5, lw=0)
    axes.set(xlabel="step", ylabel="angle of the pole (degrees)", ylim=(-16, 16), xlim=(-5, 513))
    axes.legend(frameon=False, loc="upper right", ncols=2)
    plain(axes)
    save(figure, "ex01_episodes")
