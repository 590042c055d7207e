"""What `botschool show` draws of the tasks of exercise 2."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PICTURES["2.1"] = Picture(
    "Both layers' weights spread around 0 as a bell, nearly all between -0.3 and 0.3.",
    "weight", "share", kind="histogram", call=("parameters", 130, 150, 140, 1),
    of=lambda answer, *_: {name: answer[name] for name in ("W1", "W2")},
)  # fmt: skip


def swept(module, network, observations):
    """forward(network, observation), while one observed number moves,"""
    return [module.forward(network, each) for each in observations]


SWEEP = np.linspace(-4, 4, 81)
PICTURES["2.2"] = Picture(
    "Two outputs while the first observed number moves: soft steps, which tanh keeps within 1.",
    "first observed number", "output", kind="curves",
    call=lambda grader: (
        swept, grader.network_of(np.random.default_rng(4), 4, 5, 2, weights=1.5),
        np.stack([SWEEP, *np.zeros((3, 81))], axis=1),
    ),
    of=lambda answer, *_: {"outputs": answer, "over": SWEEP},
)  # fmt: skip
PICTURES["2.4"] = Picture(
    "The action follows the output along a line, from the lowest torque, -2, to the highest, 2.",
    "output", "action", kind="curves",
    call=lambda grader: (grader.acted, np.linspace(-1, 1, 21)[:, None],
                         {"low": [-2.0], "high": [2.0]}),
    of=lambda answer, outputs, space: {"action": answer[0], "over": np.ravel(outputs)},
)  # fmt: skip
PICTURES["2.5"] = Picture(
    "The torque in each step of an episode: a random network pushes as it observes.",
    "step", "torque", kind="curves", of=lambda answer, *_: {"actions": answer["actions"]},
    call=lambda grader: (
        "run_episode", "Pendulum-v1", grader.network_of(np.random.default_rng(1), 3, 5, 1), 1, 200
    ),
)  # fmt: skip
PICTURES["2.7"] = Picture(
    "Each row is a network, each column an output: all of them come from one call.",
    "output", "network", kind="heat",
    call=lambda grader: (
        "forward_batch", *next(grader.stacked(np.random.default_rng(1), (12, 4, 5, 3)))
    ),
)  # fmt: skip
PICTURES["2.8"] = Picture(
    "Thirty random networks, the luckiest first: most let the pole fall at once.",
    "rank", "fitness (steps)", kind="curves", call=("random_search", "CartPole-v1", 30, 5, 1),
    of=lambda answer, *_: {"fitness": np.sort(answer["fitness"])[::-1]},
)  # fmt: skip
