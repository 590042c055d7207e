"""SpatialBalanceBot-v0, the native twin of exercise 10's robot, and what stands in for PyBullet."""

from __future__ import annotations

import sys
from pathlib import Path

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core
from botschool.course import stand_in
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.judge.submission import grade

ROOT = Path(__file__).parents[2]
NAME = "SpatialBalanceBot-v0"
ROBOT = (ROOT / "data" / "robots" / "balance_bot.urdf").read_text()
ROUND = ROBOT.replace('<cylinder radius="0.1" length="0.02"/>', '<sphere radius="0.1"/>')
"""The robot with round wheels: of a cylinder PyBullet makes a prism with 32 corners."""
BALANCES = np.array([0.0, -5.0, -4.4, 0.3])


def lean(inclination):
    """A stepper of a robot at rest."""
    stepper = _core.make_stepper(NAME)
    stepper.start(1)
    state = 0 * stepper.state
    state[1:5] = (
        -0.3 * np.sin(inclination), 0.1 + 0.2 * np.cos(inclination),
        np.cos(inclination / 2), np.sin(inclination / 2),
    )  # fmt: skip
    stepper.state = state
    return stepper


def native(inclination, actions):
    """The inclination after each step, until the robot has fallen."""
    stepper, seen = lean(inclination), []
    for action in actions:
        _, ended = stepper.step(np.array([action]))
        seen.append(stepper.observation[0])
        if ended:
            break
    return np.array(seen)


def simulated(bullet, file, inclination, actions):
    """The same in PyBullet, or in what stands in for it."""
    client = bullet.connect(bullet.DIRECT)
    bullet.setGravity(0, 0, -10, physicsClientId=client)
    bullet.setTimeStep(0.01, physicsClientId=client)
    data = "" if bullet is stand_in else pytest.importorskip("pybullet_data").getDataPath() + "/"
    bullet.loadURDF(data + "plane.urdf", physicsClientId=client)
    robot = bullet.loadURDF(
        str(file), [0, 0, 0.001], bullet.getQuaternionFromEuler([inclination, 0, 0]),
        flags=bullet.URDF_USE_INERTIA_FROM_FILE, physicsClientId=client,
    )  # fmt: skip
    speed, seen = 0.0, []
    for action in actions:
        speed = np.clip(speed + np.clip(action, -1, 1), -24.6, 24.6)
        for wheel, target in ((0, speed), (1, -speed)):
            bullet.setJointMotorControl2(
                robot, wheel, bullet.VELOCITY_CONTROL, targetVelocity=target, physicsClientId=client
            )
        bullet.stepSimulation(physicsClientId=client)
        place, turned = bullet.getBasePositionAndOrientation(robot, physicsClientId=client)
        seen.append(bullet.getEulerFromQuaternion(turned)[0])
        if place[2] < 0.15:
            break
    bullet.disconnect(physicsClientId=client)
    return np.array(seen)


def episodes():
    rng = np.random.default_rng(5)
    for number in range(20):
        inclination = rng.uniform(0.02, 0.3) * rng.choice([-1, 1])
        yield inclination, rng.uniform(-0.2, 0.2, 100) * (number % 2)


@pytest.fixture
def round_wheels(tmp_path):
    (tmp_path / "balance_bot.urdf").write_text(ROUND)
    return tmp_path / "balance_bot.urdf"


def test_it_falls_as_in_pybullet(round_wheels):
    """With round wheels: the same inclinations within 5 % of the largest, the same fall."""
    bullet = pytest.importorskip("pybullet")
    for inclination, actions in episodes():
        one = native(inclination, actions)
        other = simulated(bullet, round_wheels, inclination, actions)
        assert abs(len(one) - len(other)) <= 1
        length = min(len(one), len(other))
        apart = np.abs(one[:length] - other[:length])
        reach = np.maximum.accumulate(np.abs(other[:length]))
        assert (apart <= 0.05 * reach).all()


def test_what_stands_in_moves_as_the_native_robot():
    file = ROOT / "data" / "robots" / "balance_bot.urdf"
    for inclination, actions in episodes():
        one = native(inclination, actions)
        other = simulated(stand_in, file, inclination, actions)
        assert abs(len(one) - len(other)) <= 1
        length = min(len(one), len(other))
        assert one[:length] == pytest.approx(other[:length], rel=0.02, abs=2e-3)


def test_what_stands_in_answers_as_pybullet(round_wheels):
    """Orientations, places, speeds; before anything has moved."""
    bullet = pytest.importorskip("pybullet")
    rng = np.random.default_rng(2)
    for _ in range(20):
        angles, place = rng.uniform(-1.5, 1.5, 3), rng.normal(size=3)
        speeds, turning, there = rng.normal(size=(3, 3))
        answers = []
        for each in (bullet, stand_in):
            client = each.connect(each.DIRECT)
            own = {"physicsClientId": client}
            turned = each.getQuaternionFromEuler(angles)
            robot = each.loadURDF(str(round_wheels), place, turned, **own)
            found = [turned, each.getEulerFromQuaternion(turned)]
            found += [each.getMatrixFromQuaternion(turned)]
            found += [*each.getBasePositionAndOrientation(robot, client)]
            each.resetBaseVelocity(robot, speeds, turning, **own)
            found += [*each.getBaseVelocity(robot, client)]
            each.resetBasePositionAndOrientation(robot, there, turned, client)
            found += [*each.getBasePositionAndOrientation(robot, client)]
            found += [(each.getNumJoints(robot, client), each.getNumBodies(client))]
            found += [each.getJointState(robot, 1, client)[:2]]
            each.disconnect(client)
            answers.append(np.concatenate(found))
        assert answers[1] == pytest.approx(answers[0], abs=1e-6)


def test_observation_reward_and_end():
    rng = np.random.default_rng(1)
    for inclination in (0.2, -0.25):
        stepper, target = lean(inclination), 0.0
        assert stepper.observation == pytest.approx([inclination, 0, 0])
        for step in range(80):
            action = 3 * rng.uniform(-1, 1) if step % 2 else 0.5
            target += np.clip(action, -1, 1)
            reward, ended = stepper.step(np.array([action]))
            state = stepper.state
            turned = 2 * np.arctan2(state[4], state[3])
            assert stepper.observation == pytest.approx([turned, state[12], target], abs=1e-5)
            assert reward == pytest.approx(1 - 0.05 * abs(target))
            assert state[15:17] == pytest.approx([target, -target], abs=0.05)  # the wheels
            assert ended == (state[2] < 0.15)
            if ended:
                break
        assert ended
    stepper = lean(0.0)
    for _ in range(40):
        stepper.step(np.array([5.0]))
    assert stepper.observation[2] == 24.6


def test_starts():
    stepper, seen = _core.make_stepper(NAME), []
    for seed in range(500):
        stepper.start(seed)
        assert np.hypot(*stepper.state[3:5]) == pytest.approx(1)
        assert stepper.state[2] == pytest.approx(0.1 + 0.2 * np.cos(stepper.observation[0]))
        assert not stepper.observation[1:].any()
        seen.append(stepper.observation[0])
    high = gymnasium.make(f"botschool/{NAME}").observation_space.high
    assert high[[0, 2]] == pytest.approx([np.pi, 24.6])
    assert np.abs(seen).max() < 0.3 and np.std(seen) == pytest.approx(0.3 / np.sqrt(3), rel=0.05)


def balanced(make, seeds):
    """In how many episodes a linear controller balances for 500 steps."""
    env, good = gymnasium.make(make), 0
    for seed in seeds:
        (seen, _), ends, steps = env.reset(seed=seed), (False, False), 0
        while not any(ends):
            action = np.array([BALANCES[0] + BALANCES[1:] @ seen], np.float32)
            seen, _, *ends, _ = env.step(np.clip(action, -1, 1))
            steps += 1
        good += steps == 500 and not ends[0]
    return good


@pytest.mark.slow
def test_a_controller_balances_in_both():
    assert balanced(f"botschool/{NAME}", range(20)) == 20
    pytest.importorskip("pybullet")
    pytest.importorskip("balance_bot")
    assert balanced("balance_bot:BalanceBotBulletEnv-v0", range(20)) == 20


@pytest.fixture
def without_pybullet(monkeypatch, tmp_path):
    """Exercise 10 as it is graded where PyBullet is not installed."""
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    names = ("pybullet", "pybullet_data")
    text = "import sys\nfrom botschool.course import stand_in\n"
    text += f"sys.modules |= dict.fromkeys({names}, stand_in)\n"
    (folder := tmp_path / "site-packages").mkdir()
    (folder / "hides_pybullet.py").write_text(text)
    monkeypatch.syspath_prepend(folder)
    for name in names:
        monkeypatch.setitem(sys.modules, name, stand_in)
    monkeypatch.delitem(sys.modules, "botschool.course.bullet", raising=False)
    exercise = load_exercise(10, ROOT)
    exercise.imports = ("hides_pybullet",)
    return exercise


SOLUTION = ROOT / "solutions" / "ex10_balance_bot" / "balancing_robot.py"


@pytest.mark.slow
def test_exercise_10_is_graded_without_pybullet(without_pybullet):
    """All tasks but training, which takes half a minute."""
    tasks = without_pybullet.tasks[:-1]
    result = grade(without_pybullet, SOLUTION, tasks=tasks)
    assert [task.points for task in result.tasks] == [task.max_points for task in tasks]
