"""The figure of exercise 11 learns as the solution says, wherever its lines are dragged."""

import numpy as np
import pytest

from living import ROOT, built, click, drag, grip_of, open_figures, slide, state

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


def assert_learns(browser, gradient, epochs):
    before = state(browser, "surface")
    expected, losses = learnt(gradient, before, epochs)
    browser.run(f"figures.surface.advance({epochs})")
    after = state(browser, "surface")
    for found, wanted in zip(parameters(after), expected, strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-9)
    np.testing.assert_allclose(after["losses"][before["epoch"] :], losses, rtol=1e-9)


@built
def test_it_learns_as_the_solution(browser, gradient_by_hand, tmp_path):
    open_figures(browser, 11, tmp_path)
    assert_learns(browser, gradient_by_hand, 300)
    browser.run("figures.surface.reset()")
    slide(browser, "surface", "rate", 1)
    slide(browser, "surface", "momentum", 0.5)
    browser.run("figures.surface.press('chance')")
    assert_learns(browser, gradient_by_hand, 300)
    assert browser.errors == []


@built
def test_a_dragged_line_frees_a_network(browser, gradient_by_hand, tmp_path):
    open_figures(browser, 11, tmp_path)
    browser.run("figures.surface.advance(600)")
    assert browser.run("loss(figures.surface.state)") == pytest.approx(0.125, abs=0.01)
    steep = np.linalg.norm(state(browser, "surface")["w1"][0])
    x, y = browser.run(
        "(({ map }) => [map.x(0.75), map.y(0.75)])(panels(figures.surface))"
    )  # the line then goes through (0.5, 1) and (1, 0.5)
    drag(browser, "surface", grip_of(browser, "surface", "line1"), (x, y))
    s = state(browser, "surface")
    nets = np.array([[0.5, 1], [1, 0.5]]) @ s["w1"][0] + s["b1"][0]
    np.testing.assert_allclose(nets, 0, atol=1e-5)
    assert np.linalg.norm(s["w1"][0]) == pytest.approx(steep)
    assert_learns(browser, gradient_by_hand, 100)
    assert browser.run("learnt(figures.surface.state)")
    assert browser.errors == []


@built
def test_a_corner_changes_its_answer(browser, gradient_by_hand, tmp_path):
    open_figures(browser, 11, tmp_path)
    x, y = browser.run("(({ map }) => [map.x(1), map.y(1)])(panels(figures.surface))")
    click(browser, "surface", x, y)
    assert state(browser, "surface")["targets"] == [0, 1, 1, 1]
    assert_learns(browser, gradient_by_hand, 300)
    told = browser.run("figures.surface.canvas.getAttribute('aria-label')")
    assert "Corner 1, 1: answer" in told and "target 1. Loss" in told
    assert browser.errors == []
