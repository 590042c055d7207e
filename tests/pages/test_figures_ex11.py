"""The figure of exercise 11 learns as the solution says, wherever its lines are dragged."""

import numpy as np
import pytest

from living import ROOT, slide, state

CORNERS = np.array([[0, 0], [0, 1], [1, 0], [1, 1.0]])
NAMES = ("w1", "b1", "w2", "b2")


@pytest.fixture(scope="module")
def gradient_by_hand():
    pytest.importorskip("torch")
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex11_regression/regression.py").read_text(), names)
    return names["gradient_by_hand"]


def parameters(s):
    """The network of a state, in the shapes of the exercise."""
    return [np.array(s["w1"]), np.array(s["b1"]), np.array([s["w2"]]), np.array(s["b2"])]


def learnt(gradient, s, epochs):
    """The parameters and the losses after some epochs with momentum, from a standstill."""
    targets = np.array(s["targets"], dtype=float)[:, None]
    now, losses = parameters(s), []
    velocity = [np.zeros_like(each) for each in now]
    for _ in range(epochs):
        found = gradient(CORNERS, targets, *now)
        losses.append(found["loss"])
        velocity = [
            s["momentum"] * v + found[name] for v, name in zip(velocity, NAMES, strict=True)
        ]
        now = [each - s["rate"] * v for each, v in zip(now, velocity, strict=True)]
    return now, losses


def assert_learns(page, gradient, epochs):
    before = state(page, "surface")
    expected, losses = learnt(gradient, before, epochs)
    page.run(f"figures.surface.advance({epochs})")
    after = state(page, "surface")
    for found, wanted in zip(parameters(after), expected, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-9)
    np.testing.assert_allclose(after["losses"][before["epoch"] :], losses, rtol=1e-9)


def test_it_learns_as_the_solution(page, gradient_by_hand):
    assert_learns(page, gradient_by_hand, 300)
    page.run("figures.surface.reset()")
    slide(page, "surface", "rate", 1)
    slide(page, "surface", "momentum", 0.5)
    page.run("figures.surface.press('chance')")
    assert_learns(page, gradient_by_hand, 300)
