"""What `botschool show` draws of the tasks of exercise 11."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
LINE = np.linspace(-6, 6, 61)[:, None]
STEPS = np.array([[1.0], [3.0], [-1.0]]), np.array([0.0, 3.0, 2.0])
PICTURES["11.1"] = Picture(
    "Three hidden neurons over one input: soft steps, each at a place and with a slope of its own.",
    "input", "feature", kind="curves", of=lambda answer, *_: {"": answer, "over": LINE[:, 0]},
    call=lambda grader: (grader.activated, "features", LINE, *STEPS, np.ones((1, 3)), np.zeros(1)),
)  # fmt: skip


def network(grader):
    return grader.drawn(np.random.default_rng(1), 30, 4, 9, 3)


PICTURES["11.2"] = Picture(
    "The slope of the loss for every weight of the network; rows are neurons of the later layer.",
    "neuron before", "neuron after", kind="heat",
    call=lambda grader: ("gradient_by_hand", *network(grader)),
    of=lambda answer, *_: {name: answer[name] for name in ("w1", "w2")},
)  # fmt: skip
PICTURES["11.3"] = Picture(
    "The same slopes as by hand: torch finds them from the loss alone.",
    "neuron before", "neuron after", kind="heat",
    call=lambda grader: ("gradient_by_torch", *network(grader)),
    of=lambda answer, *_: {name: answer[name] for name in ("w1", "w2")},
)  # fmt: skip
PICTURES["11.4"] = Picture(
    "The loss falls from epoch to epoch, quickly at first.",
    "epoch", "loss", kind="curves",
    call=lambda grader: (grader.trained, "train", [120, 0.05, 0.5], "network", *network(grader)),
    of=lambda answer, *_: {"losses": answer["the list of losses"]},
)  # fmt: skip
PICTURES["11.9"] = Picture(
    "Each hidden neuron parts the plane of the two inputs by a soft line.",
    "first input", "second input", kind="heat", extent=(-2, 2, -2, 2),
    call=lambda grader: (grader.mapped, -2.0, 2.0, 40,
                         np.array([[2.0, 1.0], [0.0, -4.0], [-1.0, 1.0]]), np.ones(3)),
    of=lambda answer, *_: {f"neuron {i + 1}": each for i, each in enumerate(answer)},
)  # fmt: skip
