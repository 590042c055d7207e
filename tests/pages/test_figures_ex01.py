"""The figure of exercise 1: steered by keys, it is the cart-pole of the command."""

import numpy as np

from botschool import _core
from living import focus


def steps(ways, change=None):
    """The states of the first post-evaluation of seed 1; change: (step, index, amount)."""
    stepper = _core.make_stepper("CartPole-v1")
    stepper.set(500)
    stepper.start(100_001, 0)
    found = [stepper.state.copy()]
    for step, way in enumerate(ways):
        if change and change[0] == step:
            state = stepper.state
            state[change[1]] += change[2]
            stepper.state = state
        _, ended = stepper.step(np.array([float(way)]))
        found.append(stepper.state.copy())
        if ended:
            break
    return np.array(found)


def test_keys_steer_the_pole(page):
    focus(page, "pole")
    ways = []
    for key, way, count in (("ArrowRight", 1, 3), ("ArrowLeft", 0, 5), ("ArrowRight", 1, 2)):
        page.press(key)
        page.run(f"figures.pole.advance({count})")
        ways += count * [way]
    assert page.run("[...figures.pole.pole.state]") == steps(ways)[-1].tolist()
    assert page.run("figures.pole.pole.total") == 10.0

    page.run("figures.pole.press('hitRight')")
    page.run("figures.pole.advance(2)")
    ways += [1, 1]
    assert page.run("[...figures.pole.pole.state]") == steps(ways, (10, 3, 0.5))[-1].tolist()

    page.run("figures.pole.advance(500)")
    path = steps(ways + 500 * [1], (10, 3, 0.5))
    assert page.run("[figures.pole.pole.total, figures.pole.pole.fell]") == [len(path) - 1, True]
    assert "the pole has fallen" in page.run("figures.pole.canvas.getAttribute('aria-label')")
