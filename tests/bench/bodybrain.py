"""Where the time of a BodyBrain step goes, and what share of it is Box2D itself."""

from __future__ import annotations

import time
from importlib.util import find_spec
from pathlib import Path

import numpy as np
from report import Table, rate
from speed import Around, rates

from botschool import config
from botschool.policies.policy import Policy
from botschool.problems import make

ROOT = Path(__file__).parents[2]
STEPS = 200
ENVIRONMENT = "botschool/BodyBrain-v0"


class Profile:
    """Plays the same episode again and again; of each step it keeps the shortest times.

    `box2d` is b2World.Step alone, `env` the whole env.step of the bare environment (so with
    Box2D), `evaluation` a step of the whole evaluation: policy, Gymnasium's wrappers and checks.
    All in seconds a step.
    """

    def __init__(self, genotype: np.ndarray, repetitions: int) -> None:
        experiment = config.load(ROOT / "data" / "experiments" / "bodybrain.ini")
        self.problem = make(experiment.exp.environment)
        self.policy = Policy(self.problem.name, self.problem.interface, experiment.policy)
        self.robot = self.policy.split(genotype)
        turns = [self._turn() for _ in range(repetitions)]
        shortest = np.min(turns, axis=0)
        self.evaluation, self.env, self.box2d = shortest.mean(axis=1)
        self.problem.close()

    def _turn(self) -> np.ndarray:
        """Times of each step, shape (3, STEPS)."""
        env = self.problem._env.unwrapped
        times: dict[str, list[float]] = {"env": [], "box2d": []}
        step, advance = env.step, env._advance

        def timed_step(action):
            start = time.perf_counter()
            result = step(action)
            times["env"].append(time.perf_counter() - start)
            return result

        def timed_advance(action):
            if not isinstance(env._world, Watched):
                env._world = Watched(env._world, times["box2d"])
            advance(action)

        env.step, env._advance = timed_step, timed_advance
        whole = []
        try:
            episode = self.problem.play(self.policy, *self.robot, 1, 0, STEPS)
            start = time.perf_counter()
            for _ in episode:
                whole.append(time.perf_counter() - start)
                start = time.perf_counter()
        finally:
            del env.step, env._advance
        return np.array([whole, times["env"], times["box2d"]])


class Watched:
    """A world whose steps are timed."""

    def __init__(self, world, seconds: list[float]) -> None:
        self.world, self.seconds = world, seconds

    def Step(self, *arguments) -> None:  # noqa: N802
        start = time.perf_counter()
        self.world.Step(*arguments)
        self.seconds.append(time.perf_counter() - start)


def bodybrain(repetitions: int) -> Table:
    """Box2D, the environment around it, and the evaluation around that."""
    table = Table(
        "A step of BodyBrain, one core",
        f"Microseconds a step over an episode of {STEPS} steps; of each step its shortest time in "
        f"{repetitions} turns. Box2D: b2World.Step alone, with 180 velocity and 60 position "
        "iterations. Environment: what env.step does besides. Evaluation: network and Gymnasium's "
        "wrappers. The straight body lies on the ground with all its segments.",
        ["robot", "Box2D", "environment", "evaluation", "Box2D's share", "steps/s"],
    )
    if find_spec("Box2D") is None:
        table.add("Box2D is not installed", *["-"] * 5)
        return table
    for name, genotype in _robots().items():
        found = Profile(genotype, repetitions)
        table.add(
            name,
            f"{1e6 * found.box2d:.0f}",
            f"{1e6 * (found.env - found.box2d):.0f}",
            f"{1e6 * (found.evaluation - found.env):.0f}",
            f"{100 * found.box2d / found.evaluation:.0f} %",
            rate(1 / found.evaluation),
        )
    return table


def _robots() -> dict[str, np.ndarray]:
    """The straight body that evolution starts from, and evolved ones."""
    evolved = sorted((ROOT / "data" / "genotypes").glob("bodybrain*.npy"))
    robots = {path.stem: np.load(path) for path in evolved}
    size = 46 * 50 + 10 + 64
    return {"straight body": np.concatenate([np.zeros(size + 35), np.ones(35)]), **robots}


def chains(seconds: float, repetitions: int) -> Table:
    """The native chain beside Box2D's."""
    table = Table(
        "BodyBrain's chain, native and in Box2D, one core",
        f"Steps/s of policy and problem: candidates around the evolved robot (noise 0.02), an "
        f"episode of 400 steps each; best of {repetitions} interleaved repetitions, in processor "
        "time.",
        ["planarbodybrain.ini", "bodybrain.ini (Box2D)", "ratio"],
    )
    players = [Around("planarbodybrain", 64).evaluate]
    if find_spec("Box2D"):
        players.append(Around("bodybrain", 2).evaluate)
    best = [max(found) for found in rates(players, seconds, repetitions)]
    if len(best) == 1:
        table.add(rate(best[0]), "-", "-")
    else:
        table.add(rate(best[0]), rate(best[1]), f"{best[0] / best[1]:.0f}")
    return table


if __name__ == "__main__":
    bodybrain(30).show(markdown=False)
