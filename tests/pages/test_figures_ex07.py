"""The figures of exercise 7: paths are those of the command's pendulum, or of Gymnasium's."""

import gymnasium
import numpy as np

from botschool import _core, config
from botschool.config import from_dict, to_dict
from botschool.evolution.run import Run, evolve
from botschool.problems.native import NativeProblem
from living import ROOT, click, slide

EXPERIMENT = config.load(ROOT / "data/experiments/pendulum.ini")


def path_by_python(start, steps, motor=True, gravity=10.0, saved=None):
    """The states from a start on."""
    problem = NativeProblem("Pendulum-v1")
    policy = problem.policy(EXPERIMENT.policy)
    saved = np.load(ROOT / "data/genotypes/pendulum.npy") if saved is None else saved
    policy.load(*policy.split(saved))
    policy.reset(1, 0)
    stepper = _core.make_stepper(problem.dynamics)
    stepper.set(200)
    stepper.start(1, 0)
    env = gymnasium.make("Pendulum-v1", g=gravity).unwrapped
    env.reset(seed=1)
    found = [np.array(start)]
    for _ in range(steps):
        stepper.state = found[-1]
        action = np.atleast_1d(policy.act(stepper.observation)).astype(float) * motor
        if gravity == 10.0:
            stepper.step(action)
            found.append(stepper.state.copy())
        else:
            env.state = found[-1]
            env.step(action)
            found.append(env.state.copy())
    return np.array(found)


PATH = "figures.plane.state.paths.at(-1)"


def test_a_click_starts_a_path_and_gravity_changes_it(page):
    click(page, "plane", 300, 120)
    [start] = page.run(PATH)
    assert abs(start[0]) < np.pi and abs(start[1]) < 8
    page.run("figures.plane.advance(150)")
    expected = path_by_python(start, 150, motor=False)
    np.testing.assert_array_equal(page.run(PATH), expected)

    page.run("figures.plane.press('motor')")
    assert page.run(PATH) == [start]
    page.run("figures.plane.advance(200)")
    expected = path_by_python(start, 200)
    np.testing.assert_array_equal(page.run(PATH), expected)
    assert "0 degrees is upright" in page.run("figures.plane.canvas.getAttribute('aria-label')")

    slide(page, "plane", "gravity", 15)
    page.run("figures.plane.advance(60)")
    expected = path_by_python(start, 60, gravity=15.0)
    np.testing.assert_allclose(page.run(PATH), expected, rtol=0, atol=1e-6)


def test_evolution_in_the_figure_is_the_command_s(page, tmp_path):
    page.run("figures.stages.advance(3)")
    parts = to_dict(EXPERIMENT)
    parts["algo"]["maxmsteps"] = 0.3
    evolve(Run(from_dict(parts), 1), tmp_path)
    best = np.load(tmp_path / "bestgS1.npy")
    shown = np.array(page.run("[...figures.stages.robot.own]"))
    assert page.run("figures.stages.shown") == 30
    np.testing.assert_array_equal(shown, best)
    paths = page.run("figures.stages.paths")
    np.testing.assert_array_equal(paths[0], path_by_python(paths[0][0], 150, saved=shown))
    slide(page, "stages", "look", 0)
    assert page.run("figures.stages.shown") == 0
