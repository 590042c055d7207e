"""The PPO of lib/walkthroughs/ppo.py beside that of Stable-Baselines3: same hyperparameters.

Both train on CartPole-v1 and Pendulum-v1 with several seeds. Prints a Markdown table for
docs/results.md, and `--picture FILE` draws the learning curves. Every training is kept in
`--folder`, so that an interrupted comparison goes on where it was.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor
from itertools import combinations
from pathlib import Path

import numpy as np
from report import Table, machine

sys.path.insert(0, str(Path(__file__).parents[2] / "lib" / "walkthroughs"))

SETTINGS = {
    "CartPole-v1": {
        "total_timesteps": 100_000, "n_envs": 8, "n_steps": 32, "batch_size": 256, "n_epochs": 20,
        "gamma": 0.98, "gae_lambda": 0.8, "learning_rate": 0.001, "clip_range": 0.2, "anneal": 1,
    },
    "Pendulum-v1": {
        "total_timesteps": 100_000, "n_envs": 4, "n_steps": 1024, "batch_size": 64, "n_epochs": 10,
        "gamma": 0.9, "gae_lambda": 0.95, "learning_rate": 0.001, "clip_range": 0.2, "anneal": 0,
    },
}  # fmt: skip
"""Those of rl-zoo, but a plain Gaussian for Pendulum."""
LIBRARIES = {"walkthrough": "#0072b2", "Stable-Baselines3": "#d55e00"}
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


def trained(library: str, env: str, seed: int, folder: Path) -> None:
    """One training, kept in the folder; none if it is there."""
    import torch

    place = place_of(library, env, seed, folder)
    if not place.exists():
        torch.set_num_threads(1)
        function = walkthrough if library == "walkthrough" else stable_baselines3
        episodes, new = function(env, seed)
        np.savez(place, episodes=episodes, new=new)
        print(f"{library}, {env}, seed {seed}: {new.mean():.1f} in new episodes", flush=True)


def place_of(library: str, env: str, seed: int, folder: Path) -> Path:
    return folder / f"{library}_{env}_{seed}.npz"


def curve(episodes: np.ndarray, steps: int) -> np.ndarray:
    """Mean of the last 20 episodes at each of the points; shape (POINTS,)."""
    points = np.arange(1, POINTS + 1) * steps / POINTS
    ends = np.searchsorted(episodes[:, 0], points, side="right")
    return np.array([episodes[max(0, end - 20) : end, 1].mean() for end in ends])


def add_rows(table: Table, env: str, curves: dict, new: dict) -> None:
    for library, rows in curves.items():
        cells = [
            f"{rows[:, int(POINTS * share) - 1].mean():.0f} +- "
            f"{rows[:, int(POINTS * share) - 1].std(ddof=1):.0f}"
            for share in (0.1, 0.25, 0.5, 0.75, 1)
        ]
        whole = rows.mean(axis=1)
        table.add(
            env, library, *cells, f"{whole.mean():.1f} +- {whole.std(ddof=1):.1f}",
            f"{new[library].mean():.1f} +- {new[library].std(ddof=1):.1f}",
        )  # fmt: skip


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


def draw(file: Path, found: dict) -> None:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 4.2), layout="constrained")
    panels = figure.subplots(1, len(found))
    for axes, (env, (curves, _)) in zip(np.atleast_1d(panels), found.items(), strict=True):
        steps = np.arange(1, POINTS + 1) * SETTINGS[env]["total_timesteps"] / POINTS / 1000
        for library, rows in curves.items():
            colour = LIBRARIES[library]
            axes.fill_between(steps, rows.min(0), rows.max(0), alpha=0.2, color=colour, lw=0)
            axes.plot(steps, rows.T, color=colour, linewidth=0.5, alpha=0.5)
            axes.plot(steps, rows.mean(0), color=colour, linewidth=2.2, label=library)
        axes.set(title=env, xlabel="thousand steps", ylabel="return, last 20 training episodes")
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
        axes.legend(frameon=False, loc="lower right")
    figure.savefig(file, dpi=110)
    print(f"picture: {file}")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=5, help="seeds 1 to this (default 5)")
    parser.add_argument("--processes", type=int, default=2, help="side by side (default 2)")
    parser.add_argument("--only", choices=SETTINGS, help="this problem")
    parser.add_argument("--folder", type=Path, default=Path("results/ppo_compare"))
    parser.add_argument("--picture", type=Path, help="draw the learning curves to this file")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    seeds = range(1, options.seeds + 1)
    problems = [options.only] if options.only else list(SETTINGS)
    jobs = [(lib, env, seed) for seed in seeds for env in problems for lib in LIBRARIES]
    context = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(options.processes, mp_context=context) as pool:
        for future in [pool.submit(trained, *job, options.folder) for job in jobs]:
            future.result()
    shares = ["10 %", "25 %", "50 %", "75 %", "100 %"]
    table = Table(
        "PPO: the walkthrough beside Stable-Baselines3",
        f"{options.seeds} seeds, mean +- sd; {machine()}.",
        ["problem", "PPO of", *shares, "whole curve", "new episodes"],
    )
    found = {}
    for env in problems:
        curves, new = {}, {}
        for library in LIBRARIES:
            runs = [np.load(place_of(library, env, seed, options.folder)) for seed in seeds]
            steps = SETTINGS[env]["total_timesteps"]
            curves[library] = np.stack([curve(run["episodes"], steps) for run in runs])
            new[library] = np.array([run["new"].mean() for run in runs])
        found[env] = curves, new
        add_rows(table, env, curves, new)
    table.show(markdown=True)
    for env, (curves, new) in found.items():
        print(agreement(env, curves, new))
    if options.picture:
        draw(options.picture, found)


if __name__ == "__main__":
    main()
