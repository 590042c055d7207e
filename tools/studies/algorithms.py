"""Evolutionary algorithms side by side on native problems, for docs/reports/algorithms.md.

    python tools/studies algorithms tune FOLDER      tries three settings of each, seeds 101 and 102
    python tools/studies algorithms run FOLDER       runs seeds 1 to 10 of the best
    python tools/studies algorithms longer FOLDER    runs some of them four times as long
    python tools/studies algorithms page FOLDER      keeps the results, writes the page's tables

What is stopped goes on where it stopped.

The problem, the policy and the number of candidates are those of the problem's experiment file.
pycma is driven by the same evaluation, if it is installed (it is a dependency of the tests).
"""

from __future__ import annotations

import json
import sys
import time
import warnings
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool import config
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.algorithms.gaussian import Gaussian
from botschool.evolution.run import Run
from botschool.problems import Episodes

EXPERIMENTS = Path(__file__).parents[2] / "data" / "experiments"
NEW_SEED = 2**40
"""New episodes are those of a seed that no run uses."""
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
    genotype, normalisation = run.policy.split(run.record.bestg)
    outcome = run.problem.evaluate(
        run.policy,
        genotype[None],
        normalisation,
        Episodes.of([NEW_SEED + seed], problem.new),
        experiment.policy.maxsteps,
    )
    rows = run.record.rows()
    at = np.searchsorted(rows[:, 0], np.linspace(0, steps * 1e6, POINTS + 1)[1:], side="right") - 1
    return {
        "problem": problem.file,
        "method": method.name,
        "setting": setting,
        "seed": seed,
        "steps": steps,
        "new": round(float(outcome.fitness.mean()), 3),
        "best": round(run.record.bestg_fitness, 3),
        "seconds": round(seconds, 2),
        "curve": [None if i < 0 else round(float(rows[i, 2]), 2) for i in at],
    }


class Results:
    """Runs that are done, a line of JSON each; those of a file are not done again."""

    def __init__(self, path: Path) -> None:
        self.path = path
        lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
        self.runs = [json.loads(line) for line in lines]

    def of(self, problem: str, method: str, **more) -> list[dict]:
        """Runs of a method on a problem, by rising seeds."""
        wanted = {"problem": problem, "method": method} | more
        found = [r for r in self.runs if wanted.items() <= r.items()]
        return sorted(found, key=lambda r: r["seed"])

    def do(self, problem: Problem, method: Method, setting: float, seed: int, steps: float) -> None:
        """Runs it, unless that was done."""
        if self.of(problem.file, method.name, setting=setting, seed=seed, steps=steps):
            return
        done = run(problem, method, setting, seed, steps)
        self.runs.append(done)
        with self.path.open("a", encoding="utf-8") as file:
            file.write(json.dumps(done) + "\n")
        print(*(done[k] for k in ("problem", "method", "setting", "seed", "new", "seconds")))


def tune(tried: Results) -> None:
    """Every setting on every problem."""
    for seed in TRIED:
        for problem in PROBLEMS:
            for method in (*METHODS, *MORE):
                for setting in SETTINGS:
                    tried.do(problem, method, setting, seed, problem.tried)


def chosen(tried: Results, problem: Problem, method: Method) -> float:
    """The setting with the best mean in new episodes."""
    name = "CMA-ES" if method is PYCMA else method.name

    def reached(setting: float) -> float:
        return np.mean([r["new"] for r in tried.of(problem.file, name, setting=setting)])

    return max(SETTINGS, key=reached)


def run_all(tried: Results, done: Results) -> None:
    """Every method with the setting chosen, seed by seed, so that what is there is comparable."""
    for seed in SEEDS:
        for problem in PROBLEMS:
            methods = [*METHODS, PYCMA] if problem.file in WITH_PYCMA else [*METHODS]
            for method in methods + [*MORE] * (seed in MORE_SEEDS):
                setting = chosen(tried, problem, method)
                done.do(problem, method, setting, seed, problem.steps)


def run_longer(tried: Results, longer: Results) -> None:
    """The fast methods with more steps; and xNES on the double pole with pycma's sigma."""
    for seed in SEEDS:
        for problem in PROBLEMS:
            for method in METHODS:
                if problem.file in LONG_PROBLEMS and method.name in LONG_METHODS:
                    setting = chosen(tried, problem, method)
                    longer.do(problem, method, setting, seed, LONGER * problem.steps)
                if (problem.file, method.name) == ("dpole", "xNES"):
                    longer.do(problem, method, chosen(tried, problem, PYCMA), seed, problem.steps)


def main() -> None:
    """See the top of the file."""
    warnings.simplefilter("ignore")
    what, folder = sys.argv[1], Path(sys.argv[2])
    folder.mkdir(parents=True, exist_ok=True)
    tried, done, longer = (Results(folder / f"{n}.jsonl") for n in ("tried", "runs", "longer"))
    if what == "tune":
        tune(tried)
    elif what == "run":
        run_all(tried, done)
    elif what == "longer":
        run_longer(tried, longer)
    else:
        from algorithms_page import write

        write(tried, done, longer)
