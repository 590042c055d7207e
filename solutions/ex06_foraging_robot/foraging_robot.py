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
# # Exercise 6. A foraging robot
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 6` grades
# them, `botschool grade 6.1` one task.
#
# Ready-made: `weights(genotype)` takes a saved robot of `data/experiments/discrim.ini` apart, into
# the *brain* that the functions below are given. It is a dict with
#
# - "gates", shape (4, 10, 18): the weights of the forget, the input, the output and the candidate
#   gate, in this order; of each gate, a row for each of the 10 units;
# - "readout", shape (2, 10), and "bias", shape (2,): from the units' outputs to the two wheels.
#
# `logistic` and `mean` are there as well.

# %%
"""Exercise 6: a wheeled robot that looks for a cylinder, its strategies and its memory."""

import numpy as np

from botschool import arena as arenas

UNITS, INPUTS = 10, 8


def weights(genotype: np.ndarray) -> dict:
    """The brain of a saved robot of discrim.ini, 752 numbers: see above."""
    _, bias, gates, readout = np.split(np.asarray(genotype, dtype=float), [10, 12, 732])
    gates = gates.reshape(UNITS, 4, INPUTS + UNITS).swapaxes(0, 1)
    return {"gates": gates, "readout": readout.reshape(2, UNITS), "bias": bias}


def logistic(x: np.ndarray) -> np.ndarray:
    """1 / (1 + exp(-x)) of each value."""
    return 1 / (1 + np.exp(-x))


def mean(values: np.ndarray) -> float:
    """The mean, or 0 of nothing."""
    return float(np.mean(values)) if len(values) else 0.0


# %% [markdown]
# ## Task 6.1. One step of an LSTM
#
# The *memory* has two rows of 10 numbers, one for each unit: `memory[0]`, the cells, and
# `memory[1]`, the units' outputs in the step before. A step:
#
# 1. Put the 8 values of the observation and the 10 outputs of the step before into one vector z.
# 2. Each gate multiplies its weights by z. With the logistic function
#    $\sigma(x) = 1 / (1 + e^{-x})$:
#
#    forget $= \sigma(W_f z + 1)$,  input $= \sigma(W_i z)$,  output $= \sigma(W_o z)$,
#    candidate $= \tanh(W_c z)$
# 3. New cells: cells * forget + candidate * input. New outputs: tanh(new cells) * output.
# 4. The action: tanh(readout times the new outputs, plus bias), from -1 (full speed back) to 1.


# %%
def think(brain: dict, observation: np.ndarray, memory: np.ndarray) -> tuple:
    """One step of the network: (action, new memory).

    Shapes: observation (8,), memory (2, 10), action (2,), new memory (2, 10). The arrays given
    stay as they are.
    """
    ### BEGIN SOLUTION task 6.1: update the LSTM and compute the action
    z = np.concatenate([observation, memory[1]])
    forget, enter, leave, candidate = brain["gates"] @ z
    cells = memory[0] * logistic(forget + 1) + np.tanh(candidate) * logistic(enter)
    outputs = np.tanh(cells) * logistic(leave)
    action = np.tanh(brain["readout"] @ outputs + brain["bias"])
    return action, np.stack([cells, outputs])
    ### END SOLUTION


# %% [markdown]
# ## Task 6.2. An episode, recorded
#
# `arenas.make("discrim", max_steps=500)` makes the arena. Its arrays are windows on what is inside:
#
# - `arena.reset(seed)` starts an episode; the seed decides on the noise of the sensors;
# - `arena.robots[0] = x, y, heading` and `arena.objects[0, :2] = x, y` put the robot and the
#   cylinder somewhere else, and `arena.sense()` renews the observation afterwards;
# - `arena.observation` is what the robot senses, `arena.action` what its wheels are to do, and
#   `arena.step()` does it and returns the reward; `arena.done` tells whether the episode has ended.
#
# All of them change with every step: what you want to keep, you must copy. What the robot
# remembers is decided by a function: `remember(step, before, after)` gets the number of the step
# (from 0) and the memory before and after it, and returns the memory for the next step. `keep` is
# the ordinary one.


# %%
def keep(step: int, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Remembers as an LSTM does."""
    return after


def episode(brain: dict, start, cylinder, seed: int, remember=keep, maxsteps: int = 500) -> dict:
    """One episode, from start (x, y, heading), with a cylinder at (x, y); the memory begins at 0.

    Ends after maxsteps steps, or with a collision. Returns a dict for its T steps:
    - "poses", shape (T + 1, 3): the start, and where the robot is after each step;
    - "observations", shape (T, 8), "memories", (T, 2, 10), and "actions", (T, 2): what the network
      was given in each step, and what it answered;
    - "rewards", shape (T,).
    """
    ### BEGIN SOLUTION task 6.2: record an episode
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0] = start
    arena.objects[0, :2] = cylinder
    arena.sense()
    memory = np.zeros((2, UNITS))
    poses, steps = [arena.robots[0].copy()], []
    while not arena.done:
        observation = arena.observation.copy()
        action, after = think(brain, observation, memory)
        arena.action = action
        steps.append((observation, memory, action, arena.step()))
        poses.append(arena.robots[0].copy())
        memory = remember(len(steps) - 1, memory, after)
    names = ("observations", "memories", "actions", "rewards")
    columns = zip(names, zip(*steps, strict=True), strict=True)
    return {"poses": np.array(poses), **{name: np.array(column) for name, column in columns}}
    ### END SOLUTION


# %% [markdown]
# ## Task 6.3. A grid of starts
#
# To compare robots, let all of them start from the same places, spread evenly over the region where
# episodes start.


# %%
def grid(places: int, headings: int) -> np.ndarray:
    """Starts, shape (places * places * headings, 3): rows x, y, heading.

    x takes `places` evenly spaced values from 150 to 250, and y from 270 to 350, both ends included
    (`places` is at least 2). The headings divide the whole turn evenly, from 0; 2 pi is 0 again,
    and is left out. The heading changes fastest, then x; y changes slowest.
    """
    ### BEGIN SOLUTION task 6.3: lay out the starts
    angles = np.arange(headings) * 2 * np.pi / headings
    ys, xs = np.linspace(270, 350, places), np.linspace(150, 250, places)
    return np.array([(x, y, angle) for y in ys for x in xs for angle in angles])
    ### END SOLUTION


# %% [markdown]
# ## Task 6.4. A behaviour in six numbers
#
# An episode has two parts: the *search*, all steps before the first one with a reward, and the
# steps *near* the cylinder, those with a reward of 1 (the robot may lose it and come back). Step t
# goes from poses[t] to poses[t + 1].
#
# In the search:
#
# - "search": how many steps it lasts;
# - "speed": how far the robot moves along its heading at the beginning of the step, in mm:
#   $\Delta x \cos\theta + \Delta y \sin\theta$; negative when it drives backwards;
# - "turning": by how much its heading changes, the short way around, in rad; positive to the left;
# - "wall": the share of steps that begin with the robot's centre nearer than 72.5 mm to a wall,
#   where its sensors can see it.
#
# Near the cylinder:
#
# - "pace": how far the robot moves, in mm: $\sqrt{\Delta x^2 + \Delta y^2}$;
# - "side": the sine of the angle from its heading to the direction of the cylinder, after the
#   step: 1 means that the cylinder is to its left, -1 to its right.


# %%
def describe(poses: np.ndarray, rewards: np.ndarray, cylinder) -> dict:
    """The six descriptors of an episode, by name; all but "search" are means over their steps.

    Those of the search are 0 where no step belongs to it, and so are those near the cylinder. The
    arena is 400 mm wide and high; poses and rewards are as `episode` gives them.
    """
    ### BEGIN SOLUTION task 6.4: describe an episode
    near = rewards > 0
    search = int(near.argmax()) if near.any() else len(rewards)
    before, after = poses[:-1], poses[1:]
    moved = after[:, :2] - before[:, :2]
    forward = moved[:, 0] * np.cos(before[:, 2]) + moved[:, 1] * np.sin(before[:, 2])
    turned = (after[:, 2] - before[:, 2] + np.pi) % (2 * np.pi) - np.pi
    to_wall = np.minimum(before[:, :2], 400 - before[:, :2]).min(axis=1)
    away = np.asarray(cylinder) - after[:, :2]
    bearing = np.arctan2(away[:, 1], away[:, 0]) - after[:, 2]
    return {
        "search": search,
        "speed": mean(forward[:search]),
        "turning": mean(turned[:search]),
        "wall": mean(to_wall[:search] < 72.5),
        "pace": mean(np.hypot(*moved[near].T)),
        "side": mean(np.sin(bearing[near])),
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 6.5. Families
#
# Steps, millimetres and radians cannot be compared, so bring each column to the same scale:
# subtract its mean, and divide by its standard deviation (`ddof=0`, NumPy's ordinary one). How
# different two robots are is then the length of the difference of their rows.
#
# At first each robot is a family of its own. The distance of two families is the *mean* distance of
# a robot of the one and a robot of the other, over all such pairs. Merge the two nearest families,
# again and again, until no two are nearer than the threshold.


# %%
def standardise(table: np.ndarray) -> np.ndarray:
    """Columns with mean 0 and standard deviation 1; where all are equal, 0. Shapes (robots, n)."""
    ### BEGIN SOLUTION task 6.5: bring descriptors to one scale
    deviation = table.std(axis=0)
    alike = np.ptp(table, axis=0) == 0  # their deviation may be a rounding error
    return np.where(alike, 0.0, (table - table.mean(axis=0)) / np.where(alike, 1.0, deviation))
    ### END SOLUTION


def families(table: np.ndarray, threshold: float) -> list[int]:
    """The family of each robot, from a table of descriptors as they are, shape (robots, n).

    Families are numbered from 0, in the order of their first robots.
    """
    ### BEGIN SOLUTION task 6.5: group robots into families
    rows = standardise(table)
    distance = np.linalg.norm(rows[:, None] - rows[None], axis=2)
    groups = [[robot] for robot in range(len(rows))]
    while len(groups) > 1:
        pairs = [(i, j) for j in range(len(groups)) for i in range(j)]
        apart = [distance[np.ix_(groups[i], groups[j])].mean() for i, j in pairs]
        if min(apart) >= threshold:
            break
        i, j = pairs[int(np.argmin(apart))]
        groups[i] += groups.pop(j)
    groups.sort(key=min)
    return [
        next(k for k, group in enumerate(groups) if robot in group) for robot in range(len(rows))
    ]
    ### END SOLUTION


# %% [markdown]
# ## Task 6.6. Without memory
#
# Take the memory away and see what is lost. `forget` empties it after every step: the robot only
# knows the present. `freeze(since)` leaves the robot alone before step `since`, and from that step
# on its memory stays as it was before that step: what it knows then it knows for ever, but it
# learns nothing new.


# %%
def forget(step: int, before: np.ndarray, after: np.ndarray) -> np.ndarray:
    """Remembers nothing: all zeros."""
    ### BEGIN SOLUTION task 6.6: forget everything
    return np.zeros_like(after)
    ### END SOLUTION


def freeze(since: int):
    """A function like `keep`, for which memory stays the same from step `since` on."""
    ### BEGIN SOLUTION task 6.6: freeze the memory
    return lambda step, before, after: after if step < since else before
    ### END SOLUTION


def memory_test(
    brain: dict, starts: np.ndarray, cylinder, seed: int, since: int, maxsteps: int = 500
) -> dict:
    """Mean returns over episodes from all starts: of "keep", "forget" and "freeze" (since).

    The episode from starts[i] has the seed `seed + i`, whatever becomes of the memory.
    """
    ### BEGIN SOLUTION task 6.6: measure what memory is worth
    ways = {"keep": keep, "forget": forget, "freeze": freeze(since)}
    returns = {}
    for name, remember in ways.items():
        episodes = [
            episode(brain, start, cylinder, seed + i, remember, maxsteps)
            for i, start in enumerate(starts)
        ]
        returns[name] = float(np.mean([each["rewards"].sum() for each in episodes]))
    return returns
    ### END SOLUTION


# %% [markdown]
# ## Task 6.7. The same sight, another mind
#
# A robot without memory answers to the same observation always in the same way. Does this robot?


# %%
def reactions(brain: dict, observation: np.ndarray, memories: np.ndarray) -> np.ndarray:
    """The actions, shape (n, 2), to one observation with each memory, shape (n, 2, 10)."""
    ### BEGIN SOLUTION task 6.7: react to the same observation with each memory
    return np.array([think(brain, observation, memory)[0] for memory in memories])
    ### END SOLUTION


# %% [markdown]
# ## The robots
#
# `botschool show 6` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import SavedRobot, experiment_file
    from botschool.course.foraging import draw_mind, draw_trajectories, replications

    robots = replications("results/ex06/runs")
    brains = {name: weights(genotype) for name, genotype in robots.items()}
    cylinder, starts = (200, 150), grid(2, 4)

    recordings, table = {}, []
    for name, brain in brains.items():
        recordings[name] = [episode(brain, s, cylinder, i) for i, s in enumerate(starts)]
        told = [describe(each["poses"], each["rewards"], cylinder) for each in recordings[name]]
        table.append({key: np.mean([each[key] for each in told]) for key in told[0]})
    labels = families(np.array([list(row.values()) for row in table]), threshold=2.5)
    print("robot    family" + "".join(f"{key:>9}" for key in table[0]))
    for name, label, row in zip(robots, labels, table, strict=True):
        print(f"{name:<9}{label:>6}" + "".join(f"{value:9.2f}" for value in row.values()))

    print("\nmean return    keep  forget  freeze")
    for name, brain in brains.items():
        found = memory_test(brain, starts, cylinder, seed=0, since=100)
        print(f"{name:<12}" + "".join(f"{value:8.0f}" for value in found.values()))

    panels, picked = {}, range(0, len(starts), 3)
    for name, brain in list(brains.items())[:3]:
        panels[name] = [recordings[name][i] for i in picked]
        for way, remember in (("forgets", forget), ("frozen", freeze(100))):
            panels[f"{name}, {way}"] = [
                episode(brain, starts[i], cylinder, i, remember) for i in picked
            ]
    draw_trajectories("trajectories.png", panels, cylinder, columns=3)

    nothing = np.zeros(INPUTS)
    for name, brain in list(brains.items())[:3]:
        by_return = sorted(recordings[name], key=lambda each: each["rewards"].sum())
        recording = by_return[len(by_return) // 2]
        answers = reactions(brain, nothing, recording["memories"])
        draw_mind(f"mind_{name.replace(' ', '')}.png", name, recording, answers)
    first = next(iter(robots.values()))
    SavedRobot(experiment_file("discrim.ini"), first).film("forager.mp4", seed=1)
