"""The figure of exercise 10: by hand, blind and hit, it is the command's robot on two wheels."""

import numpy as np

from botschool import _core, config
from botschool.problems.native import NativeProblem
from living import ROOT, built, focus, open_figures


class Balancer:
    """The first post-evaluation of seed 1, as Python steps it."""

    def __init__(self):
        problem = NativeProblem("SpatialBalanceBot-v0")
        experiment = config.load(ROOT / "data/experiments/spatialbalancebot.ini")
        self.policy = problem.policy(experiment.policy)
        saved = np.load(ROOT / "data/genotypes/spatialbalancebot.npy")
        self.policy.load(*self.policy.split(saved))
        self.policy.reset(100_001, 0)
        self.stepper = _core.make_stepper(problem.dynamics)
        self.stepper.set(500)
        self.stepper.start(100_001, 0)
        self.total, self.steps, self.ended = 0.0, 0, False

    def run(self, steps, action=None, blind=()):
        for _ in range(steps):
            if self.ended:
                return
            seen = self.stepper.observation
            seen[list(blind)] = 0
            own = np.atleast_1d(self.policy.act(seen)).astype(float)
            reward, self.ended = self.stepper.step(own if action is None else np.array([action]))
            self.total += reward
            self.steps += 1


SHOWN = (
    "[[...figures.balance.robot.state], figures.balance.robot.total, figures.balance.robot.steps]"
)


def assert_same(browser, other):
    state, total, steps = browser.run(SHOWN)
    assert (state, total, steps) == (other.stepper.state.tolist(), other.total, other.steps)


@built
def test_a_hand_on_the_wheels(browser, tmp_path):
    open_figures(browser, 10, tmp_path)
    focus(browser, "balance")
    key = {"key": "ArrowRight", "modifiers": 0}
    browser.call("Input.dispatchKeyEvent", type="keyDown", **key)
    browser.run("figures.balance.advance(4)")
    browser.call("Input.dispatchKeyEvent", type="keyUp", **key)
    browser.run("figures.balance.advance(3)")
    other = Balancer()
    other.run(4, 1.0)
    other.run(3, 0.0)
    assert_same(browser, other)
    browser.run("figures.balance.advance(500)")
    other.run(500, 0.0)
    assert_same(browser, other)
    assert "It has fallen" in browser.run("figures.balance.canvas.getAttribute('aria-label')")
    assert browser.errors == []


@built
def test_the_evolved_robot_is_blinded_and_hit(browser, tmp_path):
    open_figures(browser, 10, tmp_path)
    browser.run("figures.balance.press('driver-evolved')")
    browser.run("figures.balance.advance(60)")
    browser.run("figures.balance.press('blind2')")
    browser.run("figures.balance.advance(40)")
    browser.run("figures.balance.press('hitRight')")
    browser.run("figures.balance.advance(100)")
    other = Balancer()
    other.run(60)
    other.run(40, blind=[2])
    state = other.stepper.state
    state[browser.run("figures.balance.robot.scene.coordinates") + 1] += 0.6
    other.stepper.state = state
    other.run(100, blind=[2])
    assert_same(browser, other)
    assert browser.run("figures.balance.traces.length") == other.steps + 1
    assert browser.errors == []
