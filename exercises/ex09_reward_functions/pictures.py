"""What `botschool show` draws of the tasks of exercise 9."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PICTURES["9.1"] = Picture(
    "What a hopper that moves at random is paid for its way, until it falls.",
    "step", "progress", kind="curves",
    call=lambda grader: (
        "progress", *(grader.real("Hopper", 1)[key] for key in ("distance", "duration"))
    ),
)  # fmt: skip
PICTURES["9.2"] = Picture(
    "What electricity costs an ant that moves at random: something in each step.",
    "step", "electricity", kind="curves",
    call=lambda grader: (
        "electricity", "Ant", *(grader.real("Ant", 1)[key] for key in ("actions", "speeds"))
    ),
)  # fmt: skip
PICTURES["9.3"] = Picture(
    "What version 0 pays: the bonus for being alive stays the same, until the hopper falls.",
    "step", "reward", kind="curves",
    call=lambda grader: ("components_v0", grader.real("Hopper", 1)),
)  # fmt: skip
PICTURES["9.4"] = Picture(
    "Version 5 pays a walker for progress alone: standing still earns 0.",
    "step", "reward", kind="curves", call=lambda grader: ("reward_v5", grader.real("Walker2D", 1)),
)  # fmt: skip
PICTURES["9.5"] = Picture(
    "The three parts of what a planar hopper is paid; it falls now and then, and is alive again.",
    "step", "reward", kind="curves", call=lambda grader: (
        "planar_v0", grader.planar(np.random.default_rng(1), "PlanarHopper", 40)
    ),
)  # fmt: skip
