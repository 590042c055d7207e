"""Whether what `botschool rl tune` has found is better than the start of its search.

On seeds that it has not seen; the block `tuned` of docs/chapter.md.

    python tests/bench/tuned.py tune       the search, into results/tuned (goes on where it stopped)
    python tests/bench/tuned.py measure    trainings with and without, into docs/results/tuned
    python tests/bench/tuned.py page       the block from that file

The options are those of the commands in that page.
"""

from __future__ import annotations

import contextlib
import io
import json
import re
import sys
import tempfile
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).parents[2]
FOLDER = REPOSITORY / "results" / "tuned"
DATA = REPOSITORY / "docs" / "results" / "tuned" / "cartpole.json"
PAGE = REPOSITORY / "docs" / "chapter.md"

ALGO, ENV, STEPS = "a2c", "CartPole-v1", 5000
TRIALS = 12
SEEDS = range(21, 61)
FIRST = 20
"""They were all at first; as they left it open, the others came to them."""
NEW_EPISODES = 20
SAMPLES = 100_000


def tune() -> None:
    """Searches, or goes on."""
    from botschool.rl.tuning import Plan, tune

    options = {"steps": STEPS, "envs": None, "seed": 1, "wrappers": "", "evaluations": 2}
    tune(Plan(ALGO, ENV, FOLDER, TRIALS, options | {"episodes": 10}), lambda line: print(line))


def measure() -> None:
    """Trains with each seed as the search began and as it ended; goes on where it stopped."""
    from botschool.output import save_bytes
    from botschool.rl.parameters import read_settings
    from botschool.rl.tuning import Plan

    best = read_settings(Plan(ALGO, ENV, FOLDER, TRIALS, {}).best)
    measured = json.loads(DATA.read_text(encoding="utf-8")) if DATA.exists() else {"runs": []}
    rows = measured["runs"] if measured.get("tuned") == best else []
    for seed in sorted(set(SEEDS) - {row["seed"] for row in rows}):
        rows.append({"seed": seed, "start": returned(seed, {}), "tuned": returned(seed, best)})
        print(rows[-1], flush=True)
        save_bytes(DATA, (json.dumps({"tuned": best, "runs": rows}, indent=1) + "\n").encode())


def returned(seed: int, params: dict) -> float:
    """Mean return of the last model in new episodes."""
    from botschool.rl.training import train
    from botschool.rl.watch import Player

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        run = train(
            *(ALGO, ENV, folder), params=params, steps=STEPS, seed=seed, evaluations=1, episodes=1
        )
        player = Player(run.last, seed)
        player.play(NEW_EPISODES)
    return round(float(np.mean(player.returns)), 2)


def interval(differences: np.ndarray) -> tuple[float, float]:
    """95 % of the means of resampled differences (bootstrap)."""
    rng = np.random.default_rng(1)
    drawn = rng.choice(differences, (SAMPLES, len(differences)))
    low, high = np.quantile(drawn.mean(axis=1), (0.025, 0.975))
    return float(low), float(high)


def text(measured: dict) -> str:
    """What was found, in a paragraph."""
    runs = measured["runs"]
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
        f"tuned ones are {verdict}. The first {FIRST} seeds, with "
        f"{difference((tuned - start)[:FIRST])}, had left that open; the {len(runs) - FIRST} that "
        f"were added have {difference((tuned - start)[FIRST:])}."
    )


def difference(values: np.ndarray) -> str:
    """Their mean and its interval."""
    low, high = interval(values)
    return f"{values.mean():.1f}, from {low:.1f} to {high:.1f}"


def filled(page: str, measured: dict) -> str:
    """The page with its block made from what was measured."""
    lines = "\n".join(wrapped(text(measured)))
    return re.sub(r"(<!-- tuned -->\n).*?(<!-- end -->)", rf"\g<1>{lines}\n\2", page, flags=re.S)


def wrapped(paragraph: str) -> list[str]:
    """Its lines, as long as the page's."""
    import textwrap

    return textwrap.wrap(paragraph, 119, break_long_words=False, break_on_hyphens=False)


def page() -> None:
    """Writes the block."""
    measured = json.loads(DATA.read_text(encoding="utf-8"))
    PAGE.write_text(filled(PAGE.read_text(encoding="utf-8"), measured), encoding="utf-8")


if __name__ == "__main__":
    {"tune": tune, "measure": measure, "page": page}[sys.argv[1]]()
