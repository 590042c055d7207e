"""What the planar runners reach over several seeds, and how they run: a part of results.py.

Every run is that of `botschool es -f FILE -s SEED`, two of them side by side, on a core each. Their
files stay in results/planar, for films and replays (`botschool es -f FILE -p -g GENOTYPE --video`).
"""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import partial

import numpy as np
from evolved import whole
from study import EXPERIMENTS, NEW_SEED, ROOT, side_by_side

from botschool import _core, config, problems
from botschool.policies.policy import Policy
from botschool.problems import Episodes

KEPT = ROOT / "results" / "planar"
NEW, FINER = 50, 5
"""New episodes, and how many of them are run again in finer steps."""
STEPS = 1000
GAIT = 2.0
"""Seconds of a gait diagram, from the middle of an episode."""


@dataclass
class Runner:
    """A planar body and its problem (docs/specification.md, "Planar runners")."""

    body: str
    lengths: float
    """Ten body lengths, m."""
    substep: float
    substeps: int

    def fallen(self, state: np.ndarray, load: np.ndarray) -> bool:
        """Whether an episode of version 5 ends."""
        height, pitch = state[1], abs(state[2])
        if self.body == "hopper":
            return height <= 0.7 or pitch >= 0.2
        if self.body == "walker2d":
            return not 0.8 < height < 2 or pitch >= 1
        return bool(pitch >= 1 or load[4:].any())


RUNNERS = {
    "planarhopper": Runner("hopper", 12.5, 0.001, 8),
    "planarwalker2d": Runner("walker2d", 12.5, 0.0005, 16),
    "planarhalfcheetah": Runner("halfcheetah", 10, 0.002, 25),
}
"""By the names of their experiment files."""


class Robot:
    """An evolved runner: `saved` is its genotype as a run saves it."""

    def __init__(self, file: str, saved: np.ndarray) -> None:
        experiment = config.load(EXPERIMENTS / f"{file}.ini")
        self.runner = RUNNERS[file]
        self.body = _core.PlanarBody(self.runner.body)
        self.segments = self.body.table["segments"]
        self.problem = problems.of(experiment)
        self.policy = Policy(self.problem.name, self.problem.interface, experiment.policy)
        self.genotype, self.normalisation = self.policy.split(saved)
        self.seconds = self.runner.substep * self.runner.substeps

    def ways(self, seed: int, episodes: int) -> tuple[np.ndarray, np.ndarray]:
        """Returns of new episodes, and which of them ended without a fall."""
        outcome = self.problem.evaluate(
            self.policy, self.genotype[None], self.normalisation, Episodes.of([seed], episodes),
            STEPS,
        )  # fmt: skip
        return outcome.fitness, outcome.steps == STEPS

    def way(self, seed: int, episode: int, finer: int, steps: int = STEPS) -> float:
        """Metres until a fall in an episode, in double precision, with substeps divided by this."""
        stepper = _core.make_stepper(self.problem.name)
        stepper.start(seed, episode)
        state = stepper.state[: 2 * self.body.size]
        start, runner = state[0], self.runner
        self.policy.load(self.genotype, self.normalisation)
        self.policy.reset(seed, episode)
        for _ in range(steps):
            action = np.clip(self.policy.act(self._observation(state)), -1, 1)
            state, load = self.body.advance(
                state, action, runner.substep / finer, runner.substeps * finer
            )
            if runner.fallen(state, load):
                break
        return float(state[0] - start)

    def _observation(self, state: np.ndarray) -> np.ndarray:
        rows = state.reshape(2, -1)
        relative = rows.copy()
        for i, segment in enumerate(self.segments[1:], start=3):
            relative[:, i] -= rows[:, 2 + segment["parent"]]
        return np.concatenate([relative[0, 1:], np.clip(relative[1], -10, 10)])

    def gait(self, seed: int) -> dict[str, str]:
        """Foot -> "1" or "0" for each step, whether it touches the ground."""
        contacts = [c[0] for c in self.body.table["contacts"]]
        steps = self.problem.play(self.policy, self.genotype, self.normalisation, seed, 0, STEPS)
        loads = np.array([step.state[-len(contacts) :] for step in steps])
        middle = loads[len(loads) // 2 :][: round(GAIT / self.seconds)]
        found = {}
        for i, segment in enumerate(self.segments):
            if segment["name"].endswith("foot"):
                own = [c for c, of in enumerate(contacts) if of == i]
                found[segment["name"]] = "".join("01"[int(row[own].any())] for row in middle > 0)
        return found


def run(file: str, steps: float, seed: int) -> dict:
    """One whole run, of at most that many million steps."""
    folder = KEPT / file
    folder.mkdir(parents=True, exist_ok=True)
    run, found = whole(file, steps, seed, folder)
    robot = Robot(file, run.record.bestg)
    new = NEW_SEED + seed
    returns, upright = robot.ways(new, NEW)
    ways = returns * robot.seconds
    finer = [[robot.way(new, e, part) for e in range(FINER)] for part in (1, 2)]
    return {
        "seed": seed,
        "best": round(found["best"], 1),
        "new": round(float(returns.mean()), 1),
        "metres": round(float(ways.mean()), 2),
        "upright": float(upright.mean()),
        "lengths": float((ways > robot.runner.lengths).mean()),
        "finer": np.round(np.mean(finer, axis=1), 2).tolist(),
        "gait": robot.gait(new),
        "seconds": round(found["seconds"], 1),
        "curve": found["curve"],
    }


def planar_runs(seeds: range, steps: float = float("inf")) -> dict:
    """{file: {"steps", "minutes", "runs"}} of the planar runners, with these seeds."""
    found = {}
    for file in RUNNERS:
        experiment = config.load(EXPERIMENTS / f"{file}.ini")
        start = time.monotonic()
        runs = side_by_side(partial(run, file, steps), seeds)
        found[file] = {
            "steps": min(steps, experiment.algo.maxmsteps),
            "minutes": round((time.monotonic() - start) / 60, 1),
            "runs": runs,
        }
        print(file, *(f"{each['metres']:.1f}" for each in runs), flush=True)
    return found
