"""What `botschool rl train` reaches with its defaults, PPO: a part of results.py."""

from __future__ import annotations

import contextlib
import io
import tempfile
import time
from functools import partial

from study import side_by_side

PROBLEMS = {"CartPole-v1": 500, "Pendulum-v1": -200, "Acrobot-v1": -85}
"""With the mean return that the defaults should reach."""
NEW_EPISODES = 100


def train(problem: str, steps: int | None, seed: int) -> dict:
    """One training: seconds, post-evaluations (steps count theirs too), models in new episodes."""
    from botschool.rl.training import train
    from botschool.rl.watch import Player

    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
        start = time.process_time()
        run = train("ppo", problem, folder, seed=seed, steps=steps)
        seconds = time.process_time() - start
        evaluations = run.evaluations()
        means = {}
        for name, model in (("best", run.best), ("last", run.last)):
            player = Player(model, seed)
            player.play(NEW_EPISODES)
            means[name] = round(sum(player.returns) / NEW_EPISODES, 2)
    return means | {
        "seed": seed,
        "seconds": round(seconds, 1),
        "steps": (evaluations.steps + evaluations.lengths.sum(axis=1).cumsum()).tolist(),
        "curve": [round(float(each), 1) for each in evaluations.returns.mean(axis=1)],
    }


def trained(seeds: int, steps: int | None = None) -> dict:
    """{problem: [what `train` gives, for seeds 1 to that]}."""
    found: dict = {}
    for problem in PROBLEMS:
        found[problem] = side_by_side(partial(train, problem, steps), range(1, seeds + 1))
        print(problem, *(each["last"] for each in found[problem]), flush=True)
    return found
