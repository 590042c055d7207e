"""The figure of exercise 12 acts, chooses its elite and learns as the solution does."""

import numpy as np
import pytest

from botschool import _core
from living import ROOT, slide, state

EPISODES = """figures.elite.episodes.map(({ observations, actions, total }) =>
  ({ observations, actions, return: total }))"""


@pytest.fixture(scope="module")
def solution():
    pytest.importorskip("torch")
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex12_cross_entropy/cross_entropy.py").read_text(), names)
    return names


def episodes_of(page):
    """The episodes of the iteration that is seen, as `run_episode` returns them."""
    return [
        {key: np.array(value) for key, value in episode.items()} for episode in page.run(EPISODES)
    ]


def arrays(policy):
    """A policy of the page as [W1, b1, W2, b2]."""
    return [
        np.array(part).reshape(shape)
        for part, shape in zip(policy, ((32, 4), 32, (2, 32), 2), strict=True)
    ]


def test_episodes_are_the_core_s(page, solution):
    page.run("figures.elite.press('once')")
    policy, episodes = arrays(state(page, "elite")["policy"]), episodes_of(page)
    stepper = _core.make_stepper("CartPole-v1")
    stepper.set(200)
    likely = []
    for i, episode in enumerate(episodes):
        stepper.start(1, i)
        for observation, action in zip(episode["observations"], episode["actions"], strict=True):
            assert stepper.observation.tolist() == observation.tolist()
            likely.append(solution["softmax"](solution["outputs_of"](policy, observation))[action])
            _, ended = stepper.step(np.array([float(action)]))
        assert ended and episode["return"] == len(episode["actions"])
    assert np.mean(likely) == pytest.approx(0.5, abs=0.1)


@pytest.mark.parametrize("percentile", [70, 90])
def test_the_elite_teaches(page, solution, percentile):
    torch = solution["torch"]
    slide(page, "elite", "percentile", percentile)
    page.run("figures.elite.press('once')")
    network = solution["make_network"](4, 2)
    before = arrays(state(page, "elite")["policy"])
    with torch.no_grad():
        for parameter, values in zip(network.parameters(), before, strict=True):
            parameter.copy_(torch.tensor(values))
    chosen = solution["elite"](episodes_of(page), percentile)
    optimiser = torch.optim.Adam(network.parameters(), lr=0.01)
    given = chosen["observations"], chosen["actions"], solution["cross_entropy"], 10
    solution["improve"](network, optimiser, *given)

    page.run("figures.elite.press('once')")
    s = state(page, "elite")
    assert s["updates"] == 10 and len(s["rows"]) == 1
    for found, wanted in zip(arrays(s["policy"]), solution["parameters_of"](network), strict=True):
        np.testing.assert_allclose(found, wanted, atol=1e-4)
