"""What `botschool show` draws of the tasks of exercise 15."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PICTURES["15.1"] = Picture(
    "Predator and prey, from the rings to the discs: the chase ends where they touch.",
    "x (mm)", "y (mm)", kind="path", of=lambda answer, *_: answer["poses"][..., :2],
    call=lambda grader: ("chase", *grader.some_pair(np.random.default_rng(1), True, 400), 400),
)  # fmt: skip
PICTURES["15.2"] = Picture(
    "How each predator (row) of three generations fares against each prey (column).",
    "prey", "predator", kind="heat", of=lambda answer, *_: np.reshape(answer, (6, 6)),
    call=lambda grader: (
        "tournament", *grader.groups(np.random.default_rng(1), (3, 3), (2, 2), 200)
    ),
)  # fmt: skip
PICTURES["15.3"] = Picture(
    "A row and a column for each generation: light where the row's side does well.",
    "generation of the other side", "generation", kind="heat",
    call=lambda grader: ("master", grader.random_table(np.random.default_rng(1), 6, 3, 6, 3)),
)  # fmt: skip


def race(grader):
    return grader.steady(np.random.default_rng(1), 9)


PICTURES["15.4"] = Picture(
    "In an arms race, a generation fares best against the ancient, and worst against the future.",
    "generation", "fitness", kind="curves", call=lambda grader: ("profile", race(grader)),
)  # fmt: skip
PICTURES["15.5"] = Picture(
    "In an arms race each generation gains on the one before, against old competitors and all.",
    "generation", "gain", kind="curves", call=lambda grader: ("progress", race(grader)),
    of=lambda answer, *_: {name: answer[name] for name in ("historical", "global")},
)  # fmt: skip
PICTURES["15.6"] = Picture(
    "What is seen hardly changes; what this side gains and the other takes away grows and grows.",
    "generation", "change of fitness", kind="curves",
    call=lambda grader: ("red_queen", race(grader)),
)  # fmt: skip
PICTURES["15.8"] = Picture(
    "Two robots that drive about, described by numbers: predator on the left, prey on the right.",
    "robot", "", kind="bars",
    call=lambda grader: ("describe", grader.wandering(np.random.default_rng(1), 150)),
)  # fmt: skip
