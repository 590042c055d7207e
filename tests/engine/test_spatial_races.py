"""Ant and humanoid in space as problems: docs/specification.md, "Bodies in space"."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes

NAMES = [
    "SpatialAnt-v0",
    "SpatialAnt-v5",
    "SpatialHumanoid-v0",
    "SpatialHumanoid-v5",
    "SpatialHumanoidStandup-v0",
]
PLAIN = {
    "Humanoid": {
        f"include_{part}_in_observation": False
        for part in ("cinert", "cvel", "qfrc_actuator", "cfrc_ext")
    },
    "Ant": {"include_cfrc_ext_in_observation": False},
}
PLAIN["HumanoidStandup"] = PLAIN["Humanoid"]
ALL = "vary='ground, mass, motors, delay, noise', bumps=0.03, slope=0.05, step=0.02"


def twin(name):
    """Gymnasium's environment, without the observations that Gymnasium can leave out."""
    pytest.importorskip("mujoco")
    body = name.removeprefix("Spatial").split("-")[0]
    return gymnasium.make(f"{body}-v5", **PLAIN[body]).unwrapped


def stepped(name, seed=0, strength=1.0, steps=60):
    """Steps of an episode with random actions: (state before, action, state, reward, ended)."""
    stepper = _core.make_stepper(name)
    stepper.start(seed)
    info = problems.native.INFOS[name]
    rng = np.random.default_rng(seed)
    for _ in range(steps):
        before = stepper.state
        action = strength * info["high"] * rng.uniform(-1, 1, info["outputs"])
        reward, ended = stepper.step(action)
        yield before, action, stepper.state, reward, ended
        if ended:
            return


@pytest.mark.parametrize("name", NAMES)
def test_observations_are_gymnasiums(name):
    env = twin(name)
    stepper = _core.make_stepper(name)
    for _, _, state, _, _ in stepped(name, 3):
        stepper.state = state
        env.set_state(state[: env.model.nq], state[env.model.nq :][: env.model.nv])
        assert stepper.observation == pytest.approx(env._get_obs(), abs=1e-12)
    assert (env.action_space.low == problems.native.INFOS[name]["low"]).all()
    assert env.dt == pytest.approx(problems.native.INFOS[name]["seconds"])


def centre(env, state):
    import mujoco

    env.set_state(state[: env.model.nq], state[env.model.nq :][: env.model.nv])
    mujoco.mj_forward(env.model, env.data)
    return env.data.subtree_com[1][0]


@pytest.mark.parametrize("name", NAMES)
def test_rewards_and_ends_are_gymnasiums(name):
    """Without the price of contact forces; version 5: progress alone."""
    env = twin(name)
    ends = 0
    for seed in range(4):
        for before, action, state, reward, ended in stepped(name, seed, steps=200):
            env.set_state(state[: env.model.nq], state[env.model.nq :][: env.model.nv])
            env.data.ctrl[:] = action
            healthy = getattr(env, "is_healthy", True)
            if name.endswith("v5"):
                wanted = (state[0] - before[0]) / env.dt
            elif "Standup" in name:
                wanted = env._get_rew(state[2], action)[0]
            elif "Humanoid" in name:
                earlier = centre(env, before)
                wanted, terms = env._get_rew((centre(env, state) - earlier) / env.dt, action)
                wanted -= terms["reward_contact"]
            else:
                wanted, terms = env._get_rew((state[0] - before[0]) / env.dt, action)
                wanted -= terms["reward_contact"]
            assert reward == pytest.approx(wanted, abs=2e-3, rel=1e-4)
            assert ended == (not healthy)
            ends += ended
    assert ends == (4 if "Humanoid-" in name else 0)


@pytest.mark.parametrize("name", NAMES)
def test_starts_are_gymnasiums_within_the_limits_of_hinges(name):
    """The quaternion has the length 1, and no hinge starts beyond its limits."""
    noise = 0.1 if "Ant" in name else 0.01
    height = {"SpatialAnt": 0.75, "SpatialHumanoid": 1.4}.get(name.split("-")[0], 0.105)
    body = _core.SpatialBody(name.removeprefix("Spatial").split("-")[0].lower())
    low, high = np.array([link["range"] for link in body.table["links"][1:]]).T
    stepper = _core.make_stepper(name)
    rows = []
    for seed in range(500):
        stepper.start(seed)
        rows.append(stepper.state)
    rows = np.array(rows)
    n = body.coordinates
    assert rows[:, 2] == pytest.approx(height, abs=noise)
    assert np.linalg.norm(rows[:, 3:7], axis=1) == pytest.approx(1)
    assert (rows[:, 7:n] >= low).all() and (rows[:, 7:n] <= high).all()
    speeds = rows[:, n : n + body.speeds]
    gaussian = "Ant" in name
    assert speeds.std() == pytest.approx(noise if gaussian else noise / np.sqrt(3), rel=0.05)
    assert (np.abs(speeds).max() > noise) == gaussian
    assert not rows[:, n + body.speeds :].any()


@pytest.mark.parametrize("name", NAMES)
def test_the_simulation_is_that_of_the_body(name):
    """A step of the problem is so many substeps of `SpatialBody` in single precision."""
    body = _core.SpatialBody(name.removeprefix("Spatial").split("-")[0].lower())
    seconds = problems.native.INFOS[name]["seconds"]
    substeps = 10 if "Ant" in name else 5
    for before, action, state, _, _ in stepped(name, 5, strength=0.3):
        after = body.advance(before, action, np.float32(seconds / substeps), substeps, single=True)
        n = body.coordinates
        assert state[:n] == pytest.approx(after[:n], abs=1e-4)
        assert state[n : n + body.speeds] == pytest.approx(
            after[n : n + body.speeds], abs=2e-2, rel=1e-3
        )


def evaluated(name, options, instruction_set="", workers=1, candidates=20):
    problem = problems.native.NativeProblem(name, instruction_set=instruction_set, options=options)
    policy = Policy(name, problem.interface, PolicyConfig(nhiddens=5, bias=1))
    genotypes = np.array([policy.initial(seed) for seed in range(candidates)])
    episodes = Episodes.of(np.arange(candidates), 2)
    return problem.evaluate(policy, genotypes, None, episodes, 120, workers)


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("SpatialAnt-v5", ALL),
        ("SpatialHumanoid-v5", ALL),
        ("SpatialBalanceBot-v0", "vary='ground, mass, motors, delay, noise', bumps=0.01"),
    ],
)
def test_instruction_sets_and_workers_do_not_show(name, options):
    """Without options: test_engine.py."""
    first = evaluated(name, options)
    assert len(set(first.fitness)) > 20
    for instruction_set in _core.instruction_sets():
        for workers in (1, 2):
            other = evaluated(name, options, instruction_set, workers)
            assert other.fitness.tobytes() == first.fitness.tobytes()
            assert (other.steps == first.steps).all()


def test_episodes_do_not_depend_on_their_neighbours():
    """A ball that touches the ground in one lane changes no bit in another."""
    alone = evaluated("SpatialAnt-v5", ALL, candidates=1)
    among = evaluated("SpatialAnt-v5", ALL, candidates=37)
    assert alone.fitness.tobytes() == among.fitness[:2].tobytes()


@pytest.mark.parametrize("name", ["SpatialAnt-v5", "PlanarHopper-v5", "PlanarHalfCheetah-v0"])
@pytest.mark.parametrize("vary", ["ground", "mass", "motors", "delay", "noise"])
def test_each_variation_changes_episodes(name, vary):
    plain, varied = evaluated(name, ""), evaluated(name, f"vary='{vary}'")
    changed = (plain.fitness != varied.fitness).mean()
    assert changed > (0.25 if vary == "delay" else 0.8)
    for instruction_set in _core.instruction_sets():
        again = evaluated(name, f"vary='{vary}'", instruction_set)
        assert again.fitness.tobytes() == varied.fitness.tobytes()


def test_alive_is_paid_in_space():
    plain, paid = evaluated("SpatialHumanoid-v5", ""), evaluated("SpatialHumanoid-v5", "alive=2")
    stood = plain.steps - (plain.steps < 120)
    assert paid.fitness == pytest.approx(plain.fitness + 2 * stood)


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("SpatialAnt-v5", "slop=1", "did you mean slope"),
        ("SpatialAnt-v5", "slope='a'", "a number from -1 to 1"),
        ("SpatialAnt-v5", "bumps=7", "a number from 0 to 0.2"),
        ("SpatialAnt-v5", "slope=True", "a number from -1 to 1"),
        ("SpatialAnt-v5", "vary='gravity'", "some of ground, mass"),
        ("SpatialAnt-v5", "vary=3", "some of ground, mass"),
        ("SpatialHumanoidStandup-v0", "urdf='a.urdf'", "no option 'urdf'"),
        ("PlanarHopper-v5", "slope=1", "no option 'slope'"),
        ("CartPole-v1", "slope=1", "takes no options"),
        ("SpatialBody-v0", "seconds=0.01", "add robot="),
        ("SpatialBody-v0", "robot=3", "no path of a file"),
        ("SpatialBody-v0", "robot='no.npz'", "cannot be read"),
        ("SpatialBody-v0", "urdf='no.npz', substep=0.01, seconds=0.001", "above seconds"),
    ],
)
def test_wrong_options_are_said(name, options, says):
    with pytest.raises(BotschoolError, match=says):
        problems.make(name, options=options)
