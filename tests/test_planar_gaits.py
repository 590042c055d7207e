"""The evolved runners of data/genotypes: they run, and still do where physics are finer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from botschool import _core, config, problems
from botschool.policy import Policy
from botschool.problems import Episodes

DATA = Path(__file__).parents[1] / "data"
SUBSTEPS = {"hopper": (0.001, 8), "walker2d": (0.001, 8), "halfcheetah": (0.002, 25)}


class Evolved:
    """The robot that comes with botschool."""

    def __init__(self, body):
        experiment = config.load(DATA / "experiments" / f"planar{body}.ini")
        self.body = _core.PlanarBody(body)
        self.problem = problems.of(experiment)
        self.policy = Policy(self.problem.name, self.problem.interface, experiment.policy)
        saved = np.load(DATA / "genotypes" / f"planar{body}.npy")
        self.genotype, self.normalisation = self.policy.split(saved)

    def returns(self, episodes):
        """Of new episodes, with their steps."""
        outcome = self.problem.evaluate(
            self.policy,
            self.genotype[None],
            self.normalisation,
            Episodes.of(np.array([2_000_000]), episodes),
            1000,
        )
        return outcome.fitness, outcome.steps

    def distance(self, steps, finer):
        """Metres, in double precision, with substeps divided by `finer`."""
        stepper = _core.make_stepper(self.problem.name)
        stepper.start(1, 0)
        n = self.body.size
        start = stepper.state
        state = np.concatenate([start[: 2 * n], np.zeros(n)])
        h, count = SUBSTEPS[self.body.table["name"]]
        self.policy.load(self.genotype, self.normalisation)
        self.policy.reset(1, 0)
        for _ in range(steps):
            action = np.clip(self.policy.act(self.observation(state)), -1, 1)
            state, _ = self.body.advance(state, action, h / finer, count * finer)
        return state[0] - start[0]

    def observation(self, state):
        n = self.body.size
        relative = state[: 2 * n].reshape(2, n).copy()
        for i, segment in enumerate(self.body.table["segments"][1:], start=3):
            relative[:, i] -= state[: 2 * n].reshape(2, n)[:, 2 + segment["parent"]]
        return np.concatenate([relative[0, 1:], np.clip(relative[1], -10, 10)])


@pytest.mark.parametrize(
    ("body", "metres"), [("hopper", 12.5), ("walker2d", 12.5), ("halfcheetah", 100)]
)
def test_they_run_ten_lengths(body, metres):
    fitness, _ = Evolved(body).returns(50)
    seconds = 0.05 if body == "halfcheetah" else 0.008
    assert (fitness * seconds > metres).mean() >= 0.9


@pytest.mark.parametrize("body", SUBSTEPS)
def test_the_gait_stays_with_half_the_substep(body):
    evolved = Evolved(body)
    coarse, fine = (evolved.distance(300, finer) for finer in (1, 2))
    assert fine == pytest.approx(coarse, rel=0.1)
