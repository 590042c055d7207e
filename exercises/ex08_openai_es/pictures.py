"""What `botschool show` draws of the tasks of exercise 8."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PICTURES["8.1"] = Picture(
    "Candidates around the centre, at (1, 2): each has its twin on the other side.",
    "first parameter", "second parameter", kind="points",
    call=("candidates_around", np.array([1.0, 2.0]),
          np.random.default_rng(1).normal(size=(12, 2)), 0.3),
)  # fmt: skip
RETURNS = np.sort(np.random.default_rng(1).normal(size=20) ** 3)
PICTURES["8.2"] = Picture(
    "Equal steps from -0.5 to 0.5, however far apart the returns are: an outlier counts no more.",
    "return", "utility", kind="curves", call=("utilities", RETURNS),
    of=lambda answer, *_: {"utility": answer, "over": RETURNS},
)  # fmt: skip
SAMPLES = np.random.default_rng(1).normal(size=(40, 2))
UP = np.argsort(np.argsort(np.stack([SAMPLES, -SAMPLES], axis=1).reshape(-1, 2) @ [2.0, 1.0]))
PICTURES["8.3"] = Picture(
    "The arrow points to where the utilities rise: to the right, and a little upwards.",
    "first parameter", "second parameter", kind="arrows",
    call=("gradient", SAMPLES, UP / 79 - 0.5), extent=(-0.5, 0.5, -0.5, 0.5),
    of=lambda answer, *_: np.concatenate([[0.0, 0.0], answer])[None],
)  # fmt: skip
PICTURES["8.4"] = Picture(
    "Where no gradient is, weight decay is a slope to 0, the steeper the larger the parameter.",
    "parameter", "descent", kind="curves", of=lambda answer, *_: {"descent": answer,
                                                                  "over": np.linspace(-3, 3, 41)},
    call=("descent", np.zeros(41), np.linspace(-3, 3, 41), 1),
)  # fmt: skip


def descended(module, centre, slopes, stepsize):
    """adam, step after step, down a valley that is steep across and flat along it,"""
    way, m, v = [centre], 0 * centre, 0 * centre
    for t in range(1, 61):
        centre, m, v = module.adam(centre, slopes * centre, m, v, t, stepsize)
        way.append(centre)
    return way


PICTURES["8.5"] = Picture(
    "Sixty steps of Adam from the ring: first equally long in both directions, then to the middle.",
    "first parameter", "second parameter", kind="path",
    call=(descended, np.array([1.0, 0.6]), np.array([0.1, 10.0]), 0.05),
)  # fmt: skip
PICTURES["8.6"] = Picture(
    "The mean fitness rises from generation to generation, while the goal moves to and fro.",
    "generation", "mean fitness", kind="curves",
    call=lambda grader: (
        grader.evolved, np.full(6, 3.0), np.zeros(6), 60, 1,
        {"samplesize": 20, "noiseStdDev": 0.1, "stepsize": 0.1}, 15,
    ),
    of=lambda answer, *_: {"history": answer["history"]},
)  # fmt: skip
PICTURES["8.7"] = Picture(
    "The mean of five neighbours runs through the middle of a noisy curve.",
    "generation", "fitness", kind="curves",
    call=("smooth", np.sin(np.arange(60) / 9) + 0.4 * np.random.default_rng(1).normal(size=60), 5),
)  # fmt: skip
