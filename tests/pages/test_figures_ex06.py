"""The figure of exercise 6: blinded, cut, frozen and moved, it is the command's Khepera."""

import numpy as np

from botschool import config
from living import ROOT, Stepped, click, focus

EXPERIMENT = config.load(ROOT / "data/experiments/discrim.ini")
SAVED = np.load(ROOT / "data/genotypes/discrim.npy")


def khepera(episode=0):
    return Stepped(EXPERIMENT, SAVED, 500, episode)


def assert_same(page, other):
    state = page.run("[[...figures.apart.robot.state], figures.apart.robot.total]")
    assert state == [other.stepper.state.tolist(), other.total]


def test_a_click_blinds_a_sensor_and_a_key_another(page):
    page.run("figures.apart.advance(50)")
    [x, y, width, height] = page.run("parts(figures.apart)[1].box")
    click(page, "apart", x + width / 2, y + height / 2)
    assert page.run("figures.apart.state.blind") == [1]
    page.run("figures.apart.advance(80)")
    focus(page, "apart")
    page.press("7", "7")
    assert page.run("figures.apart.state.blind") == [1, 6]
    page.run("figures.apart.advance(80)")
    assert_same(page, khepera().run(50).run(80, blind=[1]).run(80, blind=[1, 6]))
    assert "blind 2, 7" in page.run("figures.apart.canvas.getAttribute('aria-label')")


def test_measuring_is_the_command_s_and_memory_matters(page):
    page.run("figures.apart.press('measure')")
    page.run("figures.apart.press('memory-none')")
    page.run("figures.apart.press('measure')")
    whole, without = page.run("figures.apart.state.measured")
    returns = [khepera(1000 + i).run(500).total for i in range(20)]
    assert whole == {"what": "the whole robot", "mean": float(np.mean(returns))}
    assert without["what"] == "no memory" and without["mean"] < 50

    # without memory each step is a first step
    other, total = khepera(1000), 0.0
    while not other.ended and total < 500:
        other.policy.reset(100_001, 1000)
        other.run(1)
        total += 1
    page.run("figures.apart.robot.start(1000)")
    page.run("figures.apart.robot.bench.freeze(true)")
    page.run("for (let i = 0; i < 500; i++) figures.apart.robot.step()")
    assert_same(page, other)
