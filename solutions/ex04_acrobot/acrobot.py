# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercise 4. The tool
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 4` grades
# them, `botschool grade 4.1` one task.

# %%
"""Exercise 4: Acrobot, evolved with the tool."""

from pathlib import Path

import numpy as np

from botschool import config
from botschool.course import SavedRobot
from botschool.evolution.run import Run, evolve

# %% [markdown]
# ## Task 4.1. What Acrobot observes
#
# The state of the arm is four numbers:
#
# - $\theta_1$, the angle of the first link from hanging straight down (anticlockwise is
#   positive);
# - $\theta_2$, the angle of the second link *relative to the first one*: 0 when the arm is
#   straight;
# - the speeds of these two angles, in radians per second.
#
# The observation has six numbers, because angles are given by cosine and sine:
#
# $$(\cos\theta_1, \sin\theta_1, \cos\theta_2, \sin\theta_2, \dot\theta_1, \dot\theta_2)$$
#
# This has a reason: just before and just after a full turn the arm looks the same, but the angle
# jumps from $\pi$ to $-\pi$. Cosine and sine do not jump. To get an angle back you need both of
# them: `np.arctan2(sine, cosine)` returns it, between $-\pi$ and $\pi$.


# %%
def decode(observation: np.ndarray) -> dict:
    """Return the state of the arm, from an observation of shape (6,).

    Returns a dict with the floats "angle1" and "angle2" (radians, from -pi to pi), "speed1" and
    "speed2" (radians per second).
    """
    ### BEGIN SOLUTION task 4.1: decode the observation
    cos1, sin1, cos2, sin2, speed1, speed2 = (float(value) for value in observation)
    return {
        "angle1": float(np.arctan2(sin1, cos1)),
        "angle2": float(np.arctan2(sin2, cos2)),
        "speed1": speed1,
        "speed2": speed2,
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 4.2. What Acrobot does, and what for
#
# The actions 0, 1 and 2 put a torque of -1, 0 and +1 on the second joint.
#
# The free end of the arm must reach a line, one link above the nail. How high is it? Each link
# has length 1. The end of a link that makes the angle $\alpha$ with straight down is $\cos\alpha$
# *below* its beginning. The first link makes the angle $\theta_1$, the second one
# $\theta_1 + \theta_2$. So the height of the free end above the nail is
#
# $$h = -\cos\theta_1 - \cos(\theta_1 + \theta_2)$$
#
# from -2 (hanging) to 2 (upright). The reward of a step is -1. Only the step that brings the free
# end above the line, $h > 1$, costs nothing; it also ends the episode. So the return is minus the
# time needed, and an arm that never gets there has -500, as episodes end after 500 steps.


# %%
def torque(action: int) -> float:
    """Return the torque on the second joint: -1.0, 0.0 or 1.0 for the actions 0, 1 and 2."""
    ### BEGIN SOLUTION task 4.2: give the torque
    return float(action - 1)
    ### END SOLUTION


def height(observation: np.ndarray) -> float:
    """Return how far the free end is above the nail, from -2.0 to 2.0.

    observation has shape (6,).
    """
    ### BEGIN SOLUTION task 4.2: compute the height
    state = decode(observation)
    return float(-np.cos(state["angle1"]) - np.cos(state["angle1"] + state["angle2"]))
    ### END SOLUTION


def reward(observation: np.ndarray) -> float:
    """Return the reward of the step that led here: 0.0 above the line, otherwise -1.0."""
    ### BEGIN SOLUTION task 4.2: compute the reward
    return 0.0 if height(observation) > 1 else -1.0
    ### END SOLUTION


# %% [markdown]
# ## Task 4.3. Replications with the tool
#
# - `experiment = config.load(file)` reads an experiment file;
# - `run = Run(experiment, seed)` prepares one run;
# - `evolve(run, folder, steps)` does it and writes its files into the folder (a `Path`), which
#   must exist: `folder.mkdir(parents=True, exist_ok=True)`. `steps` ends the run after so many
#   steps; None means the whole budget, which the experiment file sets (`maxmsteps`, in millions);
# - afterwards `run.record.bestg_fitness` is the best post-evaluated fitness.
#
# A run with seed 7 writes `statS7.npy` (the curves), `bestS7.npy`, `bestgS7.npy`, and some more.


# %%
def run_replications(
    experiment_file: str, seeds: list[int], folder: str, steps: int | None = None
) -> dict:
    """Run the experiment once with each seed and leave the files of all runs in the folder.

    Make the folder, and those above it, if they do not exist. Files of other runs in the folder
    stay. A run whose seed has files there already runs again and replaces them.

    Returns a dict: seed -> best post-evaluated fitness of that run.
    """
    ### BEGIN SOLUTION task 4.3: run the replications
    Path(folder).mkdir(parents=True, exist_ok=True)
    experiment = config.load(experiment_file)
    fitness = {}
    for seed in seeds:
        run = Run(experiment, seed)
        evolve(run, Path(folder), steps)
        fitness[seed] = float(run.record.bestg_fitness)
    return fitness
    ### END SOLUTION


# %% [markdown]
# ## Task 4.4. The stat file
#
# `statS7.npy` holds one long, flat array of numbers: six for the first generation, then six for
# the second one, and so on. `np.load(path)` reads it.

# %%
COLUMNS = (
    "steps",
    "best fitness",
    "best post-evaluated",
    "best of generation",
    "average",
    "average parameter",
)
"""The six numbers of a generation: steps done so far, best fitness so far, best post-evaluated
fitness so far, then best fitness, average fitness and average absolute parameter of this
generation."""


def read_stat(path: str) -> dict:
    """Return the curves of a run, from its stat file.

    Returns a dict: each name in COLUMNS -> array of shape (generations,).
    """
    ### BEGIN SOLUTION task 4.4: read the stat file
    table = np.load(path).reshape(-1, len(COLUMNS))
    return {name: table[:, column] for column, name in enumerate(COLUMNS)}
    ### END SOLUTION


# %% [markdown]
# ## Task 4.5. Mean and spread at equal steps
#
# An episode of Acrobot is over when the line is reached, so better robots make shorter episodes,
# and the tenth generation of one run has used other steps than the tenth of another. Ask at equal
# *steps*: how good was each run when it had used, say, a million of them? It was as good as the
# last generation that was complete by then.


# %%
def curves(stats: list[dict], column: str, budgets: np.ndarray) -> dict:
    """Return mean and standard deviation of several runs after given numbers of steps.

    stats holds what read_stat returns, one dict for each run. The value of a run at a budget is
    that of the last generation whose "steps" are at most the budget. No budget is smaller than the
    steps of any run's first generation; some may be larger than those of its last one. The budgets
    come in any order.

    Returns a dict with "mean" and "deviation" (dividing by the number of runs minus one; there are
    at least two runs), arrays of the same shape as budgets.
    """
    ### BEGIN SOLUTION task 4.5: compute mean and deviation
    values = [
        stat[column][np.searchsorted(stat["steps"], budgets, side="right") - 1] for stat in stats
    ]
    return {"mean": np.mean(values, axis=0), "deviation": np.std(values, axis=0, ddof=1)}
    ### END SOLUTION


# %% [markdown]
# ## Task 4.6. What the robots are worth
#
# Load a robot's genotype with `np.load` and make it a `SavedRobot(experiment_file, genotype)`. Then
# `robot.evaluate(seed, episodes)` returns an array with its return in each episode.


# %%
def compare(
    experiment_file: str, folder: str, seeds: list[int], episodes: int, test_seed: int
) -> list[dict]:
    """Compare the robots that the runs in a folder have saved, in the same new episodes.

    Returns a list with a dict for each seed, in the order given:
    - "seed": the seed of the run;
    - "promised": the best post-evaluated fitness of the run, from its stat file;
    - "best": the mean return of bestS<seed>.npy in the episodes of test_seed;
    - "bestg": that of bestgS<seed>.npy.
    """
    ### BEGIN SOLUTION task 4.6: compare the saved robots
    rows = []
    for seed in seeds:
        stat = read_stat(Path(folder) / f"statS{seed}.npy")
        row = {"seed": seed, "promised": float(stat["best post-evaluated"][-1])}
        for kind in ("best", "bestg"):
            robot = SavedRobot(experiment_file, np.load(Path(folder) / f"{kind}S{seed}.npy"))
            row[kind] = float(robot.evaluate(test_seed, episodes).mean())
        rows.append(row)
    return rows
    ### END SOLUTION


# %% [markdown]
# ## The picture
#
# `botschool show 4` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import draw_bands, experiment_file

    acrobot, seeds = experiment_file("acrobot.ini"), [1, 2, 3]
    run_replications(acrobot, seeds, "runs")
    stats = [read_stat(f"runs/statS{seed}.npy") for seed in seeds]

    last = min(stat["steps"][-1] for stat in stats)
    budgets = np.geomspace(max(stat["steps"][0] for stat in stats), last, 400)
    bands = {}
    for column in ("best fitness", "best post-evaluated", "average"):
        band = curves(stats, column, budgets)
        bands[column] = (band["mean"], band["deviation"])
    draw_bands("curves.png", budgets / 1e6, bands, title="Acrobot, 3 runs", logarithmic=True)

    rows = compare(acrobot, "runs", seeds, episodes=200, test_seed=2_000_000)
    print("seed  promised    best   bestg   (mean return in 200 new episodes)")
    for row in rows:
        print(f"{row['seed']:>4}  {row['promised']:>8.1f}{row['best']:>8.1f}{row['bestg']:>8.1f}")
    winner = max(rows, key=lambda row: row["bestg"])["seed"]
    robot = SavedRobot(acrobot, np.load(f"runs/bestgS{winner}.npy"))
    robot.film("acrobot.mp4", seed=2_000_000, episodes=3)
