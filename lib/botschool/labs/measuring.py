"""Offer measure.py and figure.py tools: play robots again, intervals, a permutation test."""

from __future__ import annotations

from collections.abc import Callable
from inspect import getfile
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

Run = dict[str, Any]
"""A run: "condition", "seed", "stat", "genotype", "experiment"."""
RESAMPLES = 10_000
CYLINDER = (200, 150)
"""Position of the cylinder in `forage`: x and y in mm."""


def _robot(run: Run) -> tuple[Any, Any, int]:
    """Return problem, policy with the run's best robot, and steps of an episode."""
    from botschool import problems
    from botschool.config import from_dict

    experiment = from_dict(run["experiment"])
    problem = problems.of(experiment)
    policy = problem.policy(experiment.policy)
    policy.load(*policy.split(np.asarray(run["genotype"])))
    return problem, policy, experiment.policy.maxsteps


def record(run: Run, seed: int = 1) -> dict[str, Any]:
    """Play an episode of a planar runner's best robot and record it.

    "duration" is the length of a step in seconds. "distance", shape (T + 1,), is the distance in
    metres to a target far ahead, at the start and after each step. "height" and "pitch" have shape
    (T,). "feet", shape (T, feet), is 1 where a foot is on the ground.
    """
    from botschool.config import from_dict
    from botschool.course.locomotion import Runner

    experiment = from_dict(run["experiment"])
    runner = Runner(experiment.exp.environment, experiment.policy)
    return runner.record(np.asarray(run["genotype"]), seed)


def play_again(run: Run, seed: int = 1, episodes: int = 100) -> np.ndarray:
    """Return the returns of a run's best robot in new episodes, shape (episodes,)."""
    if "ppo" in run["experiment"]:
        from botschool.labs.training import filled, play

        return play(filled(run["experiment"], np.asarray(run["genotype"])), seed, episodes)
    from botschool.problems import Episodes

    problem, policy, steps = _robot(run)
    genotype, normalisation = policy.split(np.asarray(run["genotype"]))
    batch = Episodes.of(np.array([seed], dtype=np.uint64), episodes)
    return problem.evaluate(policy, genotype[None], normalisation, batch, steps).fitness


def forage(run: Run, forget: bool = False) -> list[dict[str, np.ndarray]]:
    """Let a run's best Khepera search for the cylinder from 12 places, and record each episode.

    "poses", shape (T + 1, 3): x and y in mm and the heading in rad, at the start and after each
    step. "rewards", shape (T,): 1 near the cylinder. The cylinder stands at CYLINDER. forget: empty
    the network's memory before each step.
    """
    from botschool import arena as arenas

    _, policy, steps = _robot(run)
    arena = arenas.make("discrim", max_steps=steps)
    recorded = []
    headings = np.arange(3) * 2 * np.pi / 3
    for number, start in enumerate(product((150, 250), (270, 350), headings)):
        arena.reset(number)
        arena.robots[0] = start
        arena.objects[0, :2] = CYLINDER
        arena.sense()
        policy.reset(number, 0)
        poses, rewards = [arena.robots[0].copy()], []
        while not arena.done:
            if forget:
                policy.reset(number, 0)
            arena.action = policy.act(arena.observation)
            rewards.append(arena.step())
            poses.append(arena.robots[0].copy())
        recorded.append({"poses": np.array(poses), "rewards": np.array(rewards)})
    return recorded


def swing(run: Run, gravity: float = 10.0, episodes: int = 10) -> dict[str, np.ndarray]:
    """Let a run's best pendulum swing under this gravity in m/s2 (it evolved under 10).

    "angles", shape (episodes, 201): rad from upright, -pi to pi, at the start and after each step.
    "velocities", shape (episodes, 201): rad/s at the same times. "rewards": shape (episodes, 200).
    """
    import gymnasium

    _, policy, _ = _robot(run)
    env = gymnasium.make("Pendulum-v1", g=gravity)
    seen, rewards = [], []
    for episode in range(episodes):
        observation, _ = env.reset(seed=episode)
        policy.reset(episode, 0)
        seen.append([observation])
        rewards.append([])
        for _ in range(200):
            observation, reward, *_ = env.step(policy.act(observation))
            seen[-1].append(observation)
            rewards[-1].append(float(reward))
    cosine, sine, velocities = np.moveaxis(np.array(seen, dtype=float), -1, 0)
    return {
        "angles": np.arctan2(sine, cosine),
        "velocities": velocities,
        "rewards": np.array(rewards),
    }


def chases(run: Run, best: int = 5) -> np.ndarray:
    """Let the best predators and prey of all saved generations of a run meet.

    Return the predators' fitness, shape (G, n, G, n): entry [g, i, h, j] belongs to predator i of
    the g-th saved generation against prey j of the h-th one. best: n.
    """
    from botschool.analysis.tournament import Contest
    from botschool.config import from_dict

    sides = [np.split(np.asarray(each), 2) for each in run["populations"].values()]
    predators, prey = (np.stack([each[side][:best] for each in sides]) for side in (0, 1))
    with Contest(from_dict(run["experiment"]), 0) as contest:
        met = contest.meet(np.concatenate(predators), np.concatenate(prey))
    return met.reshape(*predators.shape[:2], *prey.shape[:2])


def seconds_per_million(number: int, condition: str) -> float:
    """Return this machine's processor seconds for a million steps of a laboratory's condition."""
    from time import process_time

    from botschool.labs.declare import load_lab

    short = load_lab(number).condition(condition).shortened(4)
    began = process_time()
    run = short.maker.made(short, 1)
    return (process_time() - began) / run.stat[-1, 0] * 1e6


def interval(
    values: ArrayLike, statistic: Callable[..., Any] = np.median, seed: int = 1
) -> tuple[float, float]:
    """Return a 95 % bootstrap interval of a statistic: 95 of 100 resamples lie in it.

    statistic: a function of an array and the keyword axis, such as np.median or np.mean.
    """
    array = np.asarray(values, dtype=float)
    rng = np.random.default_rng(seed)
    resampled = array[rng.integers(len(array), size=(RESAMPLES, len(array)))]
    low, high = np.percentile(statistic(resampled, axis=1), [2.5, 97.5])
    return float(low), float(high)


def permutation_test(one: ArrayLike, other: ArrayLike, seed: int = 1) -> float:
    """Return the p of a difference of means: how often random groups differ at least as much."""
    first, second = np.asarray(one, dtype=float), np.asarray(other, dtype=float)
    both = np.concatenate([first, second])
    seen = abs(first.mean() - second.mean())
    rng = np.random.default_rng(seed)
    mixed = rng.permuted(np.tile(both, (RESAMPLES, 1)), axis=1)
    apart = np.abs(mixed[:, : len(first)].mean(axis=1) - mixed[:, len(first) :].mean(axis=1))
    return float((1 + (apart >= seen - 1e-9).sum()) / (1 + RESAMPLES))


def paired_test(one: ArrayLike, other: ArrayLike, seed: int = 1) -> float:
    """Return the p of a mean difference of pairs: how often random signs give at least as much."""
    differences = _paired(one, other)
    rng = np.random.default_rng(seed)
    signs = rng.choice([-1.0, 1.0], size=(RESAMPLES, len(differences)))
    apart = np.abs((signs * differences).mean(axis=1))
    return float((1 + (apart >= abs(differences.mean()) - 1e-9).sum()) / (1 + RESAMPLES))


def power(one: ArrayLike, other: ArrayLike, runs: int, seed: int = 1) -> float:
    """Return the share of cases in which the permutation test finds the difference with p < 0.05.

    Each of 400 cases draws `runs` values of each group with repetition.
    """
    rng = np.random.default_rng(seed)
    groups = [
        each[rng.integers(len(each), size=(400, 1, runs))]
        for each in (np.asarray(one, dtype=float), np.asarray(other, dtype=float))
    ]
    both = np.concatenate(groups, axis=2)
    mixed = rng.permuted(np.repeat(both, 1000, axis=1), axis=2)

    def apart(values: np.ndarray) -> np.ndarray:
        return np.abs(values[..., :runs].mean(axis=-1) - values[..., runs:].mean(axis=-1))

    p = (1 + (apart(mixed) >= apart(both) - 1e-9).sum(axis=1)) / 1001
    return float((p < 0.05).mean())


def load_runs(folder: str | Path = ".") -> dict[str, list[Run]]:
    """Return your finished runs: condition -> runs, each as `measure` gets it.

    folder: the laboratory's, such as lab09. Raises BotschoolError if a condition has no runs yet.
    """
    from botschool.errors import BotschoolError
    from botschool.labs.folder import Place
    from botschool.labs.runs import own_runs
    from botschool.labs.saved import plain_runs

    place = Place.find(Path(folder))
    found = own_runs(place.lab, place.sheet(), place.runs)
    for name, runs in found.items():
        if not runs:
            raise BotschoolError(f"{name} has no runs yet: botschool lab {place.lab.number} run.")
    return {name: plain_runs(runs, place.lab.others) for name, runs in found.items()}


def measure_all(measure: Callable[[dict], dict]) -> dict[str, dict[str, np.ndarray]]:
    """Measure all runs of the folder in which `measure` is: condition -> measure -> array."""
    found = {}
    for name, runs in load_runs(Path(getfile(measure)).parent).items():
        rows = [_row(measure(run), name) for run in runs]
        found[name] = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    return found


def _row(answer: Any, name: str) -> dict[str, float]:
    """Return what `measure` gave, one number for each name. Raises BotschoolError."""
    from botschool.errors import BotschoolError

    if not isinstance(answer, dict) or not answer:
        raise BotschoolError(f"measure(run) returns a dict of numbers, not {answer!r:.60}.")
    for key, value in answer.items():
        size = np.size(value)
        if size != 1 or np.ndim(value):
            raise BotschoolError(
                f"measure(run) of {name} returns {size} numbers in a list for '{key}': return one, "
                "such as their mean."
            )
    return answer


def _paired(one: ArrayLike, other: ArrayLike) -> np.ndarray:
    """Return the differences of pairs. Raises BotschoolError if the lengths differ."""
    from botschool.errors import BotschoolError

    if np.shape(one) != np.shape(other):
        raise BotschoolError(
            f"A paired test needs two lists of the same runs, not {np.size(one)} and "
            f"{np.size(other)} values."
        )
    return np.asarray(one, dtype=float) - np.asarray(other, dtype=float)
