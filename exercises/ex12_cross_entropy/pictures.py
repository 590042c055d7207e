"""What `botschool show` draws of the tasks of exercise 12."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
RISING = np.linspace(-5, 5, 51)
PICTURES["12.1"] = Picture(
    "As the first score rises, its probability grows from 0 to 1, and the others shrink.",
    "first score, the others are 0 and 1", "probability", kind="curves",
    call=("softmax", np.stack([RISING, 0 * RISING, 0 * RISING + 1], axis=1)),
    of=lambda answer, *_: {"probabilities": answer, "over": RISING},
)  # fmt: skip
PICTURES["12.2"] = Picture(
    "How often 2000 darts hit each part: as often as its probability says, 0.1 to 0.4.",
    "action", "how often", kind="bars",
    call=lambda grader: (grader.chosen, np.array([0.1, 0.2, 0.3, 0.4]), 1, 2000),
    of=lambda answer, *_: np.bincount(np.array(answer["the actions"], int).clip(0, 9), minlength=4),
)  # fmt: skip
PICTURES["12.3"] = Picture(
    "What a random policy saw of the cart-pole, step by step, until the pole fell.",
    "step", "observation", kind="curves", of=lambda answer, *_: answer["observations"],
    call=lambda grader: (
        grader.lived, *next(grader.lives(np.random.default_rng(3), "CartPole-v1", 2, 4, 400))
    ),
)  # fmt: skip
PICTURES["12.4"] = Picture(
    "The steps of the best episodes, one below the other; those of all others are gone.",
    "observed number", "step", kind="heat", of=lambda answer, *_: answer["observations"],
    call=lambda grader: ("elite", list(grader.made(np.random.default_rng(1), 12)), 70),
)  # fmt: skip
PICTURES["12.6"] = Picture(
    "The loss falls from update to update.",
    "update", "loss", kind="curves", of=lambda answer, *_: {"losses": answer["the losses"]},
    call=lambda grader: (
        grader.improved, np.ones((2, 4)), np.random.default_rng(1).normal(size=(40, 4)),
        np.arange(40) % 2, "Adam", 60,
    ),
)  # fmt: skip
PICTURES["12.7"] = Picture(
    "Two actions, drawn 1000 times: around their means, 2 and -2, one narrow, one wide.",
    "action", "share", kind="histogram",
    call=lambda grader: (grader.drawn, np.array([2.0, -2.0]), np.array([-1.0, 0.5]), 1, 1000),
)  # fmt: skip
