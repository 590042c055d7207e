"""What `botschool show` draws of the tasks of exercise 5."""

import numpy as np

from botschool.course import genotype_file
from botschool.grading import Picture

PICTURES = {}


def walkers():
    return np.array([np.load(genotype_file(f"bodybrainS{seed}.npy")) for seed in (1, 2, 3)])


def body():
    """The body of the first pre-evolved walker."""
    return walkers()[0, -134:-70]


PICTURES["5.1"] = Picture(
    "Lengths, thicknesses and masses of a walker's eleven segments, the torso first.",
    "segment", "", kind="bars", call=lambda grader: ("sizes", body()),
)  # fmt: skip
PICTURES["5.2"] = Picture(
    "A walker's angles at rest, and how far each of its ten joints turns to both sides.",
    "joint", "angle (rad)", kind="bars", call=lambda grader: ("joints", body()),
)  # fmt: skip
PICTURES["5.3"] = Picture(
    "The body of an evolved walker at rest: eleven segments that hang together.",
    "x (m)", "y (m)", kind="shapes", call=lambda grader: ("outline", body()),
)  # fmt: skip
PICTURES["5.7"] = Picture(
    "What each brain (row) earns in each body (column): the diagonal is at home.",
    "body", "brain", kind="heat", of=lambda answer, *_: answer["its answer"],
    call=lambda grader: (
        grader.crossed, grader.EXPERIMENT.format(maxsteps=200, hidden=50, noise=0.01), walkers(),
        1, 1,
    ),
)  # fmt: skip
PICTURES["5.8"] = Picture(
    "How much each brain loses in foreign bodies, and each body with foreign brains.",
    "walker", "loss", kind="bars",
    call=("loss", np.array([[300.0, 20, -10], [40, 250, 5], [90, 60, 200]])),
    of=lambda answer, *_: {name: answer[name] for name in ("brains", "bodies")},
)  # fmt: skip
