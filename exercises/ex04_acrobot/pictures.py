"""What `botschool show` draws of the tasks of exercise 4."""

import numpy as np

from botschool.grading import Picture, all_over

PICTURES = {}


def read_all(module, observations):
    """decode(observation), of an arm that turns around,"""
    found = [module.decode(each) for each in observations]
    return {name: [float(each[name]) for each in found] for name in found[0]}


TURN = np.linspace(-3, 3, 61)
TURNING = [np.cos(TURN), np.sin(TURN), np.cos(TURN / 2), np.sin(TURN / 2), TURN, -2 * TURN]
PICTURES["4.1"] = Picture(
    "The arm turns once around: both angles rise along lines, without a leap.",
    "true angle of the first link (rad)", "decoded", kind="curves",
    call=(read_all, np.stack(TURNING, axis=1)), of=lambda answer, *_: answer | {"over": TURN},
)  # fmt: skip
ANGLES = np.meshgrid(np.linspace(-3.1, 3.1, 31), np.linspace(-3.1, 3.1, 31))
FOUR = [turn(angle) for angle in ANGLES for turn in (np.cos, np.sin)]
PICTURES["4.2"] = Picture(
    "The tip is highest, 2, where the first link points up and the second follows it.",
    "angle of the first link (rad)", "angle of the second (rad)", kind="heat",
    extent=(-3.1, 3.1, -3.1, 3.1),
    call=(all_over, "height", np.stack([*FOUR, *0 * np.array(ANGLES)], axis=-1)),
)  # fmt: skip
PICTURES["4.3"] = Picture(
    "The best of each generation in two runs of the tool, as their stat files say.",
    "generation", "fitness", kind="curves",
    call=lambda grader: (grader.replicated, grader.PENDULUM, [2, 1], "runs", 60_000, []),
    of=lambda answer, *_: {name: np.reshape(one["its numbers"], (-1, 6))[:, 3]
                           for name, one in answer["stat"].items()},
)  # fmt: skip
PICTURES["4.4"] = Picture(
    "Of the six columns, the best so far only rises, the others go up and down.",
    "steps", "fitness", kind="curves",
    call=lambda grader: (
        grader.read_saved, "runs/statS1.npy", grader.table_of(np.random.default_rng(1), 40).ravel()
    ),
    of=lambda answer, *_: {name: values for name, values in answer.items() if name != "steps"}
    | {"over": answer["steps"]},
)  # fmt: skip
BUDGETS = np.linspace(2100, 60_000, 60)
PICTURES["4.5"] = Picture(
    "The mean of three runs of different lengths at equal steps, and the spread between them.",
    "steps", "fitness", kind="curves", of=lambda answer, *_: answer | {"over": BUDGETS},
    call=lambda grader: (
        "curves", grader.stats_of(np.random.default_rng(2), 30, 50, 40), "average", BUDGETS
    ),
)  # fmt: skip
PICTURES["4.6"] = Picture(
    "For each seed, what the curve promised, and what both saved robots reach in new episodes.",
    "", "mean return", call=lambda grader: (
        grader.compared, *grader.saved_runs(np.random.default_rng(1), grader.PENDULUM, 16, 3)
    ),
    of=lambda answer, *_: {f"{row['seed']} {name}": row[name] for row in answer[0]
                           for name in ("promised", "best", "bestg")},
)  # fmt: skip
