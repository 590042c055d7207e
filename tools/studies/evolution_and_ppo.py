"""Evolution beside PPO on eight native problems, for docs/reports/evolution_and_ppo.md.

    python tools/studies evolution_and_ppo     tries settings, runs ten seeds, writes the page

Runs go to data/evolution_and_ppo.jsonl, and those that are there are not done again: what is
stopped goes on where it stopped. Delete the file to begin anew.

Each method gets the same number of random settings, from a few plausible values of each of its
hyperparameters, and tries each on the same two seeds. The best setting runs seeds 1 to 10. This is
done with a budget of seconds of one core, and for evolution again with a budget of steps: as many
as PPO takes in those seconds.
"""

from __future__ import annotations

import time
import warnings
import zlib
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace

import numpy as np
from study import DATA, EXPERIMENTS, NEW_SEED, Results, played

import botschool.evolution.algorithms  # noqa: F401  (fills ALGORITHMS)
from botschool import config
from botschool.evolution.algorithm import ALGORITHMS
from botschool.evolution.run import Run
from botschool.rl.native import PPO

FILE = DATA / "evolution_and_ppo.jsonl"
METHODS = ("OpenAI-ES", "CMA-ES", "ARS", "PPO")
EVOLUTION = METHODS[:3]
SETTINGS = 8
TRIED, SEEDS = (101, 102), tuple(range(1, 11))
TRIED_SHARE = 0.5
"""Of the seconds, in a run that tries a setting."""
POINTS = 12
"""Of a curve, from 3 % of the budget to all of it, equally far apart on a logarithmic axis."""
NEW = 100
"""New episodes in which agents are measured."""
LOOKS = 20
"""Post-evaluations in a training of PPO; evolution does one each generation."""


@dataclass(frozen=True)
class Problem:
    """A native problem, and for how many seconds each method works on it."""

    name: str
    env: str
    file: str
    """Experiment file that says how many episodes a fitness and a post-evaluation average."""
    seconds: float
    kind: str
    memory: bool = False
    """Whether networks that remember are among those that evolution may draw."""


PROBLEMS = (
    Problem("CartPole", "CartPole-v1", "cartpole_openaies", 0.5, "dense"),
    Problem("Pendulum", "Pendulum-v1", "pendulum", 2, "dense"),
    Problem("Acrobot", "Acrobot-v1", "acrobot", 1, "sparse"),
    Problem(
        "MountainCarContinuous", "MountainCarContinuous-v0", "mountaincarcontinuous", 1, "sparse"
    ),
    Problem("Swing-up", "botschool/SwingUp-v0", "swingup", 2, "long"),
    Problem("PlanarHopper-v5", "botschool/PlanarHopper-v5", "planarhopper", 5, "long, dense"),
    Problem("Double pole", "botschool/DoublePole-v0", "dpole", 2, "long, memory", True),
    Problem("Discrim", "botschool/Discrim-v0", "discrim", 1, "long, memory", True),
)


# What settings are drawn from -------------------------------------------------------------------
NETWORKS = {"nhiddens": (0, 10, 20), "normalize": (0, 1), "episodes": (1, 3)}
DRAWN = {
    "OpenAI-ES": {
        "noiseStdDev": (0.02, 0.05, 0.1, 0.2, 0.5), "stepsize": (0.01, 0.03, 0.1),
        "samplesize": (10, 20, 40), "wdecay": (0, 1), **NETWORKS,
    },
    "CMA-ES": {
        "sigma": (0.05, 0.1, 0.2, 0.5, 1.0), "diagonal": (0, 1), "popsize": (20, 40, 80),
        "active": (0, 1), **NETWORKS,
    },
    "ARS": {
        "noiseStdDev": (0.02, 0.05, 0.1, 0.2, 0.5), "stepsize": (0.01, 0.03, 0.1, 0.3),
        "samplesize": (8, 16, 32), "ntop": (0, 8), "nhiddens": (0,), "normalize": (0, 1),
        "episodes": (1, 3),
    },
    "PPO": {
        "learning_rate": (0.0003, 0.001, 0.003), "envs": (16, 32, 64), "n_steps": (32, 128, 256),
        "batch_size": (128, 256), "n_epochs": (4, 10), "gamma": (0.95, 0.98, 0.99, 0.999),
        "gae_lambda": (0.8, 0.95), "ent_coef": (0.0, 0.01), "normalize": (0, 1), "width": (32, 64),
    },
}  # fmt: skip
"""The values that each hyperparameter is drawn from, all equally likely."""
MEMORY = (0, 1, 3)
"""Architectures on the problems with memory: feed-forward, recurrent, LSTM."""


def drawn(problem: Problem, method: str, number: int) -> dict:
    """A random setting: the same one whenever it is asked for."""
    rng = np.random.default_rng([zlib.crc32(f"{problem.name} {method}".encode()), number])
    chosen = {n: values[rng.integers(len(values))] for n, values in DRAWN[method].items()}
    if method != "PPO":
        chosen["architecture"] = MEMORY[rng.integers(len(MEMORY))] if problem.memory else 0
        if method == "ARS" or chosen["nhiddens"] == 0:
            chosen["architecture"] = 0
    return chosen


# A run -------------------------------------------------------------------------------------------
@dataclass(frozen=True)
class Budget:
    """Where a run ends: after seconds of one core, or after steps."""

    unit: str
    size: float


class Curve:
    """Measures an agent in new episodes at the points of a budget; this takes no time of it."""

    def __init__(self, budget: Budget, measure: Callable[[], float]) -> None:
        self.budget, self.measure = budget, measure
        self.points = budget.size * np.geomspace(0.03, 1, POINTS)
        self.found: list[float] = []
        self.start, self.aside = time.process_time(), 0.0

    @property
    def seconds(self) -> float:
        return time.process_time() - self.start - self.aside

    def used(self, steps: int) -> float:
        """Of the budget."""
        return steps if self.budget.unit == "steps" else self.seconds

    def look(self, steps: int) -> bool:
        """Measures if a point has been passed; returns whether the budget is used up."""
        used, begun = self.used(steps), time.process_time()
        value = None
        while len(self.found) < POINTS and used >= self.points[len(self.found)]:
            value = self.measure() if value is None else value
            self.found.append(round(value, 3))
        self.aside += time.process_time() - begun
        return used >= self.budget.size


def evolved(problem: Problem, method: str, setting: dict, seed: int, budget: Budget) -> dict:
    """A run of evolution: the best robot by post-evaluation is the one that is measured."""
    of = config.load(EXPERIMENTS / f"{problem.file}.ini")
    setting = dict(setting)
    policy = replace(
        of.policy, winit=1, bias=1, nlayers=1, action_noise=0, clip=setting["normalize"],
        **{n: setting.pop(n) for n in ("nhiddens", "normalize", "episodes", "architecture")},
    )  # fmt: skip
    algo = ALGORITHMS[method].config(**setting)
    algo.maxmsteps = 1e6
    run = Run(replace(of, exp=replace(of.exp, algo=method), policy=policy, algo=algo), seed)
    known: dict[bytes, float] = {}

    def measure() -> float:
        saved = run.record.bestg if run.record.bestg is not None else run.initial()
        key = np.asarray(saved).tobytes()
        if key not in known:
            known[key] = float(played(run, saved, NEW_SEED + seed, NEW).fitness.mean())
        return known[key]

    curve = Curve(budget, measure)
    while not curve.look(run.record.steps):
        run.advance()
    return {"steps": run.record.steps, "seconds": round(curve.seconds, 3), "curve": curve.found}


def trained(problem: Problem, setting: dict, seed: int, budget: Budget) -> dict:
    """A training of PPO: the best agent by post-evaluation is the one that is measured.

    Post-evaluations take time and steps of the budget, as those of evolution do.
    """
    of = config.load(EXPERIMENTS / f"{problem.file}.ini").policy
    setting = dict(setting)
    envs, normalize = setting.pop("envs"), bool(setting.pop("normalize"))
    setting["net_arch"] = [setting.pop("width")] * 2
    setting["learning_rate"] = f"linear {setting['learning_rate']}"
    ppo = PPO(problem.env, seed, envs, normalize, **setting)
    best, extra, looks = (-np.inf, ppo.parameters.copy(), ppo.core.observed), 0, 0

    def measure() -> float:
        now = ppo.parameters.copy(), ppo.core.observed
        ppo.parameters[:], ppo.core.observed = best[1:]
        numbers = np.arange(NEW, dtype=np.uint32)
        found = ppo.core.play(np.full(NEW, NEW_SEED + seed, dtype=np.uint64), numbers)[0].mean()
        ppo.parameters[:], ppo.core.observed = now
        return float(found)

    curve = Curve(budget, measure)
    while not curve.look(ppo.steps + extra):
        ppo.collect()
        share = min(1.0, curve.used(ppo.steps + extra) / budget.size)
        ppo.total_timesteps = max(ppo.steps, round(ppo.steps / max(share, 1e-9)))
        ppo.update()
        share = curve.used(ppo.steps + extra) / budget.size
        if share * LOOKS >= looks + 1:
            looks = int(share * LOOKS)
            first = NEW_SEED // 2 + 1000 * looks
            returns, lengths = ppo.play(range(first, first + of.pepisodes))
            extra += int(lengths.sum())
            if returns.mean() >= best[0]:
                best = float(returns.mean()), ppo.parameters.copy(), ppo.core.observed
    return {"steps": ppo.steps + extra, "seconds": round(curve.seconds, 3), "curve": curve.found}


# The study ---------------------------------------------------------------------------------------
def do(results: Results, problem: Problem, method: str, setting: int, seed: int, budget: Budget):
    """Run it, unless that was done."""
    name = {"problem": problem.name, "method": method, "setting": setting, "seed": seed}

    def run() -> dict:
        chosen = drawn(problem, method, setting)
        if method == "PPO":
            done = trained(problem, chosen, seed, budget)
        else:
            done = evolved(problem, method, chosen, seed, budget)
        # of a run that tries a setting, only the end counts
        return done | {"curve": done["curve"][-1:]} if seed in TRIED else done

    results.do(name | asdict(budget), run)


def chosen(results: Results, problem: Problem, method: str, unit: str) -> int:
    """Return the number of the setting with the best mean in new episodes."""

    def reached(number: int) -> float:
        runs = results.of(problem=problem.name, method=method, unit=unit, setting=number)
        return np.mean([r["curve"][-1] for r in runs if r["seed"] in TRIED])

    return max(range(SETTINGS), key=reached)


def best(results: Results, problem: Problem, method: str, unit: str) -> list[dict]:
    """Return the runs of the setting chosen; PPO's of seconds stand for both units."""
    unit = "seconds" if method == "PPO" else unit
    runs = results.of(problem=problem.name, method=method, unit=unit)
    return [run for run in runs if run["seed"] in SEEDS]


def steps_of_ppo(results: Results, problem: Problem) -> int:
    """Return how many PPO takes in the seconds: the median of its runs, in thousands."""
    taken = [run["steps"] for run in best(results, problem, "PPO", "seconds")]
    return int(round(np.median(taken), -3))


def study(results: Results) -> None:
    """PPO first, for its steps are the other budget of evolution."""
    for method in EVOLUTION:  # what is loaded late does not count
        evolved(PROBLEMS[0], method, drawn(PROBLEMS[0], method, 0), 1, Budget("steps", 1000))
    for problem in PROBLEMS:
        for unit, methods in (("seconds", ("PPO", *EVOLUTION)), ("steps", EVOLUTION)):
            whole = problem.seconds if unit == "seconds" else steps_of_ppo(results, problem)
            tried = TRIED_SHARE * whole if unit == "seconds" else whole
            for method in methods:
                for number in range(SETTINGS):
                    for seed in TRIED:
                        do(results, problem, method, number, seed, Budget(unit, tried))
                number = chosen(results, problem, method, unit)
                for seed in SEEDS:
                    do(results, problem, method, number, seed, Budget(unit, whole))


def main() -> None:
    """See the top of the file."""
    import evolution_and_ppo_page

    warnings.simplefilter("ignore")
    study(Results(FILE))
    for page in evolution_and_ppo_page.pages():
        page.write()
