"""What `botschool show` draws of the tasks of exercise 6."""

import numpy as np

from botschool.course import genotype_file
from botschool.grading import Picture

PICTURES = {}


def first_robot(grader):
    return grader.weights(np.load(genotype_file("discrimS1.npy")))


GLANCE = np.exp(-((np.arange(60)[:, None] - 20 - 3 * np.arange(8)) ** 2) / 40)
PICTURES["6.1"] = Picture(
    "A thing passes by: the memory cells keep what was seen, and the wheels answer later, too.",
    "step", "", kind="curves",
    call=lambda grader: (grader.thought, first_robot(grader), GLANCE, np.zeros((2, 10))),
    of=lambda answer, *_: {"memory cells": np.array(answer["memories"])[:, 0],
                           "wheels": answer["actions"]},
)  # fmt: skip
PICTURES["6.2"] = Picture(
    "The way of an evolved robot, from the ring to the disc: it finds the cylinder at (200, 150).",
    "x (mm)", "y (mm)", kind="path", of=lambda answer, *_: answer["poses"][:, :2],
    call=lambda grader: (grader.recorded, first_robot(grader), np.array([100.0, 300.0, 3.0]),
                         np.array([200.0, 150.0]), 1, "keep", 200),
)  # fmt: skip
PICTURES["6.3"] = Picture(
    "Four places, four directions in each: no start is favoured.",
    "x (mm)", "y (mm)", kind="arrows", call=("grid", 2, 4), extent=(0, 400, 0, 400),
    of=lambda answer, *_: np.column_stack([answer[:, :2], 40 * np.cos(answer[:, 2]),
                                           40 * np.sin(answer[:, 2])]),
)  # fmt: skip
CLOUDS = np.repeat([[0.0, 0.0], [3.0, 3.0], [4.0, 0.5]], 5, axis=0)
PICTURES["6.5"] = Picture(
    "Robots that behave alike are near each other and have the same number: three families.",
    "first descriptor", "second descriptor", kind="groups",
    call=("families", CLOUDS + 0.5 * np.random.default_rng(1).normal(size=CLOUDS.shape), 2.0),
    of=lambda answer, table, threshold: np.column_stack([table, answer]),
)  # fmt: skip
PICTURES["6.6"] = Picture(
    "What one robot earns with its memory, without it, and with one that stops after 40 steps.",
    "", "mean return",
    call=lambda grader: (
        "memory_test", first_robot(grader), np.array([[100.0, 300, 3], [300, 300, 4]]),
        np.array([200.0, 150.0]), 1, 40, 200,
    ),
)  # fmt: skip
MINDS = np.linspace(-1, 1, 60)[:, None, None] * np.array([[2.0], [1.0]]) * np.ones(10)
PICTURES["6.7"] = Picture(
    "The wheels' answers to one and the same sight, while what is remembered changes.",
    "from one memory to its opposite", "wheels", kind="curves",
    call=lambda grader: ("reactions", first_robot(grader), np.zeros(8), MINDS),
)  # fmt: skip
