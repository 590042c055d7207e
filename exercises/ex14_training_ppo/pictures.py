"""What `botschool show` draws of the tasks of exercise 14."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}


def falling(steps):
    """Entries of a log: the loss falls, the return rises."""
    return [entry for step in steps for entry in (
        ("train/loss", step, float(np.exp(-step / 3000))),
        ("rollout/ep_rew_mean", step, float(200 - 180 * np.exp(-step / 5000))),
    )]  # fmt: skip


PICTURES["14.2"] = Picture(
    "Two indicators of a training, as its log has them: the return rises, the loss falls.",
    "entry", "value", kind="curves",
    call=lambda grader: (grader.with_files, *grader.log_of(falling(range(200, 12_000, 400)))),
    of=lambda answer, *_: {name: one["values"] for name, one in sorted(answer.items())},
)  # fmt: skip
RUNS = {
    name: [
        {"steps": np.cumsum(np.full(30, length)), "best": top * (1 - np.exp(-np.arange(30) / late))}
        for length in (40.0, 55.0)
    ]
    for name, top, late in (("PPO", 180.0, 6.0), ("ES", 200.0, 12.0))
}
PICTURES["14.8"] = Picture(
    "Two runs each of PPO and evolution, at the same steps: one is quicker at first.",
    "place", "best so far", kind="curves", call=("at_equal_steps", RUNS, 40),
    of=lambda answer, *_: {name: np.transpose(answer[name]) for name in RUNS},
)  # fmt: skip
