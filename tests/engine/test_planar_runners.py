"""Hopper, walker and half cheetah as problems: docs/specification.md, "Planar runners"."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.policies.policy import Policy
from botschool.render.replay import write_replay
from botschool.render.scenes import make_scene
from test_replay import held, unpacked

BODIES = {
    "PlanarHopper": "hopper",
    "PlanarWalker2D": "walker2d",
    "PlanarHalfCheetah": "halfcheetah",
}
NAMES = [f"{body}-v{version}" for body in BODIES for version in (0, 5)]
SECONDS = {"PlanarHopper": 0.008, "PlanarWalker2D": 0.008, "PlanarHalfCheetah": 0.05}


class Parts:
    """The parts of a state, and its coordinates and speeds in hinge form."""

    def __init__(self, name, state):
        table = _core.PlanarBody(BODIES[name.split("-")[0]]).table
        self.segments, self.contacts = table["segments"], table["contacts"]
        n = len(self.segments) + 2
        self.position, self.speed, self.load = np.split(state, [n, 2 * n])
        self.angles, self.rates = (
            self._against_parents(self.position),
            self._against_parents(self.speed),
        )

    def _against_parents(self, values):
        result = values.copy()
        for i, segment in enumerate(self.segments[1:], start=1):
            result[2 + i] -= values[2 + segment["parent"]]
        return result

    def at_limit(self):
        count = 0
        for angle, segment in zip(self.angles[3:], self.segments[1:], strict=True):
            low, high = segment["range"]
            count += abs(2 * (angle - low) / (high - low) - 1) > 0.99
        return count

    def fallen(self, name):
        height, pitch = self.position[1], abs(self.position[2])
        if "Hopper" in name:
            return height <= 0.7 or pitch >= 0.2
        if "Walker" in name:
            return not 0.8 < height < 2 or pitch >= 1
        return name.endswith("5") and (pitch >= 1 or self.load[4:].any())


def stepped(name, seed=0, strength=1.0):
    """Steps of an episode with random actions: (state before, action, state, reward, ended)."""
    stepper = _core.make_stepper(name)
    stepper.start(seed)
    rng = np.random.default_rng(seed)
    outputs = len(Parts(name, stepper.state).segments) - 1
    for _ in range(1000):
        before, action = stepper.state, strength * rng.uniform(-1.5, 1.5, outputs)
        reward, ended = stepper.step(action)
        yield before, action, stepper.state, reward, ended
        if ended:
            return


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_rewards_and_ends(name):
    seconds = SECONDS[name.split("-")[0]]
    ends = falls = limits = 0
    for seed in range(20):
        for before, action, state, reward, ended in stepped(name, seed):
            parts = Parts(name, state)
            expected = (state[0] - before[0]) / seconds
            effort = np.sum(np.clip(action, -1, 1) ** 2)
            if name == "PlanarHalfCheetah-v0":
                expected -= 0.1 * effort
            elif name == "PlanarHalfCheetah-v5":
                expected -= 0.1 * parts.at_limit()
            elif name.endswith("0"):
                expected += (not parts.fallen(name)) - 0.001 * effort
            assert reward == pytest.approx(expected, abs=1e-4, rel=1e-4)
            assert ended == parts.fallen(name)
            limits += parts.at_limit()
            falls += parts.fallen(name)
            ends += ended
    assert ends == falls == (0 if name == "PlanarHalfCheetah-v0" else 20)
    assert limits > 0


@pytest.mark.parametrize("name", NAMES)
def test_the_simulation_is_that_of_the_body(name):
    """A step of the problem is so many substeps of `PlanarBody` in single precision."""
    body = _core.PlanarBody(BODIES[name.split("-")[0]])
    seconds = SECONDS[name.split("-")[0]]
    substeps = {"PlanarHopper": 8, "PlanarWalker2D": 16}.get(name.split("-")[0], 25)
    touched = 0
    for before, action, state, _, _ in stepped(name, 5, strength=0.3):
        old, new = Parts(name, before), Parts(name, state)
        inner = np.concatenate([[0], before[1 : 2 * body.size]])
        after, load = body.advance(
            inner, np.clip(action, -1, 1), np.float32(seconds / substeps), substeps, single=True
        )
        q, v = after.reshape(2, -1)
        assert new.position[1:] == pytest.approx(q[1:], abs=1e-5)
        assert new.position[0] - old.position[0] == pytest.approx(q[0], abs=1e-5)
        assert new.speed == pytest.approx(v, abs=1e-3)
        assert new.load == pytest.approx(load, rel=1e-2, abs=1e-2)
        touched += new.load.any()
    assert touched


@pytest.mark.parametrize("name", NAMES)
def test_replays_chart_the_feet_below_the_neurons(name, tmp_path):
    problem = problems.make(name)
    policy = Policy(name, problem.interface, PolicyConfig(nhiddens=5, bias=1))
    steps = list(problem.play(policy, policy.initial(1), None, 3, 0, 60))
    spec = policy.spec
    write_replay(
        tmp_path / "a.html", name, "a robot", [steps], 50.0,
        (spec.inputs, spec.outputs), make_scene(name),
    )  # fmt: skip
    data = held(tmp_path / "a.html")
    feet = [i for i, s in enumerate(Parts(name, steps[0].state).segments) if "foot" in s["name"]]
    assert data["groups"][-1] == ["feet", len(feet)]
    charted = unpacked(data["episodes"][0]["activations"])[:, -len(feet) :]
    down = 0
    for row, step in zip(charted, steps, strict=True):
        parts = Parts(name, step.state)
        touching = {c[0] for c, f in zip(parts.contacts, parts.load, strict=True) if f > 0}
        assert row.round(3).tolist() == [foot in touching for foot in feet]
        down += len(touching)
    assert down
    assert unpacked(data["episodes"][0]["activations"]).shape[1] == sum(
        n for _, n in data["groups"]
    )


# --- The evolved runners of data/genotypes: they run, and still do where physics are finer.


ROOT = Path(__file__).parents[2]
FILES = ["planarhopper", "planarwalker2d", "planarhalfcheetah"]


def evolved(file):
    """The robot that comes with botschool."""
    from planar_runs import Robot

    return Robot(file, np.load(ROOT / "data" / "genotypes" / f"{file}.npy"))


@pytest.mark.usefixtures("studies")
@pytest.mark.parametrize("file", FILES)
def test_they_run_ten_lengths_without_falling(file):
    robot = evolved(file)
    returns, upright = robot.ways(2_000_000, 50)
    assert (returns * robot.seconds > robot.runner.lengths).mean() >= 0.9
    assert upright.mean() >= 0.9


def test_the_pay_for_standing_is_paid_for_each_step_without_a_fall():
    def returns(options):
        problem = problems.make("PlanarHopper-v5", options=options)
        policy = problem.policy(PolicyConfig(nhiddens=5, maxsteps=60))
        batch = problems.Episodes.of(np.array([7], dtype=np.uint64), 3)
        return problem.evaluate(policy, policy.initial(3)[None], None, batch, 60)

    plain, paid = returns(""), returns("alive=0.5")
    assert (paid.steps == plain.steps).all()
    assert np.array_equal(paid.fitness, plain.fitness + 0.5 * (plain.steps - (plain.steps < 60)))
    for options in ("bonus=1", "alive='x'", "alive=1e9"):
        with pytest.raises(problems.BotschoolError):
            problems.make("PlanarHopper-v5", options=options)
