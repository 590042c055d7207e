"""Measures robots that read images on new episodes: docs/pixels.md.

    python tests/bench/pixels.py pong results/pong/bestgS1.npy --episodes 50

The robot, the random robots that evolution starts from, and random actions; mean return with a 95 %
interval (percentiles of 10,000 resamples). `speed` in place of the experiment: the time of a step.
"""

import argparse
import time
from pathlib import Path

import numpy as np

from botschool import config, problems
from botschool.net import Network, NetworkSpec
from botschool.policy import Policy
from botschool.problems import Episodes
from botschool.problems.making import make_env
from botschool.problems.spaces import fitted
from botschool.wrappers import parse

EXPERIMENTS = Path(__file__).parents[2] / "data" / "experiments"
NEW = 2_000_000
"""Seed of the first new episode; no run meets it."""
SHAPES = (
    ((4, 84, 84), (8, 16), (8, 4), (4, 2), 6),
    ((4, 84, 84), (16, 32), (8, 4), (4, 2), 6),
    ((2, 42, 42), (8, 16), (4, 4), (2, 2), 6),
    ((3, 96, 96), (8, 8), (8, 4), (4, 3), 3),
)


def interval(returns: np.ndarray) -> str:
    """Mean and 95 % interval."""
    draws = np.random.default_rng(1).integers(0, len(returns), (10_000, len(returns)))
    low, high = np.percentile(returns[draws].mean(axis=1), [2.5, 97.5])
    return f"{returns.mean():.1f} ({low:.1f} to {high:.1f}), best {returns.max():.1f}"


def of_robots(problem, policy, genotypes: np.ndarray, normalisation, episodes: int) -> np.ndarray:
    """Returns of `episodes` episodes, shared by the genotypes."""
    batch = Episodes(
        np.arange(episodes, dtype=np.int32) % len(genotypes),
        np.full(episodes, NEW, dtype=np.uint64),
        np.arange(episodes, dtype=np.uint32),
    )
    longest = policy.config.post_steps
    return problem.evaluate(policy, genotypes, normalisation, batch, longest).fitness


def of_actions(experiment, episodes: int) -> np.ndarray:
    """Returns of random actions in the same episodes."""
    env = make_env(experiment.exp.environment, parse(experiment.exp.wrappers))
    env.action_space.seed(NEW)
    start = getattr(env.action_space, "start", 0)
    returns = np.zeros(episodes)
    for episode in range(episodes):
        env.reset(seed=NEW + episode)
        for _ in range(experiment.policy.post_steps):
            action = fitted(env.action_space.sample() - start, env.action_space)
            _, reward, terminated, truncated, _ = env.step(action)
            returns[episode] += reward
            if terminated or truncated:
                break
    return returns


def measure(name: str, saved: Path, episodes: int) -> None:
    experiment = config.load(EXPERIMENTS / f"{name}.ini")
    problem = problems.of(experiment)
    policy = Policy(problem.name, problem.interface, experiment.policy)
    genotype, normalisation = policy.split(np.load(saved))
    print("robot", interval(of_robots(problem, policy, genotype[None], normalisation, episodes)))
    first = np.array([policy.initial(1, i) for i in range(min(10, episodes))])
    print("random robots", interval(of_robots(problem, policy, first, normalisation, episodes)))
    print("random actions", interval(of_actions(experiment, episodes)))


def speed() -> None:
    """Processor time of a step of some networks, the least of ten repetitions."""
    for image, filters, kernels, strides, outputs in SHAPES:
        layers = {"image": image, "filters": filters, "kernels": kernels, "strides": strides}
        spec = NetworkSpec(
            int(np.prod(image)), outputs, nhiddens=0, architecture=4, afunction=5, **layers
        )
        network = Network(spec)
        network.initialise(seed=1)
        network.observation[:] = np.random.default_rng(1).random(spec.inputs)
        times = []
        for _ in range(10):
            begun = time.process_time()
            for _ in range(50):
                network.step()
            times.append((time.process_time() - begun) / 50)
        print(layers, f"{len(network.parameters)} parameters: {1e6 * min(times):.0f} us")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("experiment")
    parser.add_argument("robot", type=Path, nargs="?")
    parser.add_argument("--episodes", type=int, default=50)
    given = parser.parse_args()
    if given.experiment == "speed":
        speed()
    else:
        measure(given.experiment, given.robot, given.episodes)
