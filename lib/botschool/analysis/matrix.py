"""Draw who does how well with whom: brains in each other's bodies, or predators against prey.

With evolved bodies, each robot of a folder's runs gives its brain to the body of each other one.
With two populations, the picture shows the newest saved generation: S12FitG200.npy.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from botschool import problems
from botschool.analysis.coevolution import only_seed
from botschool.analysis.figure import check_picture, new_figure
from botschool.analysis.populations import Populations
from botschool.analysis.runs import find_runs, told_by
from botschool.config import Experiment, from_dict
from botschool.errors import BotschoolError
from botschool.evolution.evaluate import means
from botschool.npy import NotNumbers, read_numbers
from botschool.problems import Episodes
from botschool.render.watch import read_genotype
from botschool.terminal import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

EPISODES, SEED = 20, 300_000
"""Fresh episodes in which a brain is measured in a body, and their seed."""
MOST = 12
"""Rows up to which the picture shows the numbers."""


def plot_matrix(folder: Path, seed: int | None, output: Path | None) -> None:
    """Print and draw the matrix of the folder's runs; seed: of co-evolution, None for its only one.

    Raises BotschoolError.
    """
    check_picture(output)
    told = told_by(folder)
    if told is None:
        raise BotschoolError(
            f"{folder} holds no checkpoint that tells its experiment: name the folder of runs of "
            "evolved bodies (bodybrain.ini, planarbodybrain.ini), or of predators and prey."
        )
    experiment = from_dict(told, str(folder))
    if experiment.competitive:
        matrix, rows, columns, title = _meetings(experiment, folder, seed)
    else:
        matrix, rows, columns, title = _swaps(experiment, folder)
    count = len(matrix)
    with new_figure(
        output, height=2.2 + 0.55 * min(count, 9), width=3.4 + 0.65 * min(count, 9)
    ) as f:
        _draw(f.add_subplot(), matrix, rows, columns, title)
    if output is not None:
        print(f"picture: {output}")


Table = tuple[np.ndarray, str, str, str]
"""Numbers, label of the rows, label of the columns, title."""


def _swaps(experiment: Experiment, folder: Path) -> Table:
    """Return the mean return of each run's brain (row) in each run's body (column)."""
    problem = problems.of(experiment)
    policy, body = problem.policy(experiment.policy), problem.interface.morphology
    runs = [run for run in find_runs(folder) if run.bestg]
    if not body or len(runs) < 2:
        what = f"has {len(runs)} saved robots" if body else "evolves no bodies"
        raise BotschoolError(
            f"{folder} {what}: a matrix needs two runs or more with evolved bodies (bodybrain.ini, "
            "planarbodybrain.ini), or a run of predators and prey."
        )
    robots = [policy.split(read_genotype(run.bestg)) for run in runs]
    asked = Episodes.of([SEED] * len(robots), EPISODES)
    rows = []
    try:
        for brain, normalisation in robots:
            swapped = np.array([np.append(brain[:-body], each[-body:]) for each, _ in robots])
            steps = policy.config.post_steps
            found = problem.evaluate(policy, swapped, normalisation, asked, steps)
            rows.append(means(found.fitness, EPISODES))
    finally:
        problem.close()
    matrix = np.array(rows)
    own = np.diagonal(matrix)
    foreign = (matrix.sum() - own.sum()) / (matrix.size - len(own))
    print(
        f"mean return of {EPISODES} fresh episodes: in its own body {readable(own.mean())}, in "
        f"another one's {readable(foreign)} (rows and columns: seeds "
        f"{', '.join(str(run.seed) for run in runs)})"
    )
    title = f"{experiment.exp.environment}: brains in bodies "
    return matrix, "brain of run", "body of run", title


def _meetings(experiment: Experiment, folder: Path, seed: int | None) -> Table:
    """Return the return of each predator (row) against each prey (column), the best ones first."""
    if experiment.single:
        raise BotschoolError(f"{folder} has one population for both sides: use a tournament.")
    seed = only_seed(folder) if seed is None else seed
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    generation = Populations(folder, seed, policy).generations[-1]
    path = folder / f"S{seed}FitG{generation}.npy"
    try:
        fitness = read_numbers(path)
        matrix = fitness[: len(fitness) // 2]
        assert matrix.ndim == 2 and matrix.size
    except (OSError, NotNumbers, AssertionError, TypeError):
        raise BotschoolError(f"{path} is missing or damaged: let the run save it again.") from None
    prey = fitness[len(fitness) // 2 :]
    matrix = matrix[np.argsort(-matrix.mean(axis=1), kind="stable")]
    order = ""  # of competitors that are not all saved, the file keeps the order
    if prey.shape == (matrix.shape[1], len(matrix)):
        matrix = matrix[:, np.argsort(-prey.mean(axis=1), kind="stable")]
        order = ", best first"
    one, other = problem.sides
    print(f"generation {generation}: mean return of the {one}s {readable(matrix.mean())}")
    title = f"{experiment.exp.environment}, seed {seed}, generation {generation}"
    return matrix, f"{one}, best first", f"{other}{order}", title


def _draw(axes: Axes, matrix: np.ndarray, rows: str, columns: str, title: str) -> None:
    long = max(matrix.shape) > 3 * min(matrix.shape)
    image = axes.imshow(matrix, cmap="viridis", aspect="auto" if long else "equal")
    middle = (np.min(matrix) + np.max(matrix)) / 2
    if max(matrix.shape) <= MOST:
        for (i, j), value in np.ndenumerate(matrix):
            colour = "black" if value > middle else "white"
            axes.text(j, i, readable(value), ha="center", va="center", color=colour, fontsize=8)
    for set_ticks, size in ((axes.set_yticks, len(matrix)), (axes.set_xticks, matrix.shape[1])):
        places = range(0, size, max(1, size // MOST))
        set_ticks(places, [str(place + 1) for place in places])
    axes.set(ylabel=rows, xlabel=columns, title=title)
    axes.spines[:].set_visible(False)
    axes.figure.colorbar(image, ax=axes, label="mean return", shrink=0.85)
