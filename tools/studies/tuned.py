"""Whether what `botschool rl tune` has found is better than the start of its search.

On seeds that it has not seen; the section `tuned` of docs/chapter.md.

    python tools/studies tuned      searches, trains with and without, writes the section

The options are those of the commands in that page. What is stopped goes on where it stopped: the
search lies in results/tuned, the trainings in data/tuned_cartpole.jsonl.
"""

from __future__ import annotations

import contextlib
import io
import tempfile
import textwrap

import numpy as np
from study import DATA, ROOT, Page, Results, spread

KEPT = DATA / "tuned_cartpole.jsonl"
ALGO, ENV, STEPS = "a2c", "CartPole-v1", 5000
TRIALS, TOGETHER = 24, 3
"""Of the search, and seeds of each."""
SEEDS = range(21, 61)
"""Of the trainings that judge it."""
NEW_EPISODES = 20
SAMPLES = 100_000


def search() -> dict:
    """Search, or go on; return the best hyperparameters."""
    from botschool.rl.parameters import read_settings
    from botschool.rl.tuning import Plan, tune

    options = {"steps": STEPS, "envs": None, "seed": 1, "wrappers": "", "evaluations": 2}
    options |= {"episodes": 10}
    plan = Plan(ALGO, ENV, ROOT / "results" / "tuned", TRIALS, options, TOGETHER)
    tune(plan, lambda line: print(line))
    return read_settings(plan.best)


def returned(seed: int, params: dict) -> dict:
    """Return the mean return of the last model in new episodes."""
    from botschool.rl.training import train
    from botschool.rl.watch import Player

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        options = {"steps": STEPS, "seed": seed, "evaluations": 1, "episodes": 1}
        run = train(ALGO, ENV, folder, params=params, **options)
        player = Player(run.last, seed)
        player.play(NEW_EPISODES)
    return {"new": round(float(np.mean(player.returns)), 2)}


def interval(differences: np.ndarray) -> tuple[float, float]:
    """95 % of the means of resampled differences (bootstrap)."""
    rng = np.random.default_rng(1)
    drawn = rng.choice(differences, (SAMPLES, len(differences)))
    low, high = np.quantile(drawn.mean(axis=1), (0.025, 0.975))
    return float(low), float(high)


def told(results: Results) -> str:
    """What was found, in a paragraph: the last hyperparameters beside the start of the search."""
    best = results.runs[-1]["params"]
    start, tuned = (np.array([run["new"] for run in results.of(params=p)]) for p in ({}, best))
    low, high = interval(tuned - start)
    verdict = "better" if low > 0 else "worse" if high < 0 else "not surely better"
    return (
        f"Trained anew with seeds {SEEDS[0]} to {SEEDS[-1]}, which the search has "
        f"not seen, the last model has in {NEW_EPISODES} new episodes a mean return of "
        f"{spread(tuned)} with the tuned hyperparameters and of {spread(start)} without (mean and "
        f"standard deviation over {len(tuned)} seeds). With {(tuned > start).sum()} of the seeds "
        f"it is better. The mean difference is {np.mean(tuned - start):.1f}, from {low:.1f} to "
        f"{high:.1f} (95 % of a bootstrap over the seeds): the tuned ones are {verdict}."
    )


def pages() -> list[Page]:
    """Return the page, made from what is kept."""
    lines = textwrap.wrap(told(Results(KEPT)), 119, break_long_words=False, break_on_hyphens=False)
    return [Page(ROOT / "docs" / "chapter.md", {"tuned": "\n".join(lines)})]


def main() -> None:
    """See the top of the file."""
    best, results = search(), Results(KEPT)
    for seed in SEEDS:
        for params in ({}, best):
            results.do({"seed": seed, "params": params}, lambda s=seed, p=params: returned(s, p))
    for page in pages():
        page.write()
