"""What `botschool show` draws of the tasks of exercise 10."""

import numpy as np

from botschool.course.robots import random_robot
from botschool.grading import Picture

PICTURES = {}
PICTURES["10.1"] = Picture(
    "What each link of a robot weighs.",
    "", "mass (kg)",
    call=lambda grader: ("describe", random_robot(np.random.default_rng(1), 6, True)),
    of=lambda answer, *_: dict(sorted(answer["links"].items())),
)  # fmt: skip
PICTURES["10.5"] = Picture(
    "Each action adds to the wheels' speed, which stays below 24.6, and turns back at once.",
    "step", "speed (rad/s)", kind="curves", of=lambda answer, *_: {"speed": answer["self.speed"]},
    call=lambda grader: (
        grader.on_stage, "drive(), actions", 0.1, [0.0, 0.0], 0.0, [1.0] * 30 + [-1.0] * 40
    ),
)  # fmt: skip
PICTURES["10.6"] = Picture(
    "A robot whose wheels stand still falls; its reward falls with its inclination.",
    "step", "", kind="curves",
    call=lambda grader: (grader.on_stage, "step(), actions", 0.05, [0.0, 0.0], 0.0, [0.0] * 80),
    of=lambda answer, *_: {"inclination, angular velocity, wheels": answer["the observation"],
                           "reward": answer["the reward"]},
)  # fmt: skip
