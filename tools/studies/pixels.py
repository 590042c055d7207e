"""Robots that read images, measured on new episodes: docs/reports/pixels.md.

    botschool es -f data/experiments/pong.ini -s 1 -o results/pixels/pong      likewise carracing
    python tools/studies pixels             measures what is in results/pixels, writes the page

For each experiment: its robot with the best post-evaluation, ten random ones as evolution starts
from, and random actions, each in new episodes; mean return with a 95 % interval (percentiles of
10,000 resamples), and the processor time of a step. The same of a step of some networks alone.
"""

import re
import time
from pathlib import Path

import numpy as np
from report import Table

from botschool import config, problems
from botschool.analysis.plots import plot_stat
from botschool.net import Network, NetworkSpec
from botschool.policies.policy import Policy
from botschool.problems import Episodes, Outcome
from botschool.problems.making import make_env
from botschool.wrappers import parse

ROOT = Path(__file__).parents[2]
DOCS, RUNS = ROOT / "docs", ROOT / "results" / "pixels"
EPISODES = {"pong": 50, "carracing": 10}
"""New episodes of each experiment; those of the car take long."""
NEW = 2_000_000
"""Seed of the first new episode; no run meets it."""
SHAPES = (
    ((4, 84, 84), (8, 16), (8, 4), (4, 2), 6),
    ((4, 84, 84), (16, 32), (8, 4), (4, 2), 6),
    ((2, 42, 42), (4, 8, 8), (3, 3, 3), (2, 2, 2), 6),
    ((3, 96, 96), (8, 8), (8, 4), (4, 3), 3),
)
"""Networks: the image's channels and sides, filters, kernels, strides, outputs."""
RETURNS = ["experiment", "parameters", "steps", "generations", "robot", "random robots",
           "random actions", "episodes", "ms / step"]  # fmt: skip
STEPS = ["image", "filters", "kernels", "strides", "parameters", "microseconds"]


def interval(returns: np.ndarray) -> str:
    """Mean and 95 % interval."""
    draws = np.random.default_rng(1).integers(0, len(returns), (10_000, len(returns)))
    low, high = np.percentile(returns[draws].mean(axis=1), [2.5, 97.5])
    return f"{returns.mean():.1f} ({low:.1f} to {high:.1f})"


def of_robots(problem, policy, genotypes: np.ndarray, normalisation, episodes: int) -> Outcome:
    """New episodes, shared by the genotypes."""
    batch = Episodes(
        np.arange(episodes, dtype=np.int32) % len(genotypes),
        np.full(episodes, NEW, dtype=np.uint64),
        np.arange(episodes, dtype=np.uint32),
    )
    return problem.evaluate(policy, genotypes, normalisation, batch, policy.config.post_steps)


def of_actions(experiment, episodes: int) -> np.ndarray:
    """Returns of random actions in the same episodes."""
    env = make_env(experiment.exp.environment, parse(experiment.exp.wrappers))
    env.action_space.seed(NEW)
    returns = np.zeros(episodes)
    for episode in range(episodes):
        env.reset(seed=NEW + episode)
        for _ in range(experiment.policy.post_steps):
            _, reward, terminated, truncated, _ = env.step(env.action_space.sample())
            returns[episode] += reward
            if terminated or truncated:
                break
    return returns


def measured(name: str) -> list[str]:
    """The row of an experiment whose run is there; draws its curve."""
    experiment = config.load(ROOT / "data" / "experiments" / f"{name}.ini")
    problem = problems.of(experiment)
    policy = Policy(problem.name, problem.interface, experiment.policy)
    folder, episodes = RUNS / name, EPISODES[name]
    stat = np.load(folder / "statS1.npy").reshape(-1, 6)
    genotype, normalisation = policy.split(np.load(folder / "bestgS1.npy"))
    first = np.array([policy.initial(1, i) for i in range(10)])
    begun = time.process_time()
    robot = of_robots(problem, policy, genotype[None], normalisation, episodes)
    step = (time.process_time() - begun) / robot.steps.sum()
    plot_stat([folder], DOCS / "images" / f"{name}.png")
    return [
        f"{name}.ini", str(policy.genotype_size), f"{stat[-1, 0]:,.0f}", str(len(stat)),
        interval(robot.fitness),
        interval(of_robots(problem, policy, first, None, episodes).fitness),
        interval(of_actions(experiment, episodes)), str(episodes),
        f"{1e3 * step:.2f}",
    ]  # fmt: skip


def step_of(image, filters, kernels, strides, outputs) -> list[str]:
    """The row of a network: the least processor time of a step in ten repetitions."""
    layers = {"image": image, "filters": filters, "kernels": kernels, "strides": strides}
    inputs = int(np.prod(image))
    spec = NetworkSpec(inputs, outputs, nhiddens=0, architecture=4, afunction=5, bias=1, **layers)
    network = Network(spec)
    network.initialise(seed=1)
    network.observation[:] = np.random.default_rng(1).random(spec.inputs)
    times = []
    for _ in range(10):
        begun = time.process_time()
        for _ in range(50):
            network.step()
        times.append((time.process_time() - begun) / 50)
    shape = " x ".join(map(str, (*image[1:], image[0])))
    lists = [", ".join(map(str, each)) for each in (filters, kernels, strides)]
    return [shape, *lists, f"{len(network.parameters)}", f"{1e6 * min(times):.0f}"]


def main() -> None:
    there = [name for name in EPISODES if (RUNS / name / "bestgS1.npy").exists()]
    returns = Table("", "", RETURNS, [measured(name) for name in there]).markdown()
    steps = Table("", "", STEPS, [step_of(*shape) for shape in SHAPES]).markdown()
    page = DOCS / "reports" / "pixels.md"
    text = page.read_text(encoding="utf-8")
    for block, table in (("returns", returns if there else "Not measured yet."), ("steps", steps)):
        marks = rf"(<!-- {block} -->\n).*?(<!-- end -->)"
        text = re.sub(marks, lambda m, t=table: f"{m[1]}{t}\n{m[2]}", text, flags=re.DOTALL)
    page.write_text(text, encoding="utf-8")
