"""Make trainings by policy gradients, read them, and prove them by evaluating them again.

The columns of their stat file: steps; best mean return of an iteration's episodes so far; best
post-evaluated return so far; mean return of this iteration's episodes (before the first episode has
ended, the post-evaluation); newest post-evaluation; episodes so far.

The genotype holds the network of the best post-evaluation, then its normalisation of observations.

A learner is the student's own rule, which says how much each step of an episode counts.
"""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from botschool.errors import BotschoolError
from botschool.evolution.record import STAT, RunFiles
from botschool.labs.declare import Condition
from botschool.labs.saved import SavedRun, numbers, stat_of
from botschool.output import save_npy
from botschool.rl.native import PPO
from botschool.terminal import stoppable


def make_all(
    condition: Condition, seeds: list[int], folder: Path, workers: int, student: Any
) -> bool:
    """Make all missing runs; return False if the user stopped."""
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
    """Return the run with this seed; None if it is missing, damaged or not finished."""
    files = RunFiles(folder, seed)
    stat, genotype = stat_of(files.stat), numbers(files.bestg, 1)
    if stat is None or genotype is None or stat[-1, 0] < _budget(condition):
        return None
    return SavedRun(condition, seed, stat, genotype)


def made(
    condition: Condition, seed: int, student: Any = None, stopping: Any = lambda: False
) -> SavedRun | None:
    """Make the run here and return it; None if it was stopped.

    student: calls the student's function with this name and these arguments and returns its result.
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
    """Return whether the saved network gets exactly the return that the run's files state."""
    told = run.condition.experiment
    ppo = filled(told, run.genotype)
    return ppo is not None and post_evaluated(told, ppo, run.seed) == run.stat[-1, 2]


def _budget(condition: Condition) -> int:
    return round(condition.experiment["algo"]["maxmsteps"] * 1e6)


def agent(experiment: dict[str, Any], seed: int = 1) -> PPO:
    """Return the untrained agent; with a `learner`, its critic gives 0 and learns nothing."""
    ppo = PPO(experiment["exp"]["environment"], seed=seed, **experiment["ppo"])
    if "learner" in experiment:
        for name, each in ppo.weights.items():
            if name.startswith("critic"):
                each[:] = 0
    return ppo


def post_evaluated(experiment: dict[str, Any], ppo: PPO, seed: int) -> float:
    """Return the mean return in `pepisodes` episodes of the run's seed, without exploration."""
    episodes = experiment["policy"]["pepisodes"]
    return float(play(ppo, seed, episodes).mean())


def play(ppo: PPO, seed: int, episodes: int) -> np.ndarray:
    """Return the returns of the episodes 0, 1, ... of a seed, without exploration."""
    seeds = np.full(episodes, seed, dtype=np.uint64)
    return ppo.core.play(seeds, np.arange(episodes, dtype=np.uint32))[0]


def _vector(ppo: PPO) -> np.ndarray:
    parts = [ppo.parameters.astype(np.float64)]
    if ppo.normalize:
        parts.append(np.array(ppo.core.observed, dtype=np.float64).ravel())
    return np.concatenate(parts)


def filled(experiment: dict[str, Any], genotype: np.ndarray) -> PPO | None:
    """Return an agent with these numbers; None if they do not fit."""
    ppo = agent(experiment)
    if genotype.shape != _vector(ppo).shape:
        return None
    count = len(ppo.parameters)
    ppo.parameters[:] = genotype[:count]
    if ppo.normalize:
        ppo.core.observed = genotype[count:].reshape(2, -1)
    return ppo


def whole_episodes(ended: np.ndarray) -> list[tuple[int, int, int]]:
    """Return the episodes that begin and end in a rollout.

    Each is (environment, first step, step after the last). ended: (n_steps, n_envs), other than 0
    where an episode ends. The first episode of each environment is left out, because it may have
    begun in an earlier rollout.
    """
    found = []
    for environment in range(ended.shape[1]):
        ends = np.flatnonzero(ended[:, environment]) + 1
        found += [(environment, int(a), int(b)) for a, b in pairwise(ends)]
    return found


def weigh(rollout: Any, learner: Any, student: Any) -> None:
    """Replace a rollout's advantages by the weights that the student's function returns.

    learner: the function's name and its second argument. Steps of episodes that the rollout cuts
    off get the weight 0. Raises BotschoolError if the function returns anything but numbers.
    """
    name, argument = learner
    places = whole_episodes(rollout.ended)
    rollout.advantages[:] = 0
    rollout.returns[:] = rollout.values
    if not places:
        return
    rewards = [np.array(rollout.rewards[a:b, e], dtype=np.float64) for e, a, b in places]
    given = student(name, rewards, argument)
    if not isinstance(given, (list, tuple)) or len(given) != len(places):
        raise BotschoolError(f"{name} must return a list with an array for each episode.")
    for (e, a, b), weights in zip(places, given, strict=True):
        try:
            array = np.asarray(weights, dtype=np.float64)
        except (TypeError, ValueError):
            array = np.zeros(0)
        if array.shape != (b - a,) or not np.isfinite(array).all():
            raise BotschoolError(f"{name} must return a finite number for each step of an episode.")
        rollout.advantages[a:b, e] = array
