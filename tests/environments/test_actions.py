"""Outputs reach the whole range of the actions, or a note says that they do not
(docs/specification.md, "Outputs").
"""

import numpy as np
import pytest
from gymnasium import spaces

import botschool
from botschool import config
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems.spaces import fitted, interface
from running import write_experiment


def actions(space, **hyperparameters):
    """Return the actions that outputs far below and far above 0 give in a new environment."""
    policy = Policy(
        "any",
        interface(1, space, 0, scaled=True),
        config.PolicyConfig(nhiddens=0, **hyperparameters),
    )
    policy.network.parameters[:] = 100
    return [fitted(policy.act(np.array([sign])), space).tolist() for sign in (-1.0, 1.0)]


@pytest.mark.parametrize("out_type", [1, 2, 4])
@pytest.mark.parametrize(
    ("space", "ends"),
    [
        (spaces.Box(0, 100, (1,)), [[0], [100]]),
        (spaces.Box(0, 4, (1,), np.int64), [[0], [4]]),
        (spaces.Box(np.float32([-3, 5]), np.float32([1, 6])), [[-3, 5], [1, 6]]),
        (spaces.Box(0, 255, (1, 2), np.uint8), [[[0, 0]], [[255, 255]]]),
    ],
)
def test_limited_outputs_reach_both_ends(space, ends, out_type):
    np.testing.assert_allclose(actions(space, out_type=out_type), ends, atol=1e-30)


def test_each_whole_number_gets_the_same_share():
    space = spaces.Box(0, 4, (1,), np.int64)
    policy = Policy("any", interface(1, space, 0, scaled=True), config.PolicyConfig(nhiddens=0))
    policy.network.parameters[:] = 1
    outputs = np.arctanh(np.linspace(-0.999, 0.999, 1000))
    given = [int(fitted(policy.act(np.array([x])), space)[0]) for x in outputs]
    assert np.bincount(given).tolist() == [200] * 5


def test_without_limits_outputs_are_taken_as_they_are():
    half = spaces.Box(np.float32([0, -np.inf]), np.float32([10, 5]))
    assert actions(half) == [[0, -1], [10, 1]]
    assert actions(spaces.Box(-1, 1, (1,)), out_type=3) == [[-1], [1]]


def notes(command, folder, environment, **policy):
    ini = write_experiment(folder, environment, policy=policy, maxmsteps=1e-6)
    code, _, errors = command("es", "-f", ini, "-o", folder)
    assert code == 0, errors
    return [line for line in errors.splitlines() if "actions of" in line]


@pytest.mark.parametrize(
    ("environment", "out_type", "says"),
    [
        ("Pendulum-v1", 2, "out_type = 3"),
        ("Pendulum-v1", 3, None),
        ("MountainCarContinuous-v0", 1, "outputs from 0 to 1"),
        ("tiny_envs:Throttle-v0", 3, "out_type = 2"),
        ("tiny_envs:Throttle-v0", 2, None),
        ("tiny_envs:Tiny-v0", 3, None),
    ],
)
def test_a_range_out_of_reach_is_said(environment, out_type, says, command, tmp_path):
    said = notes(command, tmp_path, environment, out_type=out_type)
    assert len(said) == (says is not None) and (not said or says in said[0])


@pytest.fixture
def old(command, tmp_path):
    """A run of a version that took outputs as they were; its experiment file."""
    ini = write_experiment(tmp_path, "tiny_envs:Throttle-v0", maxmsteps=1e-4)
    assert command("es", "-f", ini, "-o", tmp_path)[0] == 0
    path = tmp_path / "checkpointS1.npz"
    with np.load(path) as arrays:
        state = dict(arrays)
    state["botschool"] = np.array(str(state["botschool"]).replace('"scaled": true', '"old": true'))
    np.savez(path, **state)
    return ini


def test_an_older_robot_acts_as_it_did_or_is_refused(old, command, refused, tmp_path):
    robot = tmp_path / "bestgS1.npy"
    refused("es", "-f", old, "-p", "-g", robot, "--render", "none", says=["ClipAction"])
    refused("es", "-f", old, "-o", tmp_path, "--resume", "--generations", 9, says=["--force"])
    with pytest.raises(BotschoolError, match="ClipAction"):
        botschool.load(tmp_path)[0].play()
    text = old.read_text().replace("[POLICY]", "wrappers = ClipAction\n[POLICY]")
    old.write_text(text)
    assert command("es", "-f", old, "-p", "-g", robot, "--render", "none")[0] == 0
    pushed = botschool.problem(old).evaluate(np.load(robot))[0]
    assert pushed != botschool.problem("tiny_envs:Throttle-v0", **FEW).evaluate(np.load(robot))[0]


FEW = {"nhiddens": 3, "maxsteps": 60}
