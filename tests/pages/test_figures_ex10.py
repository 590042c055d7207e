"""The figure of exercise 10: by hand, blind and hit, it is the command's robot on two wheels."""

import numpy as np

from botschool import config
from living import ROOT, Stepped


def balancer():
    experiment = config.load(ROOT / "data/experiments/spatialbalancebot.ini")
    return Stepped(experiment, np.load(ROOT / "data/genotypes/spatialbalancebot.npy"), 500)


SHOWN = (
    "[[...figures.balance.robot.state], figures.balance.robot.total, figures.balance.robot.steps]"
)


def assert_same(page, other):
    state, total, steps = page.run(SHOWN)
    assert (state, total, steps) == (other.stepper.state.tolist(), other.total, other.steps)


def test_the_evolved_robot_is_blinded_and_hit(page):
    page.run("figures.balance.press('driver-evolved')")
    page.run("figures.balance.advance(60)")
    page.run("figures.balance.press('blind2')")
    page.run("figures.balance.advance(40)")
    page.run("figures.balance.press('hitRight')")
    page.run("figures.balance.advance(100)")
    other = balancer()
    other.run(60)
    other.run(40, blind=[2])
    state = other.stepper.state
    state[page.run("figures.balance.robot.scene.coordinates") + 1] += 0.6
    other.stepper.state = state
    other.run(100, blind=[2])
    assert_same(page, other)
    assert page.run("figures.balance.traces.length") == other.steps + 1
