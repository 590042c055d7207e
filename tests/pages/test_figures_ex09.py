"""The hoppers of exercise 9 act, earn and are pushed as the module's stepper says; a typed reward
evolves with the numbers of the command."""

import numpy as np
import pytest

from botschool import _core, evolve
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


def test_a_typed_reward_evolves_with_the_numbers_of_the_command(page):
    figure = "figures.reward"
    said = f"{figure}.section.querySelector('.said').textContent"
    page.run(f"{figure}.set({{ reward: 'heigth' }})")
    assert "did you mean height?" in page.run(said)
    page.run(f"{figure}.press('evolve')")
    assert page.run(f"{figure}.worker") is None
    reward = "ahead - 0.1 * effort + 0.2 * upright"
    page.run(f"{figure}.set({{ reward: {reward!r} }})")
    assert page.run(said) == ""
    page.run(f"{figure}.press('evolve')")
    page.wait(f"{figure}.rows.length >= 3 ? 'yes' : ''")
    rows = page.run(f"{figure}.rows.slice(0, 3)")
    page.run(f"{figure}.press('evolve')")
    assert page.run("decodeURIComponent(location.hash)") == f"#reward={reward}"
    run = evolve(ex09.start(reward), seed=1, generations=3, progress=False)
    stat = np.load(run.folder / "statS1.npy").reshape(-1, 6)
    assert [row[0] for row in rows] == stat[:, 0].tolist()
    assert [row[1] for row in rows] == stat[:, 2].tolist()
    assert [row[2] for row in rows] == stat[:, 4].tolist()


@pytest.mark.parametrize("name", ex09.STARTS)
def test_a_start_shows_the_hopper_that_its_reward_evolved(page, name):
    page.run(f"figures.reward.press('start-{name}')")
    page.run("figures.reward.advance(30)")
    assert page.run("figures.reward.state.reward") == ex09.STARTS[name]
    saved = np.load(ex09.STARTED)[list(ex09.STARTS).index(name)]
    assert page.run("[...figures.reward.own.own]") == saved.astype(float).tolist()
    assert page.run("figures.reward.own.steps") == 60
