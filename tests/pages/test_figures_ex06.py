"""The figure of exercise 6: blinded, cut, frozen and moved, it is the command's Khepera."""

import numpy as np

from botschool import _core, config
from botschool.problems.native import NativeProblem
from living import ROOT, built, click, drag, focus, grip_of, open_figures

EXPERIMENT = config.load(ROOT / "data/experiments/discrim.ini")
SAVED = np.load(ROOT / "data/genotypes/discrim.npy")


class Khepera:
    """An episode of post-evaluation of seed 1, as Python steps it."""

    def __init__(self, episode=0):
        problem = NativeProblem("ErDiscrim")
        self.policy = problem.policy(EXPERIMENT.policy)
        self.policy.load(*self.policy.split(SAVED))
        self.policy.reset(100_001, episode)
        self.stepper = _core.make_stepper(problem.dynamics)
        self.stepper.set(500)
        self.stepper.start(100_001, episode)
        self.total, self.ended, self.memory = 0.0, False, None

    def run(self, steps, blind=()):
        for _ in range(steps):
            if self.ended:
                break
            seen = self.stepper.observation
            seen[list(blind)] = 0
            action = np.atleast_1d(self.policy.act(seen)).astype(float)
            reward, self.ended = self.stepper.step(action)
            self.total += reward
        return self


def assert_same(browser, other):
    state = browser.run("[[...figures.apart.robot.state], figures.apart.robot.total]")
    assert state == [other.stepper.state.tolist(), other.total]


@built
def test_a_click_blinds_a_sensor_and_a_key_another(browser, tmp_path):
    open_figures(browser, 6, tmp_path)
    browser.run("figures.apart.advance(50)")
    [x, y, width, height] = browser.run("parts(figures.apart)[1].box")
    click(browser, "apart", x + width / 2, y + height / 2)
    assert browser.run("figures.apart.state.blind") == [1]
    browser.run("figures.apart.advance(80)")
    focus(browser, "apart")
    browser.press("7", "7")
    assert browser.run("figures.apart.state.blind") == [1, 6]
    browser.run("figures.apart.advance(80)")
    assert_same(browser, Khepera().run(50).run(80, [1]).run(80, [1, 6]))
    assert "blind 2, 7" in browser.run("figures.apart.canvas.getAttribute('aria-label')")
    assert browser.errors == []


@built
def test_the_cylinder_is_dragged(browser, tmp_path):
    open_figures(browser, 6, tmp_path)
    x, y = grip_of(browser, "apart", "grip1")
    drag(browser, "apart", (x, y), (x - 40, y + 30))
    place = browser.run("[...figures.apart.robot.state]")[3:5]
    other = Khepera()
    state = other.stepper.state
    scale = browser.run("figures.apart.robot.frame[0]")
    np.testing.assert_allclose(place, state[3:5] + np.array([-40, -30]) / scale, atol=1e-3)
    state[3:5] = place
    other.stepper.state = state
    browser.run("figures.apart.advance(200)")
    assert_same(browser, other.run(200))
    assert browser.errors == []


@built
def test_measuring_is_the_command_s_and_memory_matters(browser, tmp_path):
    open_figures(browser, 6, tmp_path)
    browser.run("figures.apart.press('measure')")
    browser.run("figures.apart.press('memory-none')")
    browser.run("figures.apart.press('measure')")
    whole, without = browser.run("figures.apart.state.measured")
    returns = [Khepera(1000 + i).run(500).total for i in range(20)]
    assert whole == {"what": "the whole robot", "mean": float(np.mean(returns))}
    assert without["what"] == "no memory" and without["mean"] < 50

    # without memory each step is a first step
    other, total = Khepera(1000), 0.0
    while not other.ended and total < 500:
        other.policy.reset(100_001, 1000)
        other.run(1)
        total += 1
    browser.run("figures.apart.robot.start(1000)")
    browser.run("figures.apart.robot.bench.freeze(true)")
    browser.run("for (let i = 0; i < 500; i++) figures.apart.robot.step()")
    assert_same(browser, other)
    assert browser.errors == []
