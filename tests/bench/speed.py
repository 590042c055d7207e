"""Steps per second: of native evaluation, of Gymnasium's own loop, and of whole runs."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import gymnasium
import numpy as np

from botschool import config, problems
from botschool.analysis.populations import Populations
from botschool.config import Experiment
from botschool.evolution.algorithms.sides import everyone
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import Run
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from botschool.problems.native import NativeProblem

DATA = Path(__file__).parents[2] / "data" / "experiments"
SEED = 1


@dataclass
class Case:
    """An experiment file, the speed asked for, and the original library's (steps/s)."""

    file: str
    target: float
    original: float | None
    gymnasium: bool = True
    episodes: int = 2000
    """In a large batch."""

    def load(self) -> Experiment:
        """The experiment."""
        return config.load(DATA / f"{self.file}.ini")


CASES = [
    Case("acrobot", 2e6, 23e3),
    Case("cartpole", 4e6, 89e3),
    Case("pendulum", 4e6, 77e3),
    Case("mountaincarcontinuous", 4e6, 279e3),
    Case("dpole", 4e6, 744e3, gymnasium=False),
    Case("swingup", 4e6, None, gymnasium=False),
    Case("discrim", 5e6, 0.7e6, gymnasium=False),
    Case("predprey", 1.0e6, 0.109e6, gymnasium=False, episodes=160),
]
"""The original library's figures were published for another machine of this kind."""


class Batch:
    """Random policies of an experiment's initial distribution, one episode each."""

    def __init__(self, experiment: Experiment, episodes: int, instruction_set: str = "") -> None:
        self.experiment = experiment
        self.problem = NativeProblem(experiment.exp.environment, instruction_set=instruction_set)
        self.policy = Policy(self.problem.name, self.problem.interface, experiment.policy)
        self.genotypes = np.array([self.policy.initial(SEED, i) for i in range(episodes)])
        self.episodes = Episodes.of(np.arange(episodes), 1)
        self.normalisation = None
        if experiment.policy.normalize:
            self.normalisation = np.repeat([0.0, 1.0], self.problem.interface.observations)

    def evaluate(self, workers: int = 1) -> int:
        """Evaluates all; returns the steps done."""
        outcome = self.problem.evaluate(
            self.policy,
            self.genotypes,
            self.normalisation,
            self.episodes,
            self.experiment.policy.maxsteps,
            workers,
        )
        return int(outcome.steps.sum())


class Around(Batch):
    """Candidates around an evolved robot, an episode each, so that most episodes are whole ones."""

    def __init__(self, name: str, candidates: int, noise: float = 0.02) -> None:
        self.experiment = config.load(DATA / f"{name}.ini")
        self.problem = problems.of(self.experiment)
        self.policy = self.problem.policy(self.experiment.policy)
        saved = np.load(DATA.parent / "genotypes" / f"{name}.npy")
        self.genotype, self.normalisation = self.policy.split(saved)
        numbers = np.random.default_rng(SEED)
        self.genotypes = self.genotype + numbers.normal(0, noise, (candidates, self.genotype.size))
        self.episodes = Episodes.of(np.arange(candidates), 1)


class Meetings:
    """The best `predators` and `prey` of saved populations, all against all, as in co-evolution.

    Each is varied by a little noise, so that all are different, as offspring are.
    """

    def __init__(self, folder: Path, seed: int, predators: int, prey: int) -> None:
        self.run = Coevolution(config.load(DATA / "predprey.ini"), SEED)
        kept = Populations(folder, seed, self.run.policy)
        population = kept.load(kept.generations[-1])
        numbers = np.random.default_rng(SEED)
        self.sides = []
        for networks, count in ((population.predators, predators), (population.prey, prey)):
            chosen = np.resize(networks, (count, networks.shape[1]))
            self.sides.append(chosen + 0.02 * numbers.standard_normal(chosen.shape))

    def evaluate(self) -> int:
        """All meetings; returns the steps done."""
        steps = 0

        def play(*meeting: np.ndarray) -> np.ndarray:
            nonlocal steps
            fitness, steps = self.run._meet(*meeting, lambda: False)
            return fitness

        everyone(play, *self.sides)
        return steps


class GymnasiumLoop:
    """The loop that everybody writes: env.step(policy(observation)), in Python.

    The network is the stepwise one in double precision, the genotypes are those of a Batch.
    """

    def __init__(self, batch: Batch) -> None:
        # no wrappers but Gymnasium's own time limit and order check: its fastest form
        self.env = gymnasium.make(batch.problem.dynamics, disable_env_checker=True)
        self.batch = batch
        self._next = 0

    def evaluate(self) -> int:
        """One whole episode of the next genotype; returns its steps."""
        batch, policy = self.batch, self.batch.policy
        i = self._next
        self._next = (i + 1) % len(batch.genotypes)
        policy.load(batch.genotypes[i], batch.normalisation)
        policy.reset(SEED, i)
        observation, _ = self.env.reset(seed=i)
        steps = 0
        for _ in range(batch.problem.steps(batch.experiment.policy.maxsteps)):
            observation, _, terminated, truncated, _ = self.env.step(policy.act(observation))
            steps += 1
            if terminated or truncated:
                break
        return steps


def rates(
    contestants: list[Callable[[], int]], seconds: float, repetitions: int
) -> list[list[float]]:
    """Steps per second of processor time of each contestant in each repetition.

    A contestant is a function that does some work in this thread and returns its steps. They take
    turns, so that whatever else the machine does disturbs all alike.
    """
    for contestant in contestants:
        contestant()
    measured = [[] for _ in contestants]
    for _ in range(repetitions):
        for contestant, results in zip(contestants, measured, strict=True):
            steps, start = 0, time.process_time()
            while (elapsed := time.process_time() - start) < seconds:
                steps += contestant()
            results.append(steps / elapsed)
    return measured


def best_call(contestants: list[Callable[[], int]], repetitions: int) -> list[float]:
    """Steps per second of each contestant's fastest call; they take turns."""
    best = [0.0] * len(contestants)
    for _ in range(repetitions + 1):
        for i, contestant in enumerate(contestants):
            start = time.perf_counter()
            steps = contestant()
            best[i] = max(best[i], steps / (time.perf_counter() - start))
    return best


@dataclass
class RunTimes:
    """Where the seconds of a run's first generations went; one value a generation."""

    steps: np.ndarray
    whole: np.ndarray
    evaluating: np.ndarray


def run_times(
    experiment: Experiment, workers: int, generations: int, prepare=lambda run: None
) -> RunTimes:
    """Times the first generations of a run: the same work whenever it is repeated."""
    kind = Coevolution if experiment.exp.algo == "coevo2" else Run
    run = kind(experiment, SEED, workers)
    prepare(run)
    evaluate = run.problem.evaluate
    steps, whole, evaluating = np.zeros((3, generations))
    generation = 0

    def timed(*arguments):
        start = time.perf_counter()
        outcome = evaluate(*arguments)
        evaluating[generation] += time.perf_counter() - start
        return outcome

    run.problem.evaluate = timed
    for generation in range(generations):
        start, before = time.perf_counter(), run.record.steps
        run.advance()
        whole[generation] = time.perf_counter() - start
        steps[generation] = run.record.steps - before
    return RunTimes(steps, whole, evaluating)


def undisturbed(repeated: list[RunTimes]) -> RunTimes:
    """Each generation's shortest time: what other programs cost is left out."""
    return RunTimes(
        repeated[0].steps,
        np.min([times.whole for times in repeated], axis=0),
        np.min([times.evaluating for times in repeated], axis=0),
    )


def generations_in(experiment: Experiment, seconds: float) -> int:
    """About how many generations one worker does in that time."""
    run, start, count = Run(experiment, SEED), time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        run.advance()
        count += 1
    return count
