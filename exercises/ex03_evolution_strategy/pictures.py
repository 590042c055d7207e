"""What `botschool show` draws of the tasks of exercise 3."""

import numpy as np

from botschool.grading import Picture

PICTURES = {}
PICTURES["3.1"] = Picture(
    "Each row is an individual: its biases, on the left, are 0, its weights small and random.",
    "parameter", "individual", kind="heat", call=("initial_population", 12, 5, 30, 1),
)  # fmt: skip
PICTURES["3.2"] = Picture(
    "In the order of their ranks, the individuals' fitness only falls.",
    "rank", "fitness", kind="curves", of=lambda answer, fitness: fitness[np.array(answer, int)],
    call=("rank", np.round(np.random.default_rng(1).normal(size=30), 1)),
)  # fmt: skip
PICTURES["3.3"] = Picture(
    "The new population: the better half where it was, and a copy near each of its individuals.",
    "first parameter", "second parameter", kind="points", of=lambda answer, *_: answer[0][0],
    call=lambda grader: (
        grader.steps, np.random.default_rng(2).normal(size=(20, 2)), np.arange(20.0), 0.1, 1
    ),
)  # fmt: skip


def distances(answer, *_):
    """The best individual's distance from the goal, generation by generation."""
    populations = [np.atleast_2d(population) for population, _ in answer[1]]
    goal = np.linspace(-1, 1, populations[0].shape[1])
    return {"distance": [((each - goal) ** 2).mean(axis=1).min() for each in populations]}


PICTURES["3.4"] = Picture(
    "The best individual comes nearer to the goal, and never loses what it has: the curve falls.",
    "generation", "distance of the best from the goal", kind="curves", of=distances,
    call=lambda grader: (
        grader.evolved, "evolve", np.random.default_rng(1).normal(size=(10, 8)), 60, 0.1, 1, 0.0
    ),
)  # fmt: skip
PICTURES["3.5"] = Picture(
    "A climber of two individuals comes nearer in small steps, and never goes back.",
    "generation", "distance of the best from the goal", kind="curves", of=distances,
    call=lambda grader: (
        grader.evolved, "hill_climb", np.random.default_rng(1).normal(size=8), 150, 0.1, 1, 0.0
    ),
)  # fmt: skip
RISING = 200 - 150 * np.exp(-np.arange(15) / np.array([[2.0], [4.0], [8.0]]))
PICTURES["3.6"] = Picture(
    "The mean of three fitness curves, and their deviation, which is largest on the way.",
    "generation", "fitness", kind="curves",
    call=lambda grader: (grader.replicated, RISING, [3, 1, 2]),
    of=lambda answer, *_: {name: answer[name] for name in ("mean", "deviation")},
)  # fmt: skip
