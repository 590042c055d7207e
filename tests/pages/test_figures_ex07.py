"""The figures of exercise 7: paths are those of the command's pendulum, or of Gymnasium's."""

import gymnasium
import numpy as np

from botschool import _core, config
from botschool.config import from_dict, to_dict
from botschool.evolution.run import Run, evolve
from botschool.problems.native import NativeProblem
from living import ROOT, built, click, drag, grip_of, open_figures, slide

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


@built
def test_a_click_starts_a_path_and_gravity_changes_it(browser, tmp_path):
    open_figures(browser, 7, tmp_path)
    click(browser, "plane", 300, 120)
    [start] = browser.run(PATH)
    assert abs(start[0]) < np.pi and abs(start[1]) < 8
    browser.run("figures.plane.advance(150)")
    expected = path_by_python(start, 150, motor=False)
    np.testing.assert_array_equal(browser.run(PATH), expected)

    browser.run("figures.plane.press('motor')")
    assert browser.run(PATH) == [start]
    browser.run("figures.plane.advance(200)")
    expected = path_by_python(start, 200)
    np.testing.assert_array_equal(browser.run(PATH), expected)
    assert "0 degrees is upright" in browser.run("figures.plane.canvas.getAttribute('aria-label')")

    slide(browser, "plane", "gravity", 15)
    browser.run("figures.plane.advance(60)")
    expected = path_by_python(start, 60, gravity=15.0)
    np.testing.assert_allclose(browser.run(PATH), expected, rtol=0, atol=1e-6)
    assert browser.errors == []


@built
def test_the_start_is_dragged(browser, tmp_path):
    open_figures(browser, 7, tmp_path)
    x, y = grip_of(browser, "plane", "start")
    drag(browser, "plane", (x, y), (x - 100, y - 50))
    path = browser.run(PATH)
    np.testing.assert_allclose(grip_of(browser, "plane", "start"), [x - 100, y - 50], atol=0.01)
    np.testing.assert_array_equal(path, path_by_python(path[0], 200, motor=False))
    assert browser.errors == []


@built
def test_evolution_in_the_figure_is_the_command_s(browser, tmp_path):
    open_figures(browser, 7, tmp_path)
    browser.run("figures.stages.advance(3)")
    parts = to_dict(EXPERIMENT)
    parts["algo"]["maxmsteps"] = 0.3
    evolve(Run(from_dict(parts), 1), tmp_path)
    best = np.load(tmp_path / "bestgS1.npy")
    shown = np.array(browser.run("[...figures.stages.robot.own]"))
    assert browser.run("figures.stages.shown") == 30
    np.testing.assert_array_equal(shown, best)
    paths = browser.run("figures.stages.paths")
    np.testing.assert_array_equal(paths[0], path_by_python(paths[0][0], 150, saved=shown))
    slide(browser, "stages", "look", 0)
    assert browser.run("figures.stages.shown") == 0
    assert browser.errors == []
