"""What the figures of exercise 5 need."""

from base64 import b64encode
from typing import Any

import numpy as np

from botschool import config, problems
from botschool.page import for_core
from botschool.paths import material
from botschool.problems.native import NativeProblem

CORE = "bodybrain"
WALKERS = ("planarbodybrain", "planarbodybrainS2", "planarbodybrainS3")


def data() -> dict[str, Any]:
    """Return three walkers: network, body and normalisation, one after the other."""
    read = config.load(material() / "data" / "experiments" / "planarbodybrain.ini")
    saved = [np.load(material() / "data" / "genotypes" / f"{name}.npy") for name in WALKERS]
    coded = [b64encode(each.astype("<f4").tobytes()).decode() for each in saved]
    problem = problems.of(read)
    assert isinstance(problem, NativeProblem)
    return {"walking": for_core(read, problem), "walkers": coded}
