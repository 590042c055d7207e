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
# # Exercise 14. Training with PPO
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 14` grades
# them, `botschool grade 14.1` one task.

# %%
"""Exercise 14: training with PPO, reading what it logs, and comparing."""

from itertools import combinations
from pathlib import Path

import numpy as np
from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

from botschool.analysis.runs import read_stat
from botschool.rl.folder import RunFolder
from botschool.rl.training import train

# %% [markdown]
# ## Task 14.1. Variations
#
# `run = train("ppo", environment, folder, params={"learning_rate": 0.001}, steps=10_000, seed=3)`
# is `botschool rl train` as a function. It trains an agent in a new folder such as
# `folder/ppo/CartPole-v1_1` and gives that folder: `run.path` is where it is, and
# `run.evaluations().last` the mean return of the last post-evaluation. Hyperparameters that are
# not in `params` have the default of the problem. `evaluations=5, episodes=10` asks for 5
# post-evaluations on the way, of 10 episodes each.


# %%
def train_variations(
    environment: str,
    variations: dict[str, dict],
    seeds: list[int],
    steps: int,
    folder: str,
    evaluations: int = 8,
    episodes: int = 5,
) -> list[dict]:
    """Trains PPO once for each variation and seed, all for the same number of steps.

    variations: name -> the params of that variation. The trainings of a variation lie in a folder
    of its own, folder/name.

    Returns a list with a dict for each training, in any order:
    - "variant": the variation's name, and "seed";
    - "return": the mean return of the last post-evaluation;
    - "folder": the path of the training's folder, as text (`str(run.path)`).
    """
    ### BEGIN SOLUTION task 14.1: train each variation with each seed
    records = []
    for name, params in variations.items():
        for seed in seeds:
            run = train("ppo", environment, Path(folder) / name, params=params, steps=steps,
                        seed=seed, evaluations=evaluations, episodes=episodes)  # fmt: skip
            result = run.evaluations().last
            records.append(
                {"variant": name, "seed": seed, "return": result, "folder": str(run.path)}
            )
    return records
    ### END SOLUTION


# %% [markdown]
# ## Task 14.2. What was logged
#
# The folder of a training holds a file `events.out.tfevents...`, the log. You can read it yourself:
#
# - `log = EventAccumulator(folder, size_guidance={"scalars": 0})`, then `log.Reload()`. Without
#   the 0, which means all, at most 10 000 values of each indicator are kept, and others are
#   dropped at random;
# - `log.Tags()["scalars"]` lists the indicators that are single numbers (others are histograms);
# - `log.Scalars("train/approx_kl")` gives a list of entries with `.step` and `.value`.


# %%
def read_indicators(folder: str) -> dict:
    """All indicators in a training's folder that are single numbers.

    Returns a dict: name -> {"steps": array, "values": array}, both of the same length. Entries
    whose value is NaN are left out: the explained variance is NaN if there is no variance to
    explain. All others are kept, also two of the same step. An indicator of which nothing is left
    stays, with two empty arrays.
    """
    ### BEGIN SOLUTION task 14.2: read the event files
    log = EventAccumulator(folder, size_guidance={"scalars": 0})
    log.Reload()
    indicators = {}
    for name in log.Tags()["scalars"]:
        entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
        indicators[name] = {
            "steps": np.array([entry.step for entry in entries]),
            "values": np.array([entry.value for entry in entries]),
        }
    return indicators
    ### END SOLUTION


# %% [markdown]
# ## Task 14.3. How successful was it?
#
# A training can be quick or slow, and lose again what it had. With the mean returns
# $m_0, m_1, \ldots, m_n$ of the post-evaluations after $s_0, s_1, \ldots, s_n$ steps, the average
# over the whole training is the area under the curve, divided by its width:
#
# $$\bar m = \frac{1}{s_n - s_0} \sum_{i=1}^{n} (s_i - s_{i-1}) \frac{m_{i-1} + m_i}{2}$$


# %%
def success_of(steps: np.ndarray, returns: np.ndarray, goal: float) -> dict:
    """Four measures of the success of a training.

    steps: shape (n,), when it was post-evaluated; returns: shape (n, episodes).

    Returns a dict with
    - "last" and "best": the mean return of the last and of the best post-evaluation;
    - "average": the average above; if there is only one post-evaluation, its mean return;
    - "solved": the steps after which the goal was reached for good: of the first post-evaluation
      from which on all have a mean return of at least the goal, up to the end. None if there is
      none.
    """
    ### BEGIN SOLUTION task 14.3: measure the success
    means = np.mean(returns, axis=1)
    widths = np.diff(steps)
    area = np.sum(widths * (means[:-1] + means[1:]) / 2)
    solved = None
    for when, mean in zip(steps[::-1], means[::-1], strict=True):
        if mean < goal:
            break
        solved = int(when)
    return {
        "last": float(means[-1]),
        "best": float(means.max()),
        "average": float(area / widths.sum()) if len(means) > 1 else float(means[0]),
        "solved": solved,
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 14.4. The table
#
# Each variation gets one row for all its seeds. Repeating a training with the *same* seed gives the
# same numbers again, and counts once.


# %%
def table_of(runs: list[dict], baseline: str) -> list[dict]:
    """A row for each variation, the highest mean first (equal ones in any order).

    runs: dicts with "variant", "seed" and "return", in any order. Of several with the same variant
    and seed only the first one counts.

    Returns a list of dicts with
    - "variant", and "runs": how many count;
    - "mean" of their returns, and "deviation": the standard deviation of a sample, which divides
      by runs - 1. None if there is a single one;
    - "gain": the mean minus that of the variant `baseline`.
    """
    ### BEGIN SOLUTION task 14.4: one row for each variation
    results = {}
    for run in runs:
        results.setdefault(run["variant"], {}).setdefault(run["seed"], run["return"])
    means = {variant: np.mean(list(found.values())) for variant, found in results.items()}
    rows = []
    for variant in sorted(means, key=means.get, reverse=True):
        values = list(results[variant].values())
        rows.append(
            {
                "variant": variant,
                "runs": len(values),
                "mean": float(means[variant]),
                "deviation": float(np.std(values, ddof=1)) if len(values) > 1 else None,
                "gain": float(means[variant] - means[baseline]),
            }
        )
    return rows
    ### END SOLUTION


# %% [markdown]
# ## Task 14.5. Is it more than luck?
#
# One variation has a higher mean than another. Would it have, if they were equally good? Then each
# result might as well have belonged to the other group. So deal all results out to two groups of
# the same sizes, in every possible way, and count how often the means differ by as much as they
# did, or more, in either direction. The share of these ways is the probability of such a
# difference by luck alone; the way in which it really was is one of them. This is an exact
# *permutation test*.


# %%
def chance_of(first: list[float], second: list[float]) -> float:
    """The probability that means differ as much as those of two lists of returns, or more, by luck.

    Numbers of which one is computed as 0.30000000000000004 and the other as 0.3 are equal: count a
    difference also if it is smaller than the real one by no more than 1e-9.
    """
    ### BEGIN SOLUTION task 14.5: deal the results out in every possible way
    together = np.array([*first, *second], dtype=float)
    n, m = len(first), len(second)
    observed = abs(np.mean(first) - np.mean(second))
    ways = np.array(list(combinations(range(n + m), n)))
    totals = together[ways].sum(axis=1)
    differences = abs(totals / n - (together.sum() - totals) / m)
    return float(np.mean(differences >= observed - 1e-9))
    ### END SOLUTION


# %% [markdown]
# ## Task 14.6. Warning signs
#
# A sign names an indicator, whether it is a bad sign if that is `"above"` or `"below"` a limit, and
# the limit. What counts is the mean in the last third of the training. These are rules of thumb; at
# the end you will see how far they can be trusted.

# %%
SIGNS = {
    "moves too far": ("train/approx_kl", "above", 0.03),
    "clips too much": ("train/clip_fraction", "above", 0.3),
    "hardly moves": ("train/approx_kl", "below", 0.0001),
    "critic is blind": ("train/explained_variance", "below", 0.1),
    "has decided": ("train/entropy_loss", "above", -0.2),
}
"""name -> (indicator, "above" or "below", limit). The entropy loss is minus the entropy."""


# %%
def phase_means(steps: np.ndarray, values: np.ndarray, total: int, parts: int = 3) -> list:
    """The mean of an indicator in each of so many equal parts of a training.

    total: the steps of the whole training. Part k (the first one is 0) holds what was logged after
    more than k total / parts steps, up to and with (k + 1) total / parts; the first one also what
    was logged at step 0. NaN does not count. None for a part that holds nothing.
    """
    ### BEGIN SOLUTION task 14.6: average over the parts, and look for signs
    steps, values = np.asarray(steps, dtype=float), np.asarray(values, dtype=float)
    means = []
    for part in range(parts):
        inside = (steps * parts > part * total) & (steps * parts <= (part + 1) * total)
        if part == 0:
            inside |= steps == 0
        these = values[inside & ~np.isnan(values)]
        means.append(float(these.mean()) if len(these) else None)
    return means
    ### END SOLUTION


def warning_signs(indicators: dict, total: int, signs: dict) -> list[str]:
    """The names of the signs that a training shows in its last third, in the order of `signs`.

    indicators: as `read_indicators` gives them; signs: as SIGNS. An indicator that was not logged,
    or not in the last third, gives no sign, and neither does one that equals the limit.
    """
    ### BEGIN SOLUTION task 14.6: average over the parts, and look for signs
    found = []
    for name, (indicator, side, limit) in signs.items():
        if indicator not in indicators:
            continue
        logged = indicators[indicator]
        late = phase_means(logged["steps"], logged["values"], total, 3)[-1]
        if late is not None and (late > limit if side == "above" else late < limit):
            found.append(name)
    return found
    ### END SOLUTION


# %% [markdown]
# ## Task 14.7. Which indicators go with success?
#
# Take one number of each training, such as its mean entropy, and its success. Do both put the
# trainings in the same order? Replace each number by its *rank* (1 for the smallest) and compute
# the correlation of the ranks:
#
# $$\rho = \frac{\sum_i (a_i - \bar a)(b_i - \bar b)}
# {\sqrt{\sum_i (a_i - \bar a)^2 \sum_i (b_i - \bar b)^2}}$$
#
# where $a_i$ and $b_i$ are the ranks of training $i$. Equal numbers share the mean of their ranks:
# 5, 7, 7, 9 have the ranks 1, 2.5, 2.5, 4.
#
# If the learning rate changes both entropy and success, they go together across the variations
# though one says nothing about the other. Among trainings of the *same* variation this cannot
# happen. So subtract from each number the mean of its variation, and look again.


# %%
def rank_correlation(first: np.ndarray, second: np.ndarray) -> float:
    """The correlation of the ranks of two arrays of the same shape (n,).

    0 if all numbers of one of them are equal.
    """
    ### BEGIN SOLUTION task 14.7: correlate the ranks
    deviations = []
    for numbers in (np.asarray(first), np.asarray(second)):
        smaller = (numbers[:, None] > numbers).sum(axis=1)
        equal = (numbers[:, None] == numbers).sum(axis=1)
        ranks = smaller + (equal + 1) / 2
        deviations.append(ranks - ranks.mean())
    a, b = deviations
    below = np.sqrt((a**2).sum() * (b**2).sum())
    return float((a * b).sum() / below) if below > 0 else 0.0
    ### END SOLUTION


def within_variants(numbers: np.ndarray, variants: list[str]) -> np.ndarray:
    """Each number minus the mean of the numbers of its variant, rounded to 9 decimals.

    The rounding is for equal numbers: they shall be equal afterwards too.
    """
    ### BEGIN SOLUTION task 14.7: correlate the ranks
    numbers, names = np.asarray(numbers, dtype=float), np.array(variants)
    means = {name: numbers[names == name].mean() for name in set(variants)}
    return np.round(numbers - np.array([means[name] for name in variants]), 9)
    ### END SOLUTION


# %% [markdown]
# ## Task 14.8. Evolution and PPO at equal steps
#
# Both sides must count all steps alike and show the best post-evaluation so far.
#
# - `read_stat(file)` gives the stat file of a run of evolution as an array of shape
#   (generations, 6). Its first column holds the steps, post-evaluations included, its third one
#   (number 2) the best post-evaluation so far (exercise 4).
# - `RunFolder(folder).evaluations()` gives the post-evaluations of a training: `.steps` of shape
#   (n,), those of the training alone; `.returns` and `.lengths` of shape (n, episodes), the lengths
#   in steps.


# %%
def curve_of(place: str) -> dict:
    """The learning curve of a run of evolution or of a training.

    place: a stat file (its name ends with .npy), or the folder of a training.

    Returns a dict of arrays of shape (n,): "steps", with those of all post-evaluations until then,
    this one included; and "best", the best mean return of a post-evaluation so far.
    """
    ### BEGIN SOLUTION task 14.8: compare at equal steps
    if str(place).endswith(".npy"):
        stat = read_stat(place)
        return {"steps": stat[:, 0], "best": stat[:, 2]}
    found = RunFolder(place).evaluations()
    return {
        "steps": found.steps + found.lengths.sum(axis=1).cumsum(),
        "best": np.maximum.accumulate(found.returns.mean(axis=1)),
    }
    ### END SOLUTION


def at_equal_steps(groups: dict[str, list[dict]], points: int) -> dict:
    """The curves of several groups of runs at the same steps.

    groups: name -> the curves of its runs, as `curve_of` gives them.

    Returns a dict with
    - "steps": shape (points,), evenly spaced (`np.linspace`). The first one is that at which the
      last of all runs has its first value, the last one that at which the first of all runs ends;
    - for each name an array of shape (runs, points): what each run has reached by then, that is
      its last value at or before these steps.
    """
    ### BEGIN SOLUTION task 14.8: compare at equal steps
    curves = [curve for group in groups.values() for curve in group]
    start = max(curve["steps"][0] for curve in curves)
    end = min(curve["steps"][-1] for curve in curves)
    steps = np.linspace(start, end, points)
    found = {"steps": steps}
    for name, group in groups.items():
        reached = []
        for curve in group:
            last = np.searchsorted(curve["steps"], steps, side="right") - 1
            reached.append(np.asarray(curve["best"])[last])
        found[name] = np.array(reached)
    return found
    ### END SOLUTION


# %% [markdown]
# ## Two problems, some variations, and evolution beside them
#
# `botschool show 14` runs this part. Set SEEDS to ten, and change problems, variations and STEPS as
# you like.

# %%
PROBLEMS = {
    "CartPole-v1": {
        "default": {},
        "small learning rate": {"learning_rate": 0.00003},
        "large learning rate": {"learning_rate": 0.03},
        "one epoch": {"n_epochs": 1},
    },
    "Pendulum-v1": {
        "default": {},
        "large learning rate": {"learning_rate": 0.03},
        "one epoch": {"n_epochs": 1},
    },
}
SEEDS = [1, 2, 3]
STEPS = {"CartPole-v1": 16_384, "Pendulum-v1": 60_000}
GOALS = {"CartPole-v1": 475.0, "Pendulum-v1": -200.0}


# %%
def report(title: str, runs: list[dict], logs: list[dict]) -> None:
    """Prints the table of variations, the signs that they show, and what goes with success."""
    total = STEPS[title]
    print(f"\n{title}, {total} steps, {len(SEEDS)} seeds")
    results, signs = {}, {}
    for run, log in zip(runs, logs, strict=True):
        results.setdefault(run["variant"], []).append(run["return"])
        signs.setdefault(run["variant"], []).extend(warning_signs(log, total, SIGNS))
    for row in table_of(runs, "default"):
        name = row["variant"]
        luck = chance_of(results["default"], results[name])
        print(
            f"  {name:22} {row['mean']:7.1f} \u00b1 {row['deviation'] or 0:5.1f}   "
            f"gain {row['gain']:+7.1f}   by luck {luck:.5f}"
        )
        solved = [run["solved"] for run in runs if run["variant"] == name and run["solved"]]
        shown = ", ".join(f"{sign} {signs[name].count(sign)}" for sign in SIGNS)
        print(f"    returns {np.sort(results[name]).round().astype(int).tolist()}")
        print(f"    solved for good: {len(solved)}; signs: {shown}")
    success, variants = [run["return"] for run in runs], [run["variant"] for run in runs]
    print("  rank correlation of the last third with the return: of all, and within variations")
    for name in INDICATORS:
        late = [phase_means(log[name]["steps"], log[name]["values"], total)[-1] for log in logs]
        if None not in late:
            apart = [within_variants(numbers, variants) for numbers in (late, success)]
            of_all, within = rank_correlation(late, success), rank_correlation(*apart)
            print(f"  {name:28} {of_all:+.2f}  {within:+.2f}")


INDICATORS = (
    "rollout/ep_rew_mean",
    "rollout/ep_len_mean",
    "train/policy_gradient_loss",
    "train/value_loss",
    "train/entropy_loss",
    "train/approx_kl",
    "train/clip_fraction",
    "train/explained_variance",
)

if __name__ == "__main__":
    from botschool import config
    from botschool.course import experiment_file
    from botschool.course.rl import draw_indicators, draw_trainings, film_training
    from botschool.evolution.run import Run, evolve

    experiment = config.load(experiment_file("cartpole_openaies.ini"))
    trainings = {}
    for title, variations in PROBLEMS.items():
        runs = train_variations(title, variations, SEEDS, STEPS[title], f"trainings/{title}")
        logs = [read_indicators(run["folder"]) for run in runs]
        for run in runs:
            found = RunFolder(run["folder"]).evaluations()
            run |= success_of(found.steps, found.returns, GOALS[title])
        report(title, runs, logs)
        trainings[title] = runs, logs

    Path("evolution").mkdir(exist_ok=True)
    for seed in SEEDS:
        evolve(Run(experiment, seed), Path("evolution"), steps=30 * STEPS["CartPole-v1"])
    trained = [run for run in trainings["CartPole-v1"][0] if run["variant"] == "default"]
    curves = {
        "PPO": [curve_of(run["folder"]) for run in trained],
        "OpenAI-ES": [curve_of(f"evolution/statS{seed}.npy") for seed in SEEDS],
    }
    together = at_equal_steps(curves, 200)
    print(f"\nbest post-evaluation after {together['steps'][-1]:.0f} steps, all counted")
    for name in curves:
        reached = together[name][:, -1]
        print(f"  {name:10} {reached.mean():6.1f}   {np.round(reached, 1).tolist()}")
    print(f"  by luck    {chance_of(*(together[name][:, -1].tolist() for name in curves)):.3f}")
    draw_indicators("indicators.png", trainings, INDICATORS)
    draw_trainings("success.png", trainings, together, curves)
    for title, (runs, _) in trainings.items():
        best = max(runs, key=lambda run: run["return"])
        print(f"{title}: the best is {best['variant']}, seed {best['seed']}")
        film_training(f"{title}.mp4", best["folder"])
