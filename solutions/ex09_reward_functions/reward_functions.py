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
# The text is `README.md`. Fill in the functions one after another. `botschool grade 9` grades
# them, `botschool grade 9.1` one task.

# %%
"""Exercise 9: what running robots are rewarded for, and what becomes of them."""

import numpy as np

from botschool.course.locomotion import Runner, draw_gaits

# %% [markdown]
# A *trajectory* is a recorded episode of T steps, a dict of arrays:
#
# | key | shape | what it holds |
# |---|---|---|
# | `"robot"` | | Hopper, HalfCheetah, Ant, Walker2D or Humanoid |
# | `"duration"` | | seconds that a step lasts: 0.0165 in PyBullet, planar runners have others |
# | `"distance"` | (T + 1,) | metres to the target: at the start, then after each step |
# | `"height"`, `"pitch"` | (T,) | of the torso after each step, in metres and radians |
# | `"heading"` | (T,) | angle to the target after each step, in radians |
# | `"touching"` | (T,) | 1 if a HalfCheetah's shin or thigh was on the floor, else 0 |
# | `"actions"` | (T, joints) | the actions, from -1 to 1 |
# | `"speeds"` | (T, joints) | of the joints after each step, in units of 10 radians per second |
# | `"positions"` | (T, joints) | of the joints after each step; -1 and 1 are their limits |
#
# ## Task 9.1. Progress, and being alive


# %%
def progress(distance: np.ndarray, duration: float) -> np.ndarray:
    """The speed towards the target in each step, in metres per second; shape (T,).

    distance, shape (T + 1,), holds the metres to the target, duration the seconds that a step
    lasts. Coming nearer is positive.
    """
    ### BEGIN SOLUTION task 9.1: measure progress
    return (distance[:-1] - distance[1:]) / duration
    ### END SOLUTION


def alive_bonus(
    robot: str, height: np.ndarray, pitch: np.ndarray, touching: np.ndarray
) -> np.ndarray:
    """The alive bonus after each step, shape (T,), by the table in README.md; -1 for the fallen.

    Each step is judged by itself: a robot that has got up again is not a fallen one.
    """
    ### BEGIN SOLUTION task 9.1: tell the standing from the fallen
    if robot == "Ant":
        return np.where(height > 0.26, 1.0, -1.0)
    if robot == "Humanoid":
        return np.where(height > 0.78, 2.0, -1.0)
    upright = np.abs(pitch) < 1
    if robot == "HalfCheetah":
        return np.where(upright & (touching == 0), 1.0, -1.0)
    return np.where(upright & (height > 0.8), 1.0, -1.0)
    ### END SOLUTION


# %% [markdown]
# ## Task 9.2. What effort costs


# %%
def electricity(robot: str, actions: np.ndarray, speeds: np.ndarray) -> np.ndarray:
    """What the motors cost in each step, a negative number or 0; shape (T,).

    By the formula of README.md. actions and speeds have the shape (T, joints).
    """
    ### BEGIN SOLUTION task 9.2: charge for electricity
    cost = 2.0 * np.abs(actions * speeds).mean(axis=1) + 0.1 * (actions**2).mean(axis=1)
    return -cost * (4.25 if robot == "Humanoid" else 1.0)
    ### END SOLUTION


def joints_at_limit(positions: np.ndarray) -> np.ndarray:
    """-0.1 for each joint at its limit, in each step; shape (T,).

    A joint is at its limit when its position is below -0.99 or above 0.99. positions has the shape
    (T, joints).
    """
    ### BEGIN SOLUTION task 9.2: count the joints at their limits
    return -0.1 * (np.abs(positions) > 0.99).sum(axis=1)
    ### END SOLUTION


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
    ### BEGIN SOLUTION task 9.3: rebuild version 0
    robot = trajectory["robot"]
    return {
        "progress": progress(trajectory["distance"], trajectory["duration"]),
        "alive": alive_bonus(
            robot, trajectory["height"], trajectory["pitch"], trajectory["touching"]
        ),
        "electricity": electricity(robot, trajectory["actions"], trajectory["speeds"]),
        "joints_at_limit": joints_at_limit(trajectory["positions"]),
    }
    ### END SOLUTION


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
    ### BEGIN SOLUTION task 9.4: rebuild version 5
    robot, positions = trajectory["robot"], trajectory["positions"]
    reward = progress(trajectory["distance"], trajectory["duration"])
    if robot in ("Hopper", "Walker2D"):
        return reward
    reward = reward + joints_at_limit(positions)
    if robot == "Ant":
        reward = reward + 0.01 - 0.01 * (trajectory["actions"] ** 2).mean(axis=1)
    if robot == "Humanoid":
        beyond = np.maximum(np.abs(positions) - 1, 0).sum(axis=1)
        reward = reward + 1 - 10 * beyond - 0.1 * trajectory["heading"] ** 2
    return reward
    ### END SOLUTION


# %% [markdown]
# ## Task 9.5. Planar runners, and a gait in five numbers
#
# The robots that you are going to evolve live in a vertical plane. They are paid in version 5 like
# their namesakes above. Their version 0 has three components:
#
# | robot | progress | alive bonus | it has fallen unless | effort, for each joint |
# |---|---|---|---|---|
# | PlanarHopper | as before | 1 | height > 0.7 and abs(pitch) < 0.2 | -0.001 * action^2 |
# | PlanarWalker2D | as before | 1 | 0.8 < height < 2 and abs(pitch) < 1 | -0.001 * action^2 |
# | PlanarHalfCheetah | as before | 0 | (it does not matter) | -0.1 * action^2 |
#
# The fallen get 0 here instead of the bonus. The effort of a step is the *sum* over the joints.
#
# Trajectories of planar runners have `"robot"`, `"duration"`, `"distance"`, `"height"`, `"pitch"`
# and `"actions"` as above, and `"feet"`, shape (T, feet): 1 if a foot has touched the ground in
# the step, else 0.


# %%
def planar_v0(trajectory: dict) -> dict:
    """The reward of a planar runner's version 0 in each step, as components to be added up.

    Returns a dict of arrays of the shape (T,): "progress", "alive" and "effort".
    """
    ### BEGIN SOLUTION task 9.5: rebuild a planar runner's version 0
    robot, height, pitch = (trajectory[key] for key in ("robot", "height", "pitch"))
    price, alive = 0.001, np.zeros(len(height))
    if robot == "PlanarHopper":
        alive = np.where((height > 0.7) & (np.abs(pitch) < 0.2), 1.0, 0.0)
    elif robot == "PlanarWalker2D":
        alive = np.where((height > 0.8) & (height < 2) & (np.abs(pitch) < 1), 1.0, 0.0)
    else:
        price = 0.1
    return {
        "progress": progress(trajectory["distance"], trajectory["duration"]),
        "alive": alive,
        "effort": -price * (trajectory["actions"] ** 2).sum(axis=1),
    }
    ### END SOLUTION


def gait(trajectory: dict) -> dict:
    """What a planar runner does, in five floats.

    "metres": how much nearer the target is at the end than at the start. "seconds": the length of
    the episode. "speed": metres per second, on average. "standing": the share of its income in
    version 0 that is pay for standing, sum(alive) / (sum(alive) + sum(progress)). Both sums go over
    the steps, and leave out each step in which the component is negative; 0.0 if both are 0.
    "grounded": the share of the steps in which at least one foot has touched the ground.
    """
    ### BEGIN SOLUTION task 9.5: describe a gait
    parts = planar_v0(trajectory)
    metres = float(trajectory["distance"][0] - trajectory["distance"][-1])
    seconds = trajectory["duration"] * len(trajectory["height"])
    alive, moved = (float(np.maximum(parts[key], 0).sum()) for key in ("alive", "progress"))
    return {
        "metres": metres,
        "seconds": seconds,
        "speed": metres / seconds,
        "standing": alive / (alive + moved) if alive + moved > 0 else 0.0,
        "grounded": float(trajectory["feet"].max(axis=1).mean()),
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 9.6. Evolve both, and compare
#
# `Runner("PlanarHopper-v5").evolve(steps, seed)` evolves a robot and returns its genotype, an
# array. `runner.record(genotype, seed)` plays an episode and returns its trajectory. One evolution
# can be lucky, so each version is evolved from several seeds.


# %%
def evolve_both(robot: str, steps: int, seeds: list[int]) -> dict:
    """Evolves the robot in both versions, each once with every seed, for so many steps each.

    robot is for example "PlanarHopper". Returns {"v0": genotypes, "v5": genotypes}, arrays with a
    row for each seed.
    """
    ### BEGIN SOLUTION task 9.6: evolve in both versions
    return {
        version: np.array([Runner(f"{robot}-{version}").evolve(steps, seed) for seed in seeds])
        for version in ("v0", "v5")
    }
    ### END SOLUTION


def compare(robot: str, genotypes: dict, seed: int, episodes: int) -> dict:
    """The gaits of robots that were evolved in several versions.

    genotypes: as `evolve_both` returns them. All are recorded in version 5 of the robot's
    environment, each in the same episodes, with the seeds seed, seed + 1, ... Returns, for each
    key of genotypes, a dict with the keys of `gait`: arrays with the mean over the episodes for
    each row.
    """
    ### BEGIN SOLUTION task 9.6: compare the gaits
    runner, table = Runner(f"{robot}-v5"), {}
    for version, rows in genotypes.items():
        means = []
        for genotype in rows:
            gaits = [gait(runner.record(genotype, seed + i)) for i in range(episodes)]
            means.append([np.mean([each[name] for each in gaits]) for name in gaits[0]])
        table[version] = dict(zip(gaits[0], np.array(means).T, strict=True))
    return table
    ### END SOLUTION


# %% [markdown]
# ## The pictures
#
# `botschool show 9` runs this part.

# %%
if __name__ == "__main__":
    STEPS, SEEDS = 5_000_000, [1, 2, 3]
    genotypes = evolve_both("PlanarHopper", STEPS, SEEDS)
    table = compare("PlanarHopper", genotypes, 1000, 10)
    for version, gaits in table.items():
        numbers = (f"{name} {v.mean():.2f} ({v.min():.2f} to {v.max():.2f})"
                   for name, v in gaits.items())  # fmt: skip
        print(f"evolved in {version}: ", ", ".join(numbers))
    runner = Runner("PlanarHopper-v5")
    trajectories, incomes, examples, strips = {}, {}, {}, {}
    for version, rows in genotypes.items():
        label = f"evolved in {version}"
        middle = int(np.argsort(table[version]["metres"])[len(rows) // 2])
        trajectories[label] = [runner.record(genotype, 1000) for genotype in rows]
        examples[label] = trajectories[label][middle]
        incomes[label] = {k: float(v.sum()) for k, v in planar_v0(examples[label]).items()}
        strips[label] = runner.strip(rows[middle], 1000)
        paid = Runner(f"PlanarHopper-{version}")
        paid.film(f"hopper_{version}.mp4", rows[middle], 1000)
        about = f"evolved in {version} with seed {SEEDS[middle]}, {STEPS:,} steps"
        paid.replay(f"hopper_{version}.html", rows[middle], 1000, about)
    draw_gaits("gaits.png", trajectories, incomes, examples, strips)
