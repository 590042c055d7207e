"""The hoppers of exercise 9's figure act, earn and are pushed as the module's stepper says."""

import numpy as np
import pytest

from botschool import _core
from botschool.page.figures import ex09
from botschool.problems import of
from living import slide

SPEED = 6
"""Index of a hopper's speed ahead in its state."""


def played(row, column, steps, push=0.0):
    """Return a hopper's states and rewards in the first post-evaluation of seed 1.

    push: added to its speed before the last step.
    """
    experiment = ex09.experiment(ex09.BONUSES[row])
    policy = of(experiment).policy(experiment.policy)
    policy.load(*policy.split(np.load(ex09.FILE)[row, column].astype(float)))
    policy.reset(100_001, 0)
    stepper = _core.make_stepper("PlanarHopper-v5")
    stepper.set(experiment.policy.maxsteps)
    stepper.start(100_001, 0)
    states, rewards = [stepper.state.copy()], []
    for step in range(steps):
        if push and step == steps - 1:
            state = stepper.state
            state[SPEED] += push
            stepper.state = state
        action = policy.act(stepper.observation).astype(np.float64)
        reward, ended = stepper.step(action)
        rewards.append(reward)
        states.append(stepper.state.copy())
        if ended:
            break
    return np.array(states), rewards


def test_hoppers_earn_what_the_problem_pays(page):
    page.run("figures.bonus.advance(60)")
    for row, column in ((0, 1), (2, 3), (5, 0)):
        slide(page, "bonus", "bonus", row)
        page.run(f"figures.bonus.press('seed-{column + 1}')")
        states, rewards = played(row, column, 120)
        assert page.run("[...chosen(figures.bonus).state]") == states[-1].tolist()
        earned = page.run(f"earned({row}, chosen(figures.bonus))")
        assert earned["progress"] == pytest.approx(sum(rewards), rel=1e-12)
        assert earned["standing"] == pytest.approx(120 * ex09.BONUSES[row])
        told = page.run("figures.bonus.line.textContent")
        assert f"bonus {ex09.BONUSES[row]:g}, seed {column + 1}:" in told
        assert f"{states[-1][0] - states[0][0]:.1f} m" in told
