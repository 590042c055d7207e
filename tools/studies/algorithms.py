"""Evolutionary algorithms side by side on native problems, for docs/reports/algorithms.md.

    python tools/studies algorithms     tries three settings of each, runs seeds 1 to 10 of the
                                        best, some four times as long, and writes the page

Runs go to data/algorithms, and those that are there are not done again: what is stopped goes on
where it stopped. Delete the files to begin anew.

The problem, the policy and the number of candidates are those of the problem's experiment file.
pycma is driven by the same evaluation, if it is installed (it is a dependency of the tests).
"""

from __future__ import annotations

import time
import warnings
from dataclasses import dataclass, replace

import numpy as np
from study import DATA, EXPERIMENTS, NEW_SEED, Results, at_steps, played

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool import config
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.gaussian import Gaussian
from botschool.evolution.run import Run

FOLDER = DATA / "algorithms"
POINTS = 40
"""Of a learning curve, equally spaced in the steps."""
TRIED = (101, 102)
SEEDS = tuple(range(1, 11))
SETTINGS = (0.02, 0.1, 0.5)
"""Standard deviations that are tried: of perturbations, mutations or the first candidates."""


@dataclass
class Problem:
    """An experiment file, and for how many million steps it is run here."""

    file: str
    steps: float
    tried: float
    """The same, of a run that tries a setting."""
    new: int = 200
    """New episodes in which its best robot is measured."""
    hidden: int = 0
    """Neurons of a hidden layer, if not as many as in the file: full matrices take long."""

    def experiment(self, method: Method, setting: float) -> config.Experiment:
        """The file's, with another algorithm."""
        of = config.load(EXPERIMENTS / f"{self.file}.ini")
        count = self.candidates(of)
        made = ALGORITHMS[method.algo].config(**method.keys(setting, count))
        if method.algo == "OpenAI-ES":
            made = replace(of.algo, noiseStdDev=setting)
        policy = replace(of.policy, nhiddens=self.hidden or of.policy.nhiddens)
        return replace(of, exp=replace(of.exp, algo=method.algo), policy=policy, algo=made)

    @staticmethod
    def candidates(of: config.Experiment) -> int:
        """Of a generation."""
        return 2 * of.algo.samplesize


@dataclass
class Method:
    """An algorithm, and how it is set."""

    name: str
    algo: str
    diagonal: bool = False

    def keys(self, setting: float, count: int) -> dict:
        """Hyperparameters, with so many candidates a generation."""
        if self.algo == "OpenAI-ES":
            return {}
        if self.algo == "(1+1)-ES":
            return {"sigma": setting}
        if self.algo == "PGPE":
            return {"samplesize": count // 2, "sigma": setting}
        if self.algo in ("SSS", "GA"):
            return {"popsize": count, "mutrate": setting}
        own = {"diagonal": int(self.diagonal)} if self.algo == "CMA-ES" else {}
        return {"popsize": count, "sigma": setting} | own


PROBLEMS = (
    Problem("cartpole_openaies", 0.3, 0.1),
    Problem("acrobot", 5, 1.7),
    Problem("pendulum", 6, 2),
    Problem("swingup", 10, 3.3, hidden=10),
    Problem("dpole", 15, 5),
    Problem("planarhopper", 3, 1, 50, hidden=20),
)
METHODS = (
    Method("OpenAI-ES", "OpenAI-ES"),
    Method("CMA-ES", "CMA-ES"),
    Method("CMA-ES, diagonal", "CMA-ES", diagonal=True),
    Method("xNES", "xNES"),
    Method("sNES", "sNES"),
    Method("SSS", "SSS"),
)
MORE = (Method("GA", "GA"), Method("(1+1)-ES", "(1+1)-ES"), Method("PGPE", "PGPE"))
"""Run with fewer seeds."""
MORE_SEEDS = SEEDS[:5]
PYCMA = Method("pycma", "CMA-ES")
"""Is set as CMA-ES."""
WITH_PYCMA = ("cartpole_openaies", "pendulum", "dpole")
LONGER = 4
"""Times the steps, for the problems and methods of run_longer."""
LONG_PROBLEMS = ("pendulum", "swingup", "dpole")
LONG_METHODS = ("OpenAI-ES", "CMA-ES, diagonal", "sNES")


class Pycma(Gaussian):
    """pycma's CMA-ES in the shape of our algorithms, on the same seeds of evaluation."""

    def __init__(self, settings, initial, seed: int) -> None:
        import cma

        super().__init__(settings, initial, seed)
        options = {"popsize": self.popsize, "seed": seed, "verbose": -9}
        self.strategy = cma.CMAEvolutionStrategy(self.mean, settings.sigma, options)

    def ask(self) -> tuple[np.ndarray, np.ndarray]:
        if self.strategy.countiter == self.generation:
            self.asked = self.strategy.ask()
        seeds = np.full(self.popsize, self.seed + self.generation, dtype=np.uint64)
        return np.array(self.asked), seeds

    def tell(self, fitness: np.ndarray) -> None:
        self.strategy.tell(self.asked, (-fitness).tolist())
        self.mean = np.array(self.strategy.mean)
        self.generation += 1

    def state(self) -> dict[str, np.ndarray]:
        return {}


def run(problem: Problem, method: Method, setting: float, seed: int, steps: float) -> dict:
    """One run: its best robot's mean return in new episodes, its curve and its time."""
    experiment = problem.experiment(method, setting)
    experiment.algo.maxmsteps = steps
    start = time.process_time()
    run = Run(experiment, seed)
    if method is PYCMA:
        made = run.algorithm
        run.algorithm = Pycma(experiment.algo, lambda index: made.mean, max(1, seed))
        run.together = False
    run.limit = run.budget
    while not run.limit.reached(run):
        run.advance(goes_on=True)
    run.settle()
    seconds = time.process_time() - start
    outcome = played(run, run.record.bestg, NEW_SEED + seed, problem.new)
    points = np.linspace(0, steps * 1e6, POINTS + 1)[1:]
    return {
        "new": round(float(outcome.fitness.mean()), 3),
        "best": round(run.record.bestg_fitness, 3),
        "seconds": round(seconds, 2),
        "curve": at_steps(run.record.rows(), points, 2),
    }


def do(results: Results, problem: Problem, method: Method, setting: float, seed: int, steps: float):
    """Run it, unless that was done."""
    name = {"problem": problem.file, "method": method.name, "setting": setting, "seed": seed}
    results.do(name | {"steps": steps}, lambda: run(problem, method, setting, seed, steps))


def runs_of(results: Results, problem: Problem, name: str, **more) -> list[dict]:
    """Return the runs of a method on a problem, by rising seeds."""
    return results.of(problem=problem.file, method=name, **more)


def tune(tried: Results) -> None:
    """Every setting on every problem."""
    for seed in TRIED:
        for problem in PROBLEMS:
            for method in (*METHODS, *MORE):
                for setting in SETTINGS:
                    do(tried, problem, method, setting, seed, problem.tried)


def chosen(tried: Results, problem: Problem, method: Method) -> float:
    """The setting with the best mean in new episodes."""
    name = "CMA-ES" if method is PYCMA else method.name

    def reached(setting: float) -> float:
        return np.mean([r["new"] for r in runs_of(tried, problem, name, setting=setting)])

    return max(SETTINGS, key=reached)


def run_all(tried: Results, done: Results) -> None:
    """Every method with the setting chosen, seed by seed, so that what is there is comparable."""
    for seed in SEEDS:
        for problem in PROBLEMS:
            methods = [*METHODS, PYCMA] if problem.file in WITH_PYCMA else [*METHODS]
            for method in methods + [*MORE] * (seed in MORE_SEEDS):
                setting = chosen(tried, problem, method)
                do(done, problem, method, setting, seed, problem.steps)


def run_longer(tried: Results, longer: Results) -> None:
    """The fast methods with more steps; and xNES on the double pole with pycma's sigma."""
    for seed in SEEDS:
        for problem in PROBLEMS:
            for method in METHODS:
                if problem.file in LONG_PROBLEMS and method.name in LONG_METHODS:
                    setting = chosen(tried, problem, method)
                    do(longer, problem, method, setting, seed, LONGER * problem.steps)
                if (problem.file, method.name) == ("dpole", "xNES"):
                    do(longer, problem, method, chosen(tried, problem, PYCMA), seed, problem.steps)


def load() -> list[Results]:
    """Return the runs that tried settings, those of the best ones, and the longer ones."""
    return [Results(FOLDER / f"{name}.jsonl") for name in ("tried", "runs", "longer")]


def main() -> None:
    """See the top of the file."""
    import algorithms_page

    warnings.simplefilter("ignore")
    tried, done, longer = load()
    tune(tried)
    run_all(tried, done)
    run_longer(tried, longer)
    for page in algorithms_page.pages():
        page.write()
