"""What `botschool show` draws of the tasks of exercise 1."""

import numpy as np

from botschool.grading import Picture, all_over

PICTURES = {}
PICTURES["1.1"] = Picture(
    "Each bar is the lowest or highest value of one of the six numbers that Acrobot observes.",
    "observed number", "value", kind="bars", call=("describe", "Acrobot-v1"),
    of=lambda answer, *_: {side: answer["observation"][side] for side in ("low", "high")},
)  # fmt: skip
PICTURES["1.2"] = Picture(
    "The four numbers that a random agent observes until the pole falls: the last states run away.",
    "step", "observation", kind="curves", call=("random_episode", "CartPole-v1", 3, 1000),
    of=lambda answer, *_: answer["observations"],
)  # fmt: skip


def plane(across, upwards, *columns):
    """Observations, (rows, columns, 4); columns: of these, where the two numbers of a place go."""
    observed = np.zeros((len(upwards), len(across), 4))
    observed[..., columns] = np.stack(np.meshgrid(across, upwards), axis=-1)
    return observed


PICTURES["1.3"] = Picture(
    "An episode goes on in the dark rectangle only: within 2.4 m and 12 degrees.",
    "cart's position (m)", "pole's angle (rad)", kind="heat", extent=(-3, 3, -0.3, 0.3),
    call=(all_over, "fallen", plane(np.linspace(-3, 3, 41), np.linspace(-0.3, 0.3, 31), 0, 2)),
)  # fmt: skip
ANGLES, SPEEDS = np.meshgrid(np.linspace(-3.1, 3.1, 41), np.linspace(-8, 8, 31))
PICTURES["1.4"] = Picture(
    "The reward is highest, 0, upright and at rest, and falls with angle and speed to all sides.",
    "angle (rad), 0 is upright", "speed (rad/s)", kind="heat", extent=(-3.1, 3.1, -8, 8),
    call=(all_over, "pendulum_reward", np.stack([np.cos(ANGLES), np.sin(ANGLES), SPEEDS], -1),
          np.ones(1)),
)  # fmt: skip
PICTURES["1.5"] = Picture(
    "A line parts the states in which your rule pushes to the left from those to the right.",
    "pole's angle (rad)", "pole's speed (rad/s)", kind="heat", extent=(-0.2, 0.2, -2, 2),
    call=(all_over, "balance", plane(np.linspace(-0.2, 0.2, 41), np.linspace(-2, 2, 31), 2, 3)),
)  # fmt: skip
PICTURES["1.6"] = Picture(
    "The mean returns of random agents differ as the rewards do: no two problems share a scale.",
    "", "mean return", call=("compare", ["CartPole-v1", "Acrobot-v1", "Pendulum-v1"], 3, 1),
    of=lambda rows, *_: {row["environment"]: row["mean"] for row in rows},
)  # fmt: skip
