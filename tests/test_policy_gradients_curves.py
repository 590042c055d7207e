"""The native learner learns as Stable-Baselines3's PPO does: curves of several seeds."""

import sys
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest

from botschool.rl.native import PPO

sys.path.insert(0, str(Path(__file__).parents[1] / "tools/studies"))

import ppo_compare

SETTINGS = {
    "CartPole-v1": (
        30_000, 16,
        {"n_steps": 32, "batch_size": 256, "n_epochs": 10, "gamma": 0.98, "gae_lambda": 0.8,
         "learning_rate": 0.001},
    ),
    "Pendulum-v1": (
        60_000, 8,
        {"n_steps": 256, "batch_size": 128, "n_epochs": 10, "gamma": 0.9, "gae_lambda": 0.95,
         "learning_rate": 0.001},
    ),
    "Acrobot-v1": (
        60_000, 16,
        {"n_steps": 128, "batch_size": 256, "n_epochs": 4, "gamma": 0.99, "gae_lambda": 0.94,
         "learning_rate": 0.001},
    ),
}  # fmt: skip
"""Steps, environments and hyperparameters."""
SEEDS = range(1, 6)
DOUBT = 0.05


def native(env, seed):
    steps, n_envs, options = SETTINGS[env]
    episodes = []

    def keep(ppo, found):
        ended, returns, _ = ppo.episodes
        episodes.extend(zip(ended, returns, strict=True))

    PPO(env, seed, n_envs, **options).learn(steps, keep)
    return ppo_compare.curve(np.array(episodes, dtype=float), steps)


def stable_baselines3(env, seed):
    steps, n_envs, options = SETTINGS[env]
    given = {"total_timesteps": steps, "n_envs": n_envs, "anneal": 0, **options}
    ppo_compare.SETTINGS, before = {env: given}, ppo_compare.SETTINGS
    try:
        episodes, _ = ppo_compare.stable_baselines3(env, seed)
    finally:
        ppo_compare.SETTINGS = before
    return ppo_compare.curve(episodes, steps)


def share_as_far(one, other):
    """Of the ways to deal all curves into two groups, those at least as far apart as these."""
    begun = ~np.isnan(np.concatenate([one, other])).any(axis=0)  # an episode has ended in all
    one, other = one[:, begun], other[:, begun]
    both, n = np.concatenate([one, other]), len(one)
    found = ppo_compare.distance(one, other)
    apart = [
        ppo_compare.distance(both[list(group)], np.delete(both, group, axis=0))
        for group in combinations(range(len(both)), n)
    ]
    return np.mean(np.array(apart) >= found - 1e-12)


@pytest.mark.long
@pytest.mark.parametrize("env", SETTINGS)
def test_curves_are_those_of_stable_baselines3(env, monkeypatch):
    torch = pytest.importorskip("torch")
    torch.set_num_threads(1)
    monkeypatch.setattr(ppo_compare, "EVALUATED", 1)
    mine = np.stack([native(env, seed) for seed in SEEDS])
    theirs = np.stack([stable_baselines3(env, seed) for seed in SEEDS])
    print(env, mine.mean(axis=0).round(1), theirs.mean(axis=0).round(1))
    assert share_as_far(mine, theirs) > DOUBT
    # and the test can tell: half the learning rate or other rewards are another algorithm
    slower = SETTINGS[env][2] | {"learning_rate": 0.0001}
    monkeypatch.setitem(SETTINGS, env, (*SETTINGS[env][:2], slower))
    assert share_as_far(np.stack([native(env, seed) for seed in SEEDS]), theirs) <= DOUBT
