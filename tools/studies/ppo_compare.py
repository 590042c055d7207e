"""The PPO of lib/walkthroughs/ppo.py beside that of Stable-Baselines3: a part of results.py.

    python tools/studies ppo_compare        curves of Stable-Baselines3 on Acrobot, two minutes

Both train on CartPole-v1 and Pendulum-v1 with the same hyperparameters and several seeds. The
curves on Acrobot go to data/sb3_curves.json: tests/rl/test_policy_gradients_curves.py puts those of
the native engine beside them.
"""

from __future__ import annotations

import json
import sys
from itertools import combinations

import numpy as np
from study import DATA, ROOT, side_by_side

sys.path.insert(0, str(ROOT / "lib" / "walkthroughs"))

SETTINGS = {
    "CartPole-v1": {
        "total_timesteps": 100_000, "n_envs": 8, "n_steps": 32, "batch_size": 256, "n_epochs": 20,
        "gamma": 0.98, "gae_lambda": 0.8, "learning_rate": 0.001, "clip_range": 0.2, "anneal": 1,
    },
    "Pendulum-v1": {
        "total_timesteps": 100_000, "n_envs": 4, "n_steps": 1024, "batch_size": 64, "n_epochs": 10,
        "gamma": 0.9, "gae_lambda": 0.95, "learning_rate": 0.001, "clip_range": 0.2, "anneal": 0,
    },
    "Acrobot-v1": {
        "total_timesteps": 60_000, "n_envs": 16, "n_steps": 128, "batch_size": 256, "n_epochs": 4,
        "gamma": 0.99, "gae_lambda": 0.94, "learning_rate": 0.001, "anneal": 0,
    },
}  # fmt: skip
"""Those of rl-zoo, but a plain Gaussian for Pendulum."""
COMPARED = ("CartPole-v1", "Pendulum-v1")
LIBRARIES = ("walkthrough", "Stable-Baselines3")
POINTS = 20
"""Of a learning curve, equally spaced; each is the mean of the last 20 training episodes."""
EVALUATED, NEW_SEED = 100, 1_000_000
"""Episodes after training, with the most probable actions, and their first seed."""


def walkthrough(env: str, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Episodes of the training, rows (steps, return), and the returns of new episodes."""
    import ppo

    history = ppo.train(ppo.Hyperparameters(env=env, seed=seed, **SETTINGS[env]))
    new = ppo.evaluate(history.agent, env, EVALUATED, NEW_SEED)
    return np.array(history.episodes)[:, :2], new


def stable_baselines3(env: str, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """The same of Stable-Baselines3."""
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.evaluation import evaluate_policy

    class Episodes(BaseCallback):
        def _on_step(self) -> bool:
            ended = [info["episode"]["r"] for info in self.locals["infos"] if "episode" in info]
            episodes.extend((self.num_timesteps, each) for each in ended)
            return True

    episodes: list[tuple[int, float]] = []
    settings = dict(SETTINGS[env])
    steps, n_envs, anneal = (settings.pop(k) for k in ("total_timesteps", "n_envs", "anneal"))
    for name in ("learning_rate", "clip_range") if anneal else ():
        settings[name] = lambda left, first=settings[name]: first * max(left, 0.0)
    envs = make_vec_env(env, n_envs, seed=seed)
    model = PPO("MlpPolicy", envs, seed=seed, device="cpu", **settings)
    model.learn(steps, callback=Episodes())
    new_envs = make_vec_env(env, 1, seed=NEW_SEED)
    new, _ = evaluate_policy(model, new_envs, EVALUATED, return_episode_rewards=True)
    return np.array(episodes), np.array(new)


def trained(library: str, env: str, seed: int) -> tuple[np.ndarray, float]:
    """One training: its curve, and its mean return in new episodes."""
    import torch

    torch.set_num_threads(1)
    function = walkthrough if library == "walkthrough" else stable_baselines3
    episodes, new = function(env, seed)
    print(f"{library}, {env}, seed {seed}: {new.mean():.1f} in new episodes", flush=True)
    return curve(episodes, SETTINGS[env]["total_timesteps"]), float(new.mean())


def curve(episodes: np.ndarray, steps: int) -> np.ndarray:
    """Mean of the last 20 episodes at each of the points; shape (POINTS,)."""
    points = np.arange(1, POINTS + 1) * steps / POINTS
    ends = np.searchsorted(episodes[:, 0], points, side="right")
    return np.array([episodes[max(0, end - 20) : end, 1].mean() for end in ends])


def agreement(env: str, curves: dict, new: dict) -> str:
    """In words, whether the two could be one algorithm.

    Distance of two groups of curves: the mean over the points of the difference of their means, in
    standard deviations over the seeds. If both are one algorithm, each way of dealing all curves
    into two groups of the same sizes is as likely as the one that was found.
    """
    one, other = curves.values()
    both, n = np.concatenate([one, other]), len(one)
    groups = [list(group) for group in combinations(range(len(both)), n)]
    found, *others = (distance(both[g], np.delete(both, g, axis=0)) for g in groups)
    further = 1 + sum(each >= found - 1e-12 for each in others)
    overlap = (one.min(axis=0) <= other.max(axis=0)) & (other.min(axis=0) <= one.max(axis=0))
    last = distance(*(each[:, None] for each in new.values()))
    return (
        f"{env}: the mean curves are {found:.2f} standard deviations apart (mean over {POINTS} "
        f"points); of the {len(groups)} ways to deal the {len(both)} curves into two groups, "
        f"{further} ({further / len(groups):.0%}) are at least as far apart. The ranges of the "
        f"seeds overlap at {overlap.sum()} of {POINTS} points. In new episodes they are "
        f"{last:.2f} standard deviations apart."
    )


def distance(one: np.ndarray, other: np.ndarray) -> float:
    """Mean over the points of |difference of the means| / pooled standard deviation."""
    spread = np.sqrt((one.var(axis=0, ddof=1) + other.var(axis=0, ddof=1)) / 2)
    apart = np.abs(one.mean(axis=0) - other.mean(axis=0))
    return float(np.mean(apart / np.maximum(spread, 1e-9)))


def compared(seeds: int) -> dict:
    """{problem: {"steps", "libraries": {library: {"curves", "new"}}, "agreement"}}."""
    jobs = [(lib, env) for env in COMPARED for lib in LIBRARIES]
    every = [(*job, seed) for job in jobs for seed in range(1, seeds + 1)]
    runs = side_by_side(trained, *zip(*every, strict=True))
    found: dict = {}
    for i, (library, env) in enumerate(jobs):
        curves, new = map(np.array, zip(*runs[i * seeds : (i + 1) * seeds], strict=True))
        of = found.setdefault(env, {"curves": {}, "new": {}})
        of["curves"][library], of["new"][library] = curves, new
    return {
        env: {
            "steps": SETTINGS[env]["total_timesteps"],
            "libraries": {
                library: {
                    "curves": rows.round(1).tolist(),
                    "new": of["new"][library].round(2).tolist(),
                }
                for library, rows in of["curves"].items()
            },
            "agreement": agreement(env, of["curves"], of["new"]),
        }
        for env, of in found.items()
    }


def main() -> None:
    """See the top of the file."""
    found = {}
    for seed in range(1, 6):
        points, _ = trained("Stable-Baselines3", "Acrobot-v1", seed)
        found[seed] = [None if np.isnan(x) else round(float(x), 2) for x in points]
    (DATA / "sb3_curves.json").write_text(json.dumps({"Acrobot-v1": found}, indent=1) + "\n")
