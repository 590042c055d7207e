"""The chain of BodyBrain as a native problem: docs/specification.md, "PlanarBodyBrain"."""

from __future__ import annotations

import math

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.envs.morphology import decode
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.render.scenes.planar import ChainState
from test_planar_chain import BODIES, RODS, STRAIGHT, start_angles
from test_planar_dynamics import turned

NAME = "PlanarBodyBrain-v0"


# ------------------------------------------------------------------- problem
def stepped(parameters, seed=0, strength=1.0, steps=400):
    """Steps of an episode with random actions: (state before, action, state, reward, ended)."""
    stepper = _core.make_stepper(NAME)
    stepper.set_body(np.asarray(parameters))
    stepper.start(seed)
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        before, action = stepper.state, strength * rng.uniform(-1.5, 1.5, RODS - 1)
        reward, ended = stepper.step(action)
        yield before, action, stepper.state, reward, ended
        if ended:
            return


def torso(parts):
    """The middle of the torso."""
    return parts.rears()[:2].mean(axis=0)


def worth(parts):
    return 130 * torso(parts)[0] / 30 - 5 * abs(parts.position[2])


def test_a_state_holds_body_and_ground():
    stepper = _core.make_stepper(NAME)
    pushed = []
    for seed, p in enumerate((STRAIGHT, *BODIES)):
        stepper.set_body(p)
        stepper.start(seed)
        parts, body = ChainState(stepper.state), decode(p)
        assert parts.lengths == pytest.approx(body.lengths)
        assert parts.thicknesses == pytest.approx(body.thicknesses)
        assert parts.densities == pytest.approx(body.densities)
        assert parts.angles == pytest.approx(body.angles, abs=1e-12)
        limits = np.stack([parts.low, parts.high], axis=1)
        assert limits == pytest.approx(body.limits, abs=1e-12)
        # the ground: even, then slopes that are forgotten slowly and pulled back to height 0
        assert len(parts.heights) == 161 and parts.heights[0] == 0
        slopes = np.diff(parts.heights, prepend=[0.0])
        push = slopes[1:] - 0.8 * slopes[:-1] + 0.01 * np.sign(parts.heights[:-1])
        assert np.all(np.abs(push) < 1 / 15 + 1e-12)
        pushed.append(push)
    assert np.std(pushed) == pytest.approx(1 / 15 / math.sqrt(3), rel=0.1)
    assert len(np.unique(np.round(pushed, 9))) == 4 * 160


def test_starts_stand_above_the_even_ground():
    stepper = _core.make_stepper(NAME)
    for seed, p in enumerate((STRAIGHT, *BODIES)):
        stepper.set_body(p)
        stepper.start(seed)
        parts = ChainState(stepper.state)
        assert not parts.speed.any() and not parts.load.any()
        assert parts.position[2:] == pytest.approx(np.cumsum(start_angles(p)), abs=1e-12)
        rears, radii = parts.rears(), np.repeat(parts.thicknesses, 2) / 2
        ends = np.stack([rears[:-1], rears[1:]], axis=1).reshape(-1, 2)
        left, right = (ends[:, 0] - radii).min(), (ends[:, 0] + radii).max()
        assert (left + right) / 2 == pytest.approx(20 * 14 / 30)
        assert (ends[:, 1] - radii).min() == pytest.approx(0.1)


@pytest.mark.slow
def test_rewards_and_observations():
    touched = 0
    for p in BODIES:
        rest = decode(p).angles
        stepper = _core.make_stepper(NAME)
        for before, _, state, reward, ended in stepped(p, 2):
            parts = ChainState(state)
            gain = worth(parts) - worth(ChainState(before))
            assert reward == pytest.approx(gain, abs=2e-4) and not ended
            stepper.state = state
            angle, turning = parts.position[2], parts.speed[2]
            moving = parts.speed[:2] + turning * turned(0, parts.lengths[0] / 2, angle)
            touching = parts.load.reshape(-1, 2).sum(axis=1) > 0
            hinges = np.stack(
                [np.diff(parts.position[2:]) - rest[1:], np.diff(parts.speed[2:]) / 5], axis=1
            )
            wanted = [
                angle, 0.04 * turning, 0.3 * moving[0], 0.12 * moving[1], touching[0],
                *hinges.ravel(), *touching[1:],
            ]  # fmt: skip
            assert stepper.observation == pytest.approx(np.array(wanted, float), abs=1e-9)
            touched |= touching
    assert np.all(touched)
    low, high = stepper.bounds
    flags = np.r_[4, 25:35]
    assert (low[flags] == 0).all() and (high[flags] == 1).all()
    assert np.isinf(np.delete(low, flags)).all() and np.isinf(np.delete(high, flags)).all()


# ------------------------------------------------------------------ evolution
def policy_of(nhiddens=5):
    problem = problems.make(NAME)
    return problem, Policy(NAME, problem.interface, PolicyConfig(nhiddens=nhiddens, bias=1))


def bodies_of(policy):
    genotypes = np.array([policy.initial(1, i) for i in range(6)])
    genotypes[:, -64:] = np.tile(BODIES, (2, 1))
    genotypes[:, :-64] *= 3
    return genotypes


def test_the_tail_of_a_genotype_is_the_body():
    problem, policy = policy_of()
    assert policy.genotype_size == policy.nparameters + 64
    assert not policy.initial(1)[-64:].any()
    genotypes = bodies_of(policy)
    first = next(problem.play(policy, genotypes[1], None, 7, 2, 50))
    assert ChainState(first.state).lengths == pytest.approx(decode(BODIES[1]).lengths)


def test_a_genotype_without_a_body_is_refused():
    problem, policy = policy_of()
    with pytest.raises(ValueError, match="are needed"):
        problem.engine(policy).record(np.zeros((1, policy.nparameters)), None, 1, 0, 10)


# -------------------------------------------------------------------- pictures
def test_the_environment_takes_another_body():
    env = gymnasium.make(f"botschool/{NAME}", render_mode="rgb_array", morphology=BODIES[0])
    first, frame = env.reset(seed=1)[0], env.render()
    env.unwrapped.set_morphology(BODIES[1])
    assert not np.array_equal(env.reset(seed=1)[0], first)
    assert (env.render() != frame).any()
    for wrong in (np.zeros(63), np.full(64, np.nan), np.zeros((8, 8)), ["a"] * 64):
        with pytest.raises(BotschoolError, match="64 finite numbers"):
            env.unwrapped.set_morphology(wrong)
    env.close()
