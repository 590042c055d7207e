"""What `botschool show` draws of the tasks of exercise 13."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PULSE = np.zeros((60, 1))
PULSE[[20, 50]] = 1.0
BEGINS = np.zeros((60, 1))
BEGINS[[0, 30]] = 1.0
PICTURES["13.1"] = Picture(
    "Two rewards, in steps 20 and 50: their light falls back in time, and stops where the "
    "episode of step 30 begins.",
    "step", "advantage", kind="curves",
    call=("advantages", PULSE, 0 * PULSE, BEGINS, np.zeros(1), np.zeros(1), 0.97, 0.9),
)  # fmt: skip
RATIOS = np.linspace(0.5, 1.5, 51)


def clipping(module, ratios):
    """policy_loss of two steps, while the ratio of one moves,"""
    import numpy

    found = [
        [
            float(module.policy_loss(
                numpy.array([numpy.log(ratio), 0.0]), numpy.zeros(2), numpy.array([side, -side]),
                0.2,
            )["loss"])
            for side in (1.0, -1.0)
        ]
        for ratio in ratios
    ]  # fmt: skip
    return {"loss": found, "over": ratios}


PICTURES["13.2"] = Picture(
    "The loss of a step that was better than expected is flat above 1.2, of a worse one below 0.8.",
    "ratio of new to old probability", "loss", kind="curves", call=(clipping, RATIOS),
)  # fmt: skip
SCORES = np.linspace(-6, 6, 61)
PICTURES["13.4"] = Picture(
    "Two choices: the entropy is highest, ln 2, where both scores are equal.",
    "first score minus second", "entropy", kind="curves",
    call=("entropy_of_choices", np.stack([SCORES, 0 * SCORES], axis=1)),
    of=lambda answer, *_: {"entropy": answer, "over": SCORES},
)  # fmt: skip
SEEN = np.random.default_rng(1).normal(size=(100, 4))
PICTURES["13.7"] = Picture(
    "Of eight neurons, each follows some of the four observed numbers, with or against them.",
    "observed number", "neuron", kind="heat",
    call=("responses", np.tanh(SEEN @ np.random.default_rng(2).normal(size=(4, 8))), SEEN),
)  # fmt: skip
