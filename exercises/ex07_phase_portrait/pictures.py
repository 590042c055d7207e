"""What `botschool show` draws of the tasks of exercise 7."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
TURN = np.linspace(-3, 3, 61)
PICTURES["7.1"] = Picture(
    "The angle rises along a line while cosine and sine go around; the velocity is as observed.",
    "true angle (rad)", "angle (rad), velocity (rad/s)", kind="curves",
    call=("to_state", np.stack([np.cos(TURN), np.sin(TURN), 2 * np.sin(2 * TURN)], axis=1)),
    of=lambda answer, *_: {"angle and velocity": answer, "over": TURN},
)  # fmt: skip
PLANE = ("angle (rad), 0 is upright", "velocity (rad/s)")
PICTURES["7.2"] = Picture(
    "An episode leaves a trail of states: where the dots are far apart, the pendulum is fast.",
    *PLANE, kind="points", of=lambda answer, gains, seed, steps: answer[0],
)  # fmt: skip
ALL_OVER = np.meshgrid(np.linspace(-3.1, 3.1, 15), np.linspace(-7, 7, 11))
FALLING = np.stack(ALL_OVER, axis=-1).reshape(-1, 2)
FALLEN = FALLING + 0.05 * np.stack([FALLING[:, 1], 15 * np.sin(FALLING[:, 0])], axis=1)
FALLEN[:, 0] = (FALLEN[:, 0] + np.pi) % (2 * np.pi) - np.pi
PICTURES["7.3"] = Picture(
    "Each arrow leads from a state to the next one, also over the edge at -pi and pi: a river.",
    *PLANE, kind="arrows", call=("arrows", FALLING, FALLEN),
)  # fmt: skip


def river(answer, gains, states, strongest):
    """Arrows, where neither edge is near."""
    return {"from each state to the next": np.hstack([states, np.asarray(answer) - states])}


PICTURES["7.4"] = Picture(
    "The pendulum everywhere, with a motor that pushes it to the middle, where it stands.",
    *PLANE, kind="arrows", of=river,
    call=lambda grader: (
        grader.stepped, np.array([0.0, -8.0, -2.0]), FALLING[np.abs(FALLING[:, 0]) < 2.8], 2
    ),
)  # fmt: skip
PICTURES["7.5"] = Picture(
    "The curve is the fitness of each generation's best.",
    "generation", "fitness", kind="curves", of=lambda answer, *_: {"history": answer["history"]},
)  # fmt: skip
