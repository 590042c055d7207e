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
# # Exercise 9. Reward functions
#
# The background is in `README.md`. Fill in the functions below one after another, and run
# `make test-ex9` (or `botschool grade 9.1` for one task) as often as you like.

# %%
"""Exercise 9: what running robots are rewarded for, and what becomes of them."""

import numpy as np

from botschool.course.locomotion import Runner, draw_gaits, strip

# %% [markdown]
# A *trajectory* is a recorded episode of T steps, a dict of arrays:
#
# | key | shape | what it holds |
# |---|---|---|
# | `"robot"` | | Hopper, HalfCheetah, Ant, Walker2D or Humanoid |
# | `"distance"` | (T + 1,) | metres to the target: at the start, then after each step |
# | `"height"`, `"pitch"` | (T,) | of the torso after each step, in metres and radians |
# | `"heading"` | (T,) | angle to the target after each step, in radians |
# | `"touching"` | (T,) | 1 if a HalfCheetah's shin or thigh was on the floor, else 0 |
# | `"actions"` | (T, joints) | the actions, from -1 to 1 |
# | `"speeds"` | (T, joints) | of the joints after each step, in tenths of radians per second |
# | `"positions"` | (T, joints) | of the joints after each step; -1 and 1 are their limits |
#
# ## Task 9.1. Progress, and being alive


# %%
def progress(distance: np.ndarray) -> np.ndarray:
    """The speed towards the target in each step, in metres per second; shape (T,).

    distance, shape (T + 1,), holds the metres to the target. A step lasts 0.0165 s. Coming nearer
    is positive.
    """
    raise NotImplementedError("task 9.1: measure progress")


def alive_bonus(
    robot: str, height: np.ndarray, pitch: np.ndarray, touching: np.ndarray
) -> np.ndarray:
    """The alive bonus after each step, shape (T,), by the table in README.md; -1 for the fallen."""
    raise NotImplementedError("task 9.1: tell the standing from the fallen")


# %% [markdown]
# ## Task 9.2. What effort costs


# %%
def electricity(robot: str, actions: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """What the motors cost in each step, a negative number or 0; shape (T,).

    -2 times the mean of |action * speed| over the joints, minus 0.1 times the mean squared
    action. A Humanoid pays 4.25 times as much. actions and speeds have the shape (T, joints).
    """
    raise NotImplementedError("task 9.2: charge for electricity")


def joints_at_limit(positions: np.ndarray) -> np.ndarray:
    """-0.1 for each joint at its limit, in each step; shape (T,).

    A joint is at its limit when its position is below -0.99 or above 0.99. positions has the shape
    (T, joints).
    """
    raise NotImplementedError("task 9.2: count the joints at their limits")


# %% [markdown]
# ## Task 9.3. Version 0
#
# Now put them together. Keeping the components apart shows later what a robot lives on.


# %%
def components_v0(trajectory: dict) -> dict:
    """The reward of version 0 in each step, as components to be added up.

    Returns a dict of arrays of the shape (T,): "progress", "alive", "electricity" and
    "joints_at_limit".
    """
    raise NotImplementedError("task 9.3: rebuild version 0")


# %% [markdown]
# ## Task 9.4. Version 5
#
# | robot | reward of a step |
# |---|---|
# | Hopper, Walker2D | progress |
# | HalfCheetah | progress + joints at limit |
# | Ant | progress + 0.01 - 0.01 * mean squared action + joints at limit |
# | Humanoid | progress + 1 + joints at limit - 10 * beyond - 0.1 * heading^2 |
#
# Joints at limit is the negative number of task 9.2. *Beyond* is how far joints are past their
# limits: the sum over all joints of max(0, |position| - 1).


# %%
def reward_v5(trajectory: dict) -> np.ndarray:
    """The reward of version 5 in each step, by the table above; shape (T,)."""
    raise NotImplementedError("task 9.4: rebuild version 5")


# %% [markdown]
# ## Task 9.5. A gait in four numbers


# %%
def gait(trajectory: dict) -> dict:
    """What a robot does, in four floats.

    "metres": how much nearer the target is at the end than at the start. "seconds": the length of
    the episode. "speed": metres per second, on average. "standing": the share of its income in
    version 0 that is pay for standing, sum(alive) / (sum(alive) + sum(progress)), where only
    positive values are added up; 0.0 if there are none.
    """
    raise NotImplementedError("task 9.5: describe a gait")


# %% [markdown]
# ## Task 9.6. Evolve both, and compare
#
# `Runner("HopperBulletEnv-v5").evolve(steps, seed)` evolves a robot and returns its genotype.
# `runner.record(genotype, seed)` plays an episode and returns its trajectory.


# %%
def evolve_both(robot: str, steps: int, seed: int) -> dict:
    """Evolves the robot in both versions, with the same number of steps and the same seed.

    robot is for example "Hopper". Returns {"v0": genotype, "v5": genotype}.
    """
    raise NotImplementedError("task 9.6: evolve in both versions")


def compare(robot: str, genotypes: dict, seed: int, episodes: int) -> dict:
    """The mean gait of each genotype.

    All are recorded in version 5 of the robot's environment, in the episodes with the seeds
    seed, seed + 1, ... Returns, for each key of genotypes, a dict as `gait` does, with the means
    over the episodes.
    """
    raise NotImplementedError("task 9.6: compare the gaits")


# %%
if __name__ == "__main__":
    from botschool.course import SavedRobot, experiment_file, genotype_file

    STEPS, SEED = 60_000, 1
    genotypes = evolve_both("Hopper", STEPS, SEED)
    for version, means in compare("Hopper", genotypes, 1000, 20).items():
        numbers = "  ".join(f"{name} {value:.2f}" for name, value in means.items())
        print(f"Hopper evolved in {version}:  {numbers}")
    runner = Runner("HopperBulletEnv-v5")
    recorded = {version: runner.record(genotypes[version], 1000) for version in genotypes}
    labels = {version: f"evolved in {version}" for version in genotypes}
    draw_gaits(
        "gaits.png",
        {
            labels[version]: {key: float(v.sum()) for key, v in components_v0(one).items()}
            for version, one in recorded.items()
        },
        {labels[v]: one["distance"][0] - one["distance"][1:] for v, one in recorded.items()},
        {labels[v]: strip("HopperBulletEnv-v5", genotypes[v], 1000) for v in recorded},
    )
    for version, genotype in genotypes.items():
        runner.film(f"hopper_{version}.mp4", genotype, 1000)
    evolved = SavedRobot(experiment_file("hopper.ini"), np.load(genotype_file("hopper.npy")))
    evolved.film("evolved_longer.mp4", seed=1000)
