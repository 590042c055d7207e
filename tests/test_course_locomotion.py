"""What exercise 9 is given: runners, recorded episodes; and that it is graded without PyBullet."""

from pathlib import Path

import numpy as np
import pytest

from botschool import config
from botschool.course import locomotion, recordings
from botschool.course.locomotion import Runner
from botschool.evolution.run import Run, evolve
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.judge.submission import grade

ROOT = Path(__file__).parents[1]
ROBOTS = ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid")


@pytest.fixture
def without_pybullet(monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    monkeypatch.setattr(recordings, "find_spec", lambda name: None)
    monkeypatch.delattr(recordings, "simulated")


def test_robots_are_those_of_the_experiment_file(tmp_path):
    """The same genotype as with `botschool es` and the same steps, but for `pepisodes`."""
    experiment = config.load(ROOT / "data" / "experiments" / "planarhopper.ini")
    experiment.policy.pepisodes = locomotion.POLICY["pepisodes"]
    run = Run(experiment, 5)
    evolve(run, tmp_path, steps=60_000)
    evolved = Runner("PlanarHopper-v5").evolve(60_000, 5)
    assert np.array_equal(evolved, np.load(tmp_path / "bestgS5.npy"))


@pytest.mark.parametrize("seed", [1, 3])
def test_one_stands_and_the_other_hops(seed):
    """What exercise 9 shows, after a fifth of its steps; seed 3's hopper is the worst of ten."""
    metres, grounded = {}, {}
    for version in ("v0", "v5"):
        runner = Runner(f"PlanarHopper-{version}")
        genotype = runner.evolve(1_000_000, seed)
        episodes = [runner.record(genotype, 1000 + i) for i in range(5)]
        ways = [one["distance"] for one in episodes]
        metres[version] = np.mean([way[0] - way[-1] for way in ways])
        grounded[version] = np.mean([one["feet"].mean() for one in episodes])
    assert metres["v5"] > 2 * metres["v0"]
    assert grounded["v0"] > 0.9 and grounded["v5"] < 0.6


@pytest.mark.parametrize("body", ["hopper", "walker2d", "halfcheetah"])
def test_recorded_episodes_add_up(body):
    """Progress is the reward of version 5; in a gait feet leave the ground and come back."""
    name = {"hopper": "Hopper", "walker2d": "Walker2D", "halfcheetah": "HalfCheetah"}[body]
    runner = Runner(f"Planar{name}-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / f"planar{body}.npy")
    one, play = runner.record(genotype, 7, 300), list(runner.play(genotype, 7, 300))
    steps = len(play)
    assert len(one["distance"]) == steps + 1
    assert one["actions"].shape == (steps, runner.policy.spec.outputs)
    assert one["feet"].shape == (steps, 1 if body == "hopper" else 2)
    progress = -np.diff(one["distance"]) / one["duration"]
    if body != "halfcheetah":  # which pays for joints at their limits, too
        np.testing.assert_allclose(progress, [step.reward for step in play], atol=1e-4)
    np.testing.assert_array_equal(one["height"], [step.state[1] for step in play])
    np.testing.assert_array_equal(one["pitch"], [step.state[2] for step in play])
    changes = np.abs(np.diff(one["feet"], axis=0)).sum(axis=0)
    assert set(np.unique(one["feet"])) == {0.0, 1.0} and (changes >= 4).all()


@pytest.mark.parametrize("name", ["PlanarHopper", "PlanarWalker2D", "PlanarHalfCheetah"])
def test_a_foot_is_down_while_the_ground_pushes_it(name):
    runner = Runner(f"{name}-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / f"{name.lower()}.npy")
    scene = runner._scene()
    ((_, feet),) = scene.charted
    shown = [
        [scene.numbers(step.state)[foot] for foot in feet] for step in runner.play(genotype, 3, 200)
    ]
    np.testing.assert_array_equal(runner.record(genotype, 3, 200)["feet"], shown)
    assert len(feet) == 1 or any(left != right for left, right in shown)


@pytest.mark.parametrize("robot", ROBOTS)
def test_recorded_episodes_are_those_of_pybullet(robot, monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    one, other = recordings.recorded(robot), recordings.simulated(robot, 1)
    assert one.trajectory.keys() == other.trajectory.keys()
    for key in one.trajectory.keys() - {"robot"}:
        np.testing.assert_allclose(one.trajectory[key], other.trajectory[key], atol=1e-6)
    assert one.v0.keys() == other.v0.keys()
    for key in one.v0:
        np.testing.assert_allclose(one.v0[key], other.v0[key], atol=1e-4)
    np.testing.assert_allclose(one.v5, other.v5, atol=1e-4)


def test_exercise_9_is_graded_without_pybullet(without_pybullet):
    exercise = load_exercise(9, ROOT)
    assert not exercise.extras
    file = ROOT / "solutions" / "ex09_reward_functions" / "reward_functions.py"
    tasks = [exercise.find(id) for id in ("9.3", "9.4")]
    result = grade(exercise, file, tasks=tasks)
    assert [task.points for task in result.tasks] == [task.max_points for task in tasks]


def test_a_picture_of_gaits_shows_every_robot(tmp_path):
    runner = Runner("PlanarHopper-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / "planarhopper.npy")
    one = runner.record(genotype, 1, 300)
    row = runner.strip(genotype, 1, 200, 5)
    assert row.shape[1] % 5 == 0 and row.std() > 10
    fallen = np.append(np.zeros(runner.size - 11), np.ones(11))  # after 124 steps
    short = runner.strip(fallen, 1, pictures=8)
    assert short.shape[1] == 8 * row.shape[1] // 5 and (short[:, -100:] == 255).all()
    file = tmp_path / "gaits.png"
    income = {"progress": 800.0, "alive": 300.0, "effort": -2.0}
    locomotion.draw_gaits(file, {"a": [one, one]}, {"a": income}, {"a": one}, {"a": row})
    assert file.stat().st_size > 20_000
