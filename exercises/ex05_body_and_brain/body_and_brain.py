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
# # Exercise 5. Body and brain
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 5` grades
# them, `botschool grade 5.1` one task.

# %%
"""Exercise 5: walkers whose body and brain evolve together."""

from pathlib import Path

import numpy as np

from botschool import config
from botschool.course import SavedRobot
from botschool.evolution.run import Run, evolve

SEGMENTS = 11
"""The torso and ten more, in a chain."""
JOINTS = 10
BODY = 64
"""Parameters of a body."""
OBSERVATIONS = 35

# %% [markdown]
# ## Task 5.1. Sizes
#
# Evolution may make the 64 numbers $p$ as large as it likes, but a segment must neither vanish nor
# grow without end. For lengths (in metres) and thicknesses the function
#
# $$\text{length} = 0.8\,(1 + 0.9 \tanh p) \qquad \text{thickness} = 0.2\,(1 + 0.9 \tanh p)$$
#
# keeps them within limits: a segment is at least a tenth as long as the nominal 0.8 m of $p = 0$,
# and less than twice as long. The density (kilograms per square metre, as the world is flat) varies
# less: $5 + 0.8 \tanh p$. The mass of a segment is length x thickness x density.
#
# The numbers come in this order:
#
# | places | what |
# |---|---|
# | 0 to 21 | length of segment 0 (the torso), thickness of segment 0, length of segment 1, ... |
# | 22 to 41 | one limit of joint 0, the other limit of joint 0, one limit of joint 1, ... |
# | 42 to 52 | default angles of the 11 segments |
# | 53 to 63 | densities of the 11 segments |


# %%
def sizes(parameters: np.ndarray) -> dict:
    """Return the sizes of the segments, from the 64 parameters of a body, which stay as they are.

    Returns a dict with "lengths" and "thicknesses" (metres) and "masses" (kg), arrays of shape
    (11,).
    """
    raise NotImplementedError("task 5.1: decode the sizes")


# %% [markdown]
# ## Task 5.2. Angles
#
# For angles the number is cut off at -1 and at 1 (`np.clip(p, -1, 1)`), and then scaled. The
# *default angle* of a segment is
#
# $$\text{angle} = \tfrac{3\pi}{4}\, \mathrm{clip}(p, -1, 1)$$
#
# For the torso it is the angle against the ground, for each other segment the angle against the
# segment before, counter-clockwise positive. Around it the joint moves between two limits, each
#
# $$\text{limit} = \tfrac{\pi}{2}\, \mathrm{clip}(p, -1, 1)$$
#
# Evolution does not know which of the two is the lower one, so the smaller one is.


# %%
def joints(parameters: np.ndarray) -> dict:
    """Return the angles of a body in radians, from its 64 parameters, which stay as they are.

    Returns a dict with "angles", the default angles of the 11 segments, shape (11,), and "lower"
    and "upper", the limits of the 10 joints around the default angle, shape (10,).
    """
    raise NotImplementedError("task 5.2: decode the angles")


# %% [markdown]
# ## Task 5.3. The shape at rest
#
# Let every joint be at its default angle. Where is each segment?
#
# - **Headings.** As each angle is counted from the segment before, the heading of a segment
#   against the ground is the sum of all default angles up to its own (`np.cumsum`).
# - **Ends.** A segment of length $l$ and heading $\alpha$ that begins at $(x, y)$ ends at
#   $(x + l\cos\alpha,\; y + l\sin\alpha)$, and there the next one begins. The torso begins at
#   (0, 0).
# - **Corners.** The line from beginning to end is the middle of a rectangle as thick as the
#   segment. The direction across it is $(-\sin\alpha, \cos\alpha)$, the heading turned left by a
#   right angle. So each corner is the beginning or the end, plus or minus half the thickness times
#   this direction.
#
# We want the corners of a segment in the order: beginning right, end right, end left, beginning
# left, as you would draw them, looking along the heading.


# %%
def outline(parameters: np.ndarray) -> np.ndarray:
    """Return the corners (x, y) of all segments at rest, in metres; shape (11, 4, 2).

    The torso begins at (0, 0). The corners of a segment are, looking along it: beginning right,
    end right, end left, beginning left.
    """
    raise NotImplementedError("task 5.3: find the corners")


# %% [markdown]
# ## Task 5.4. A body in five numbers
#
# To compare bodies we want five numbers instead of 64.


# %%
def describe(parameters: np.ndarray) -> dict:
    """Describe a body. Returns a dict of floats:

    - "length": the lengths of all segments together, in metres;
    - "mass": all masses together, in kg;
    - "width" and "height": how far the corners of the outline reach from left to right and from
      bottom to top at rest, in metres;
    - "freedom": how far a joint can move from its lower to its upper limit, in radians, as the mean
      over the 10 joints.
    """
    raise NotImplementedError("task 5.4: describe the body")


# %% [markdown]
# ## Task 5.5. Evolve walkers
#
# As in exercise 4: `config.load(file)`, `Run(experiment, seed)`, and `evolve(run, folder, steps)`
# with a folder that exists. Afterwards `run.record.bestg` is the genotype with the best
# post-evaluated fitness, as an array.


# %%
def evolve_walkers(
    experiment_file: str, seeds: list[int], folder: str, steps: int | None = None
) -> np.ndarray:
    """Run the experiment once with each seed and leave the files of all runs in the folder.

    Make the folder, and those above it, if they do not exist. Returns the genotype with the best
    post-evaluated fitness of each run, one row for each seed, in the order given.
    """
    raise NotImplementedError("task 5.5: run the replications")


# %% [markdown]
# ## Task 5.6. Give a brain another body
#
# A saved genotype holds, one after another:
#
# 1. the parameters of the network (their number depends on the hidden neurons);
# 2. the 64 parameters of the body;
# 3. 35 means and 35 standard deviations, by which the observations are normalised.
#
# The last 70 numbers tell the network what is usual among its observations. It has learnt to read
# them in that form, so they belong to the brain.


# %%
def body_of(genotype: np.ndarray) -> np.ndarray:
    """Return the parameters of the body, shape (64,), of a saved genotype."""
    raise NotImplementedError("task 5.6: cut out the body")


def transplant(brain: np.ndarray, body: np.ndarray) -> np.ndarray:
    """Return a new saved genotype: the brain of one saved genotype, the body of another.

    All three have the same shape. The two that are given are not changed.
    """
    raise NotImplementedError("task 5.6: put brain and body together")


# %% [markdown]
# ## Task 5.7. The co-adaptation matrix
#
# With $n$ walkers this makes a table of $n$ rows, one for each brain, and $n$ columns, one for each
# body; on its diagonal are the walkers as they evolved. `SavedRobot(experiment_file,
# genotype).evaluate(seed, episodes)` returns the return of each episode, as in exercise 4. Use the
# same seed for all, so that all walk over the same ground.


# %%
def cross_evaluate(
    experiment_file: str, walkers: np.ndarray, seed: int, episodes: int
) -> np.ndarray:
    """Return the mean return of each brain in each body; shape (n, n).

    walkers has one saved genotype in each row. Row i, column j of the answer is the mean over the
    episodes of the brain of walker i in the body of walker j. The walkers stay as they are.
    """
    raise NotImplementedError("task 5.7: try every brain in every body")


# %% [markdown]
# ## Task 5.8. What is lost
#
# If any brain could drive any body, all numbers in a column would be alike. If brain and body are
# co-adapted, the diagonal stands out.


# %%
def loss(matrix: np.ndarray) -> dict:
    """Measure what is lost when brains and bodies are swapped.

    matrix has shape (n, n), n at least 2, and stays as it is.

    Returns a dict with
    - "own": the mean of the diagonal, and "foreign": the mean of all other places;
    - "brains": for each brain, its return in its own body minus its mean return in the others,
      shape (n,);
    - "bodies": for each body, its return with its own brain minus its mean return with the others,
      shape (n,);
    - "at home": how many brains do better in their own body than in each of the others, an int.
    """
    raise NotImplementedError("task 5.8: measure the loss")


# %% [markdown]
# ## The pictures
#
# `botschool show 5` runs this part.

# %%
if __name__ == "__main__":
    from botschool.analysis.bodies import draw_matrix, draw_walkers
    from botschool.course import experiment_file, genotype_file

    def portrait(genotype, title):
        body = body_of(genotype)
        told = describe(body)
        print(title, "  ".join(f"{name} {value:.2f}" for name, value in told.items()))
        angles = joints(body)
        return {"title": title, "outline": outline(body), **angles}

    quick = experiment_file("planarbodybrain.ini")
    (mine,) = evolve_walkers(quick, [1], "runs", steps=2_000_000)
    draw_walkers("my_walker.png", [portrait(mine, "my walker")])
    SavedRobot(quick, mine).film("my_walker.mp4", seed=2_000_000)

    long = experiment_file("bodybrain.ini")
    walkers = np.array([np.load(genotype_file(f"bodybrainS{seed}.npy")) for seed in (1, 2, 3)])
    draw_walkers("walkers.png", [portrait(w, f"walker {i + 1}") for i, w in enumerate(walkers)])
    matrix = cross_evaluate(long, walkers, seed=2_000_000, episodes=5)
    draw_matrix("matrix.png", matrix)
    for name, value in loss(matrix).items():
        print(f"{name:>8}: {np.round(value, 1)}")
    for i, walker in enumerate(walkers):
        SavedRobot(long, walker).film(f"walker{i + 1}.mp4", seed=2_000_000)
