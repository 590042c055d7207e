"""Exercise 9: what is made, the robots, and what two behaviours earn by two rewards."""

import numpy as np
from PIL import Image
from style import (
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    beside,
    new,
    plain,
    result,
    save,
    solution,
    write,
)  # fmt: skip


def draw() -> None:
    write(result(9, "gaits.png", 860), "ex09_result")
    robots()
    rewards()


def robots() -> None:
    from botschool.course.films import first_frame

    names = ("Hopper", "Walker2D", "HalfCheetah", "Ant", "Humanoid")
    images = [Image.fromarray(first_frame(f"{name}BulletEnv-v0")) for name in names]
    write(beside(images, 900, (0.2, 0.15, 0.8, 0.95)), "ex09_robots")


def rewards() -> None:
    """A robot that stands, and one that runs: imagined episodes of 1000 steps."""
    student = solution(9)
    steps = 1000
    figure, panels = new(9, 3.4, 1, 2, sharey=True)
    earned = {}
    for name, speed in (("a statue", 0.0), ("a runner", 1.1)):
        trajectory = _episode(steps, speed)
        parts = {
            key: float(value.sum()) for key, value in student.components_v0(trajectory).items()
        }
        earned[name] = parts, float(student.reward_v5(trajectory).sum())
    names = list(next(iter(earned.values()))[0])
    colours = dict(zip(names, (GREEN, BLUE, ORANGE, GREY), strict=False))
    left, right = panels
    for place, (parts, _) in enumerate(earned.values()):
        up = down = 0.0
        for part in names:
            value = parts[part]
            bottom = up if value >= 0 else down
            left.bar(place, value, 0.55, bottom=bottom, color=colours[part],
                     label=part.replace("_", " ") if not place else None)  # fmt: skip
            up, down = up + max(value, 0), down + min(value, 0)
    for place, (_, total) in enumerate(earned.values()):
        right.bar(place, total, 0.55, color=GREEN)
    for axes, title in ((left, "version 0"), (right, "version 5")):
        axes.set_xticks(range(len(earned)), earned)
        axes.set(title=title, xlim=(-0.7, 1.7), ylim=(-250, 2350))
        axes.axhline(0, color="black", lw=0.8)
        plain(axes)
    left.set_ylabel("earned in 1000 steps")
    left.legend(frameon=False, loc="upper left", fontsize=10)
    save(figure, "ex09_rewards")


def _episode(steps: int, speed: float) -> dict:
    """A Hopper that holds its height and goes ahead at a speed in m/s; its joints follow suit."""
    rng = np.random.default_rng(9)
    swing = np.sin(np.arange(steps)[:, None] / 4 + np.arange(3))
    effort = 0.35 if speed else 0.0
    return {
        "robot": "Hopper",
        "duration": 0.0165,
        "distance": 1000.0 - speed * 0.0165 * np.arange(steps + 1),
        "height": np.full(steps, 1.2),
        "pitch": np.zeros(steps),
        "heading": np.zeros(steps),
        "touching": np.zeros(steps),
        "actions": effort * swing + 0.02 * rng.standard_normal((steps, 3)),
        "speeds": effort * np.roll(swing, 3, axis=0),
        "positions": 0.6 * swing if speed else np.zeros((steps, 3)),
    }
