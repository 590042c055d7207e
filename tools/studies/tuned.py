"""Whether what `botschool rl tune` has found is better than the start of its search.

On seeds that it has not seen; the blocks `tuned` of docs/chapter.md.

    python tools/studies tuned tune NAME       a search, or the rest of it, into results/tuned
    python tools/studies tuned measure NAME    trainings with and without, into tools/studies/data
    python tools/studies tuned page            the blocks from these files

The options are those of the commands in that page.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).parents[2]
FOLDER = REPOSITORY / "results" / "tuned"
PAGE = REPOSITORY / "docs" / "chapter.md"
TRIALS, TOGETHER = 24, 3
"""Of a search, and seeds of each."""
NEW_EPISODES = 20
SAMPLES = 100_000


@dataclass(frozen=True)
class Search:
    """A search, and the seeds of the trainings that judge it."""

    algo: str
    env: str
    steps: int
    seeds: range

    @property
    def data(self) -> Path:
        """What was measured."""
        name = self.env.partition("-")[0].lower()
        return Path(__file__).parent / "data" / f"tuned_{name}.json"


SEARCHES = {
    "cartpole": Search("a2c", "CartPole-v1", 5000, range(21, 61)),
}


def tune(name: str) -> None:
    """Searches, or goes on."""
    from botschool.rl.tuning import Plan, tune

    search = SEARCHES[name]
    options = {"steps": search.steps, "envs": None, "seed": 1, "wrappers": "", "evaluations": 2}
    options |= {"episodes": 10}
    plan = Plan(search.algo, search.env, FOLDER, TRIALS, options, TOGETHER)
    tune(plan, lambda line: print(line))


def measure(name: str) -> None:
    """Trains with each seed as the search began and as it ended; goes on where it stopped."""
    from botschool.output import save_bytes
    from botschool.rl.parameters import read_settings
    from botschool.rl.tuning import Plan

    search = SEARCHES[name]
    best = read_settings(Plan(search.algo, search.env, FOLDER, TRIALS, {}).best)
    found = search.data.exists()
    measured = json.loads(search.data.read_text(encoding="utf-8")) if found else {"runs": []}
    rows = measured["runs"] if measured.get("tuned") == best else []
    starts = {row["seed"]: row["start"] for row in measured["runs"]}
    for seed in sorted(set(search.seeds) - {row["seed"] for row in rows}):
        start = starts.get(seed) or returned(search, seed, {})
        tuned = returned(search, seed, best)
        rows.append({"seed": seed, "start": start, "tuned": tuned})
        print(rows[-1], flush=True)
        text = json.dumps({"tuned": best, "runs": rows}, indent=1) + "\n"
        save_bytes(search.data, text.encode())


def returned(search: Search, seed: int, params: dict) -> float:
    """Mean return of the last model in new episodes."""
    from botschool.rl.training import train
    from botschool.rl.watch import Player

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        options = {"steps": search.steps, "seed": seed, "evaluations": 1, "episodes": 1}
        run = train(search.algo, search.env, folder, params=params, **options)
        player = Player(run.last, seed)
        player.play(NEW_EPISODES)
    return round(float(np.mean(player.returns)), 2)


def interval(differences: np.ndarray) -> tuple[float, float]:
    """95 % of the means of resampled differences (bootstrap)."""
    rng = np.random.default_rng(1)
    drawn = rng.choice(differences, (SAMPLES, len(differences)))
    low, high = np.quantile(drawn.mean(axis=1), (0.025, 0.975))
    return float(low), float(high)


def text(search: Search) -> str:
    """What was found, in a paragraph."""
    runs = json.loads(search.data.read_text(encoding="utf-8"))["runs"]
    start, tuned = (np.array([run[name] for run in runs]) for name in ("start", "tuned"))
    low, high = interval(tuned - start)
    verdict = "better" if low > 0 else "worse" if high < 0 else "not surely better"
    return (
        f"Trained anew with seeds {runs[0]['seed']} to {runs[-1]['seed']}, which the search has "
        f"not seen, the last model has in {NEW_EPISODES} new episodes a mean return of "
        f"{tuned.mean():.1f} +- {tuned.std(ddof=1):.1f} with the tuned hyperparameters and of "
        f"{start.mean():.1f} +- {start.std(ddof=1):.1f} without (mean and standard deviation over "
        f"{len(runs)} seeds). With {(tuned > start).sum()} of the seeds it is better. The mean "
        f"difference is {difference(tuned - start)} (95 % of a bootstrap over the seeds): the "
        f"tuned ones are {verdict}."
    )


def difference(values: np.ndarray) -> str:
    """Their mean and its interval."""
    low, high = interval(values)
    return f"{values.mean():.1f}, from {low:.1f} to {high:.1f}"


def filled(page: str) -> str:
    """The page with its blocks made from what was measured."""
    for name, search in SEARCHES.items():
        lines = "\n".join(wrapped(text(search)))
        block = rf"(<!-- tuned {name} -->\n).*?(<!-- end -->)"
        page = re.sub(block, rf"\g<1>{lines}\n\2", page, flags=re.S)
    return page


def wrapped(paragraph: str) -> list[str]:
    """Its lines, as long as the page's."""
    import textwrap

    return textwrap.wrap(paragraph, 119, break_long_words=False, break_on_hyphens=False)


def page() -> None:
    """Writes the blocks."""
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8")), encoding="utf-8")


def main() -> None:
    {"tune": tune, "measure": measure, "page": page}[sys.argv[1]](*sys.argv[2:])
