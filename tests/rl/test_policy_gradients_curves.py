"""The native learner learns as Stable-Baselines3's PPO does: curves of several seeds."""

import json
from itertools import combinations

import numpy as np
import pytest

from botschool.rl.native import PPO

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("studies")]
SEEDS = range(1, 6)
DOUBT = 0.05


def stable_baselines3(env):
    """Its settings and its curves, which are kept: (seeds, points), NaN before an episode ends."""
    from ppo_compare import COMPARED, DATA, SETTINGS

    if env in COMPARED:
        kept = json.loads((DATA / "ppo.json").read_text(encoding="utf-8"))["data"][env]
        curves = kept["libraries"]["Stable-Baselines3"]["curves"]
    else:
        kept = json.loads((DATA / "sb3_curves.json").read_text(encoding="utf-8"))[env]
        curves = [kept[seed] for seed in sorted(kept)]
    return SETTINGS[env], np.array(curves, dtype=float)


def native(env, given):
    """The same of five trainings of ours."""
    import ppo_compare

    settings = dict(given)
    steps, n_envs, anneal = (settings.pop(k) for k in ("total_timesteps", "n_envs", "anneal"))
    for name in ("learning_rate", "clip_range") if anneal else ():
        settings[name] = f"linear {settings[name]}"
    rows = []
    for seed in SEEDS:
        episodes = []

        def keep(ppo, found, episodes=episodes):
            ended, returns, _ = ppo.episodes
            episodes.extend(zip(ended, returns, strict=True))

        PPO(env, seed, n_envs, **settings).learn(steps, keep)
        rows.append(ppo_compare.curve(np.array(episodes, dtype=float), steps))
    return np.array(rows)


def share_as_far(one, other):
    """Of the ways to deal all curves into two groups, those at least as far apart as these."""
    from ppo_compare import distance

    begun = ~np.isnan(np.concatenate([one, other])).any(axis=0)  # an episode has ended in all
    one, other = one[:, begun], other[:, begun]
    both, n = np.concatenate([one, other]), len(one)
    apart = [
        distance(both[list(group)], np.delete(both, group, axis=0))
        for group in combinations(range(len(both)), n)
    ]
    return np.mean(np.array(apart) >= distance(one, other) - 1e-12)


@pytest.mark.parametrize(
    "env",
    [
        *(pytest.param(f"{name}-v1", marks=pytest.mark.long) for name in ("CartPole", "Pendulum")),
        "Acrobot-v1",
    ],
)
def test_curves_are_those_of_stable_baselines3(env):
    settings, theirs = stable_baselines3(env)
    assert len(theirs) == len(SEEDS)
    mine = native(env, settings)
    print(env, np.nanmean(mine, axis=0).round(1), np.nanmean(theirs, axis=0).round(1))
    assert share_as_far(mine, theirs) > DOUBT
    # and the test can tell: a tenth of the learning rate is another algorithm
    slower = settings | {"learning_rate": settings["learning_rate"] / 10}
    assert share_as_far(native(env, slower), theirs) <= DOUBT
