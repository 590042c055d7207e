"""The figure of exercise 2: dragged weights give the fitness that the command gives them."""

import numpy as np

from botschool import config
from botschool.problems.base import Episodes
from botschool.problems.native import NativeProblem
from living import ROOT, drag, focus, grip_of, state


def returns_by_python(genotypes):
    """Ten returns of each network, as post-evaluations of seed 1."""
    policy = config.load(ROOT / "data/experiments/cartpole.ini").policy
    policy.nhiddens, policy.maxsteps = 3, 200
    problem = NativeProblem("CartPole-v1")
    genotypes = np.array(genotypes)
    episodes = Episodes.of([100_001] * len(genotypes), 10)
    outcome = problem.evaluate(problem.policy(policy), genotypes, None, episodes, 200)
    return outcome.fitness.reshape(-1, 10)


def test_a_dragged_weight_changes_the_robot(page):
    x, y = grip_of(page, "weights", "hidden2-angle")
    drag(page, "weights", (x, y), (x, y - 40))
    focus(page, "weights")
    x, y = grip_of(page, "weights", "output2-hidden2")
    drag(page, "weights", (x, y), (x, y - 60))
    page.press("ArrowUp")
    found = state(page, "weights")
    weights = np.array(found["weights"])
    # five biases, then three rows of four weights, then two rows of three
    expected = np.zeros(23)
    expected[5 + 1 * 4 + 2], expected[5 + 12 + 1 * 3 + 1] = 0.4 + 1.2, 1.8 + 0.24
    np.testing.assert_allclose(weights, expected, atol=1e-3)
    assert found["returns"] == returns_by_python([weights])[0].tolist()
    told = page.run("figures.weights.canvas.getAttribute('aria-label')")
    assert "angle to hidden 2 1.60" in told


def test_one_neuron_balances_and_the_luckiest_is_the_best_of_200(page):
    weights = np.zeros(23)
    weights[[5 + 2, 5 + 3, 5 + 12, 5 + 15]] = 1, 1, -1, 1
    page.run(f"figures.weights.set({{ weights: {weights.tolist()} }})")
    assert state(page, "weights")["returns"] == 10 * [200.0]
    page.run("figures.weights.press('luckiest')")
    found = state(page, "weights")
    drawn = []
    for i in range(1, 201):
        draws = np.random.Generator(np.random.Philox(key=[2, i]))
        drawn.append([*np.zeros(5), *(0.1 * draws.standard_normal(18))])
    returns = returns_by_python(drawn)
    best = int(returns.mean(axis=1).argmax())
    assert found["weights"] == drawn[best]
    assert found["returns"] == returns[best].tolist()
