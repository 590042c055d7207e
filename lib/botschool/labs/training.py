"""Runs that are trained by policy gradients: made, read and looked at again.

A row of their stat file: steps; best mean return of an iteration's episodes so far; best
post-evaluated return so far; that mean return (until an episode has ended, the post-evaluation);
the newest post-evaluation; episodes so far.
The genotype is the network of the best post-evaluation, then how it normalises observations.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from botschool.evolution.record import STAT, RunFiles
from botschool.labs.declare import Condition
from botschool.labs.learning import weigh
from botschool.labs.saved import SavedRun, numbers, stat_of
from botschool.output import save_npy
from botschool.rl.native import PPO
from botschool.terminal import stoppable


def make_all(
    condition: Condition, seeds: list[int], folder: Path, workers: int, student: Any
) -> bool:
    """Make the runs that are not there; False when the user stopped it."""
    folder.mkdir(parents=True, exist_ok=True)
    todo = [seed for seed in seeds if read(condition, seed, folder) is None]
    with stoppable() as stopping, ThreadPoolExecutor(workers) as pool:

        def make(seed: int) -> bool:
            run = made(condition, seed, student, stopping)
            if run is None:
                return False
            files = RunFiles(folder, seed)
            save_npy(files.bestg, run.genotype)
            save_npy(files.stat, run.stat.ravel())
            return True

        return all(list(pool.map(make, todo)))


def read(condition: Condition, seed: int, folder: Path) -> SavedRun | None:
    """The run of that seed; None if it is not there, is damaged or has not come to its end."""
    files = RunFiles(folder, seed)
    stat, genotype = stat_of(files.stat), numbers(files.bestg, 1)
    if stat is None or genotype is None or stat[-1, 0] < _budget(condition):
        return None
    return SavedRun(condition, seed, stat, genotype)


def made(
    condition: Condition, seed: int, student: Any = None, stopping: Any = lambda: False
) -> SavedRun | None:
    """The run, made here; None when it was stopped.

    student: called with the name of a function and its arguments; gives what it returns.
    """
    ppo, learner = agent(condition.experiment, seed), condition.experiment.get("learner")
    rows: list[tuple[float, ...]] = []
    best, kept, episodes = -np.inf, np.zeros(0), 0
    while ppo.steps < _budget(condition):
        if stopping():
            return None
        rollout = ppo.collect()
        returns = ppo.episodes[1]
        episodes += len(returns)
        post = post_evaluated(condition.experiment, ppo, seed)
        before = rows[-1][3] if rows else post
        mean = float(returns.mean()) if len(returns) else before
        if post > best:
            best, kept = post, _vector(ppo)
        highest = max(mean, rows[-1][1] if rows else mean)
        rows.append((ppo.steps, highest, best, mean, post, episodes))
        if learner:
            weigh(rollout, learner, student)
        ppo.update()
    stat = np.array(rows, dtype=np.float64).reshape(-1, len(STAT))
    return SavedRun(condition, seed, stat, kept)


def genuine(run: SavedRun) -> bool:
    """Whether the saved network gets the return that the run's files tell, to the bit."""
    told = run.condition.experiment
    ppo = filled(told, run.genotype)
    return ppo is not None and post_evaluated(told, ppo, run.seed) == run.stat[-1, 2]


def _budget(condition: Condition) -> int:
    return round(condition.experiment["algo"]["maxmsteps"] * 1e6)


def agent(experiment: dict[str, Any], seed: int = 1) -> PPO:
    """The agent before its training; with a learner its critic says 0 and learns nothing."""
    ppo = PPO(experiment["exp"]["environment"], seed=seed, **experiment["ppo"])
    if "learner" in experiment:
        for name, each in ppo.weights.items():
            if name.startswith("critic"):
                each[:] = 0
    return ppo


def post_evaluated(experiment: dict[str, Any], ppo: PPO, seed: int) -> float:
    """The mean return in `pepisodes` episodes of the run's seed, without exploring."""
    episodes = experiment["policy"]["pepisodes"]
    return float(play(ppo, seed, episodes).mean())


def play(ppo: PPO, seed: int, episodes: int) -> np.ndarray:
    """The returns of the episodes 0, 1, ... of a seed, without exploring."""
    seeds = np.full(episodes, seed, dtype=np.uint64)
    return ppo.core.play(seeds, np.arange(episodes, dtype=np.uint32))[0]


def _vector(ppo: PPO) -> np.ndarray:
    parts = [ppo.parameters.astype(np.float64)]
    if ppo.normalize:
        parts.append(np.array(ppo.core.observed, dtype=np.float64).ravel())
    return np.concatenate(parts)


def filled(experiment: dict[str, Any], genotype: np.ndarray) -> PPO | None:
    """The agent with those numbers; None if they do not fit."""
    ppo = agent(experiment)
    if genotype.shape != _vector(ppo).shape:
        return None
    count = len(ppo.parameters)
    ppo.parameters[:] = genotype[:count]
    if ppo.normalize:
        ppo.core.observed = genotype[count:].reshape(2, -1)
    return ppo
