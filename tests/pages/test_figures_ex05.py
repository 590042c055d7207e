"""The figure of exercise 5: brains and bodies in the page walk as the command's do."""

import numpy as np

from botschool import _core, config
from botschool.page.figures.ex05 import WALKERS
from botschool.problems.native import NativeProblem
from living import ROOT, built, drag, grip_of, open_figures, slide, state

EXPERIMENT = config.load(ROOT / "data/experiments/planarbodybrain.ini")


def saved(walker):
    """The numbers of a walker, in single precision as in the page."""
    values = np.load(ROOT / f"data/genotypes/{WALKERS[walker - 1]}.npy")
    return values.astype(np.float32).astype(float)


def walk(brain, body):
    """What the first post-evaluation of seed 1 pays, stepped in Python."""
    problem = NativeProblem("PlanarBodyBrain-v0")
    policy = problem.policy(EXPERIMENT.policy)
    genotype, normalisation = policy.split(saved(brain))
    policy.load(genotype, normalisation)
    policy.reset(100_001, 0)
    stepper = _core.make_stepper(problem.dynamics)
    stepper.set(400)
    stepper.set_body(body)
    stepper.start(100_001, 0)
    total = 0.0
    for _ in range(400):
        action = np.atleast_1d(policy.act(stepper.observation)).astype(float)
        reward, ended = stepper.step(action)
        total += reward
        if ended:
            break
    return total


def body_of(walker):
    return saved(walker)[-134:-70]


@built
def test_a_swapped_body_is_the_command_s(browser, tmp_path):
    open_figures(browser, 5, tmp_path)
    assert browser.run("figures.body.whole") == walk(1, body_of(1))
    browser.run("figures.body.press('from-2')")
    assert state(browser, "body")["body"] == body_of(2).tolist()
    assert browser.run("figures.body.whole") == walk(1, body_of(2))
    browser.run("figures.body.press('brain-3')")
    assert browser.run("figures.body.whole") == walk(3, body_of(2))
    browser.run("figures.body.press('from-stick')")
    assert browser.run("figures.body.whole") == walk(3, np.zeros(64))
    assert browser.errors == []


@built
def test_a_dragged_handle_changes_two_numbers_of_the_body(browser, tmp_path):
    open_figures(browser, 5, tmp_path)
    before = body_of(1)
    x, y = grip_of(browser, "body", "segment3")
    drag(browser, "body", (x, y), (x + 12, y - 8))
    found = state(browser, "body")
    body = np.array(found["body"])
    assert found["segment"] == 3
    assert set(np.flatnonzero(body != before)) <= {6, 45} and (body != before).any()
    assert browser.run("figures.body.whole") == walk(1, body)
    slide(browser, "body", "density", 2)
    changed = np.array(state(browser, "body")["body"])
    assert changed[53 + 3] == 2 and (changed != body).sum() == 1
    assert browser.run("figures.body.whole") == walk(1, changed)
    told = browser.run("figures.body.canvas.getAttribute('aria-label')")
    assert "Walker 1's brain in the body of walker 1" in told
    assert browser.errors == []
