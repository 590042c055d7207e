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
# # Exercise 15. The master tournament
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 15` grades
# them, `botschool grade 15.1` one task.
#
# Ready-made:
#
# - `robot(genotype)` gives the network of one predator or prey, at the start of an episode. Write
#   what it senses (24 numbers) into `network.observation`; `network.step()` returns what its two
#   wheels are to do;
# - `play(predators, prey, pairs, maxsteps)` plays many chases at once, and gives the predator's
#   fitness in each. A pair is the row of a predator and the row of a prey.

# %%
"""Exercise 15: predators and prey of all generations meet. Who has made progress?"""

import numpy as np

from botschool import arena as arenas
from botschool.course.coevolution import play, robot

# %% [markdown]
# ## Task 15.1. A chase, recorded
#
# `arenas.make("predprey", max_steps=2000)` makes the arena with both robots, the predator first:
#
# - `arena.reset(seed)` starts an episode. Chance plays no part in this arena: all chases of the
#   same two robots are alike, whatever the seed;
# - `arena.observation` has 48 numbers, those of the predator, then those of the prey;
# - `arena.action = ...` takes 4 numbers: left and right wheel of the predator, then of the prey;
# - `arena.step()` moves both and returns the predator's reward. It is 0 except for the step in
#   which it catches the prey: then it is $1 - t / T$, where $t$ steps out of $T$ (`max_steps`)
#   have been done. So the sum of the rewards is the predator's *fitness*, from 0 to 1;
# - `arena.robots` are the poses: a row x, y, heading for each robot, in mm and rad;
# - `arena.done` tells that the episode has ended, `arena.terminated` that it has ended because the
#   prey was caught.
#
# Both robots decide before either of them moves. All arrays of the arena change with every step:
# what you want to keep, you must copy.


# %%
def chase(predator: np.ndarray, prey: np.ndarray, maxsteps: int = 2000) -> dict:
    """One episode of a predator and a prey, given as genotypes, shapes (4977,).

    Returns a dict with
    - "poses", shape (T + 1, 2, 3): of both robots, at the start and after each of the T steps;
    - "caught": whether the predator has caught the prey, also in the very last step;
    - "fitness": the predator's: 1 - T / maxsteps if it catches the prey, else 0.
    """
    raise NotImplementedError("task 15.1: record a chase")


# %% [markdown]
# ## Task 15.2. Everybody meets everybody
#
# One chase after another in Python would take long, so write down the pairs and let `play` do all
# of them: with two predators and three prey these are (0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1,
# 2).


# %%
def tournament(predators: list, prey: list, maxsteps: int = 2000) -> np.ndarray:
    """The predator's fitness in all chases, shape (G, n, H, m).

    predators: G arrays, one for each generation, of n individuals each, shape (n, 4977); prey: H
    arrays of the shape (m, 4977). Entry [g, i, h, j] is the fitness of predator i of generation g
    against prey j of generation h.
    """
    raise NotImplementedError("task 15.2: play all pairs")


# %% [markdown]
# ## Task 15.3. The master matrix
#
# Take the mean over individuals of both sides: one number for two generations. For each side there
# is a matrix, in which a *row* is one of its own generations and a *column* a generation of its
# competitors. What the predator gets, the prey lacks of 1.


# %%
def master(table: np.ndarray) -> dict:
    """The mean fitness of generations against generations, from what `tournament` returns.

    table: shape (G, n, H, m). Returns a dict with
    - "predators", shape (G, H): row g, column h is the mean fitness of the predators of generation
      g against the prey of generation h;
    - "prey", shape (H, G): row h, column g is the mean fitness of the prey of generation h against
      the predators of generation g.
    """
    raise NotImplementedError("task 15.3: average over individuals")


# %% [markdown]
# From here on, a *matrix* is that of one side, with as many rows as columns, and its generations
# are numbered 0, 1, ..., G - 1 in the order of time. $f(g, k)$ is the entry in row $g$ and column
# $k$: how well generation $g$ does against the competitors of generation $k$.
#
# ## Task 15.4. Ancient, present and future competitors
#
# For each generation, average separately over the competitors of all generations before its own
# (*ancient* ones), of its own (*present* ones) and of all generations after its own (*future*
# ones). The first generation has no ancient competitors, the last one no future ones.


# %%
def profile(matrix: np.ndarray) -> dict:
    """The mean fitness of generations against competitors of other times.

    matrix: shape (G, G), G >= 2. Returns a dict with
    - "ancient", shape (G - 1,): of generations 1 to G - 1;
    - "present", shape (G,);
    - "future", shape (G - 1,): of generations 0 to G - 2.
    """
    raise NotImplementedError("task 15.4: average over ancient, present and future competitors")


# %% [markdown]
# ## Task 15.5. Progress, or running in circles?
#
# Compare each generation with the one before it, its *predecessor*, against the very same
# competitors. Against the ancient ones, this tells of **historical progress**; against those of all
# generations, of **global progress**:
#
# $$a_g = \frac{1}{g} \sum_{k < g} \left( f(g, k) - f(g-1, k) \right), \qquad
# b_g = \frac{1}{G} \sum_{k} \left( f(g, k) - f(g-1, k) \right), \qquad g = 1, \ldots, G - 1$$
#
# A mean may come from a single competitor. So count as well: look at all generations $g \geq 1$
# with all their ancient competitors $k < g$. In which *share* of these cases does $g$ do better
# than its predecessor? A case in which both do equally well counts half.
#
# For circles let two generations $a$ and $b$ play a return match: the predators of $a$ against the
# prey of $b$, and the predators of $b$ against the prey of $a$. If $f(a, b) > f(b, a)$ in the
# *predators'* matrix, then $a$ has won. Three generations are a *cycle* if each of them has won one
# match and lost the other.


# %%
def progress(matrix: np.ndarray) -> dict:
    """Progress from each generation to the next one, of the side whose matrix it is.

    matrix: shape (G, G), G >= 2. Returns a dict with
    - "historical" and "global": the $a_g$ and the $b_g$ above, shapes (G - 1,);
    - "share": of the cases with an ancient competitor, those in which a generation does better
      than its predecessor.
    """
    raise NotImplementedError("task 15.5: compare each generation with its predecessor")


def cycles(matrix: np.ndarray) -> float:
    """The share of all groups of three generations that are cycles; 0 if there is no such group.

    matrix: of the predators, shape (G, G).
    """
    raise NotImplementedError("task 15.5: look for cycles")


# %% [markdown]
# ## Task 15.6. What contemporary fitness hides
#
# A run shows how its robots do against those of the same time. From the first generation to
# generation $g$ this has changed by
#
# $$f(g, g) - f(0, 0)$$
#
# Two things have happened in between: the side itself has changed, and so have its competitors. To
# see one of them, hold the other one still. The side's *own* part is what generation $g$ gains on
# the first one against the very same competitors, the mean over those of all generations. The part
# of the *others* is what competitors of generation $g$ leave to the side, compared with the first
# ones, the mean over all generations of the side:
#
# $$\text{own} = \frac{1}{G} \sum_k \left( f(g, k) - f(0, k) \right), \qquad
# \text{others} = \frac{1}{G} \sum_k \left( f(k, g) - f(k, 0) \right)$$
#
# Both parts together are the change only if a gain is worth the same against all competitors. Why
# not go from each generation to the next and add up what it gains on those of its time? In a circle
# each generation beats the last one. Such a sum would grow for ever, though nobody becomes better.


# %%
def red_queen(matrix: np.ndarray) -> dict:
    """The change of the contemporary fitness since the first generation, and its causes.

    matrix: shape (G, G), G >= 2. Returns a dict of "change", "own" and "others", each of the shape
    (G - 1,), for generations 1 to G - 1.
    """
    raise NotImplementedError("task 15.6: what both sides have done to contemporary fitness")


# %% [markdown]
# ## Task 15.7. How sure is it?
#
# For each resample
#
# 1. draw n predators of each generation, with replacement:
#    `rng.integers(n, size=(G, n))`, whose row g are the individuals of generation g;
# 2. then draw m prey of each generation: `rng.integers(m, size=(H, m))`;
# 3. make the table of those who were drawn: entry [g, i, h, j] is that of the i-th predator drawn
#    for generation g and the j-th prey drawn for generation h;
# 4. measure it.
#
# 95 % of the measures lie between the 2.5 % and the 97.5 % quantile (`np.quantile`).


# %%
def interval(table: np.ndarray, measure, rng: np.random.Generator, resamples: int = 300) -> tuple:
    """The 95 % interval of a measure, as (low, high).

    table: shape (G, n, H, m); measure: a function that gives a number for such a table.
    """
    raise NotImplementedError("task 15.7: draw individuals anew")


# %% [markdown]
# ## Task 15.8. How do they behave?
#
# Step t goes from poses[t] to poses[t + 1] and lasts a tenth of a second. Of each robot, the
# predator first:
#
# - "speed": how far it moves, in mm per second;
# - "turning": by how much its heading changes, the short way around and without its sign, in rad
#   per second;
# - "backwards": the share of steps in which it drives backwards: its movement along the heading at
#   the beginning of the step, $\Delta x \cos\theta + \Delta y \sin\theta$, is below 0;
# - "facing": the share of steps that begin with the other robot's centre less than 45 degrees to
#   the left or right of its heading;
# - "wall": the share of steps that begin with its centre nearer than 300 mm to a wall. The arena
#   is 3000 mm wide and high, and 0 is at its lower left corner.
#
# Of both together: "distance", the mean distance of their centres at the beginning of the steps.


# %%
def describe(poses: np.ndarray) -> dict:
    """The behaviour of both robots in a chase, from its poses, shape (T + 1, 2, 3), T >= 1.

    Returns a dict of means over the T steps: "speed", "turning", "backwards", "facing" and "wall",
    each of the shape (2,), and "distance", a number.
    """
    raise NotImplementedError("task 15.8: describe a chase")


# %% [markdown]
# ## The tournament
#
# `botschool show 15` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course.coevolution import (
        draw_chases,
        draw_red_queen,
        draw_tournament,
        load_run,
        replay_chases,
    )

    run = load_run("results/ex15/run")
    generations = list(run)
    populations = {
        "predators": [predators for predators, _ in run.values()],
        "prey": [prey for _, prey in run.values()],
    }
    table = tournament(**populations)
    matrices = master(table)

    for side in matrices:
        found = progress(matrices[side])
        print(f"\n{side}: better than their predecessors in {found['share']:.0%} of the cases with "
              "an ancient competitor")  # fmt: skip
        for kind in ("historical", "global"):

            def summed(resample, side=side, kind=kind):
                return progress(master(resample)[side])[kind].sum()

            low, high = interval(table, summed, np.random.default_rng(15))
            print(f"  {kind} progress, all generations together: {found[kind].sum():+.2f} "
                  f"(95 % interval {low:+.2f} to {high:+.2f})")  # fmt: skip
    print(f"\ncycles: {cycles(matrices['predators']):.0%} of all groups of three generations")

    stages = sorted({generations[k] for k in (0, len(generations) // 2, -1)})
    print(
        "\nthe best predator meets the best prey of its time, the second best the second best, ..."
    )
    print(
        "generation  caught   steps  distance  side         speed  turning  backwards  facing  wall"
    )
    for stage in stages:
        chases = [chase(*pair) for pair in zip(*run[stage], strict=True)]
        told = [describe(each["poses"]) for each in chases]
        mean = {key: np.mean([each[key] for each in told], axis=0) for key in told[0]}
        caught = np.mean([each["caught"] for each in chases])
        steps = np.mean([len(each["poses"]) - 1 for each in chases])
        shown = f"{stage:10}{caught:8.0%}{steps:8.0f}{mean['distance']:10.0f}"
        for k, side in enumerate(matrices):
            print(f"{shown:36}  {side:<10}{mean['speed'][k]:8.0f}{mean['turning'][k]:9.2f}"
                  f"{mean['backwards'][k]:11.0%}{mean['facing'][k]:8.0%}"
                  f"{mean['wall'][k]:6.0%}")  # fmt: skip
            shown = ""

    profiles = {side: profile(matrix) for side, matrix in matrices.items()}
    draw_tournament("tournament.png", matrices, profiles, generations)
    parts = {side: red_queen(matrix) for side, matrix in matrices.items()}
    draw_red_queen("red_queen.png", parts, generations)
    draw_chases(
        "chases.png",
        {(a, b): chase(run[a][0][0], run[b][1][0]) for a in stages for b in stages},
    )
    replay_chases("chases.html", {stage: (run[stage][0][0], run[stage][1][0]) for stage in stages})
