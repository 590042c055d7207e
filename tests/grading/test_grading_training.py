"""The grader watches a training in an environment that it changes, and makes environments up."""

import types

import numpy as np
import pytest

from botschool.grading.run import pulse
from botschool.grading.run.made_up import made_up
from botschool.grading.run.training import watching

gymnasium = pytest.importorskip("gymnasium")
torch = pytest.importorskip("torch")
SIGNS = np.array([1.0, -1.0, -1.0, 1.0])
STUDENT = """
import gymnasium
import torch

def loss(table, scale):
    return (scale * table).sum()

def train(seeds, steps=3):
    table = torch.ones((2, 3), requires_grad=True)
    optimiser, seen = torch.optim.SGD([table], lr=0.1), []
    for number, seed in enumerate(seeds):
        env = gymnasium.make("CartPole-v1")
        seen.append(env.reset(seed=seed)[0])
        for _ in range(steps):
            seen.append(env.step(1)[0])
        optimiser.zero_grad()
        loss(table, scale=number + 1).backward()
        optimiser.step()
    return {"table": table.detach().numpy().copy(), "seen": seen}
"""


def student():
    module = types.ModuleType("student")
    exec(STUDENT, vars(module))
    return module


def watched(module, seeds, side=1, most=100):
    answer = None
    with watching(module, "CartPole-v1", SIGNS, side, most, ("loss",), {"loss": 1}) as seen:
        answer = module.train(seeds)
    return answer, seen


@pytest.mark.slow
def test_a_training_is_recorded():
    answer, seen = watched(student(), [4, 5])
    assert (seen.returns, seen.seeds, seen.actions) == ([3.0, 3.0], [4, 5], [1.0] * 6)
    assert seen.gradients == 2
    assert len(seen.values["loss"]) == 2
    assert np.array_equal(seen.first[0], np.ones((2, 3)))
    assert seen.led_to(answer)
    assert not seen.led_to({"table": np.full((2, 3), 0.65), "others": [1, "text", None]})


@pytest.mark.parametrize("side", [1, -1])
def test_signs_and_sides_are_changed_within_the_block_alone(side):
    module = student()
    answer, _ = watched(module, [4], side)
    with gymnasium.make("CartPole-v1") as env:
        usual = [env.reset(seed=4)[0], *(env.step(1 if side > 0 else 0)[0] for _ in range(3))]
    assert np.allclose(answer["seen"], SIGNS * usual)
    if side > 0:
        assert np.allclose(module.train([4])["seen"], usual)


@pytest.mark.slow
@pytest.mark.parametrize("steps", [0, 400])
def test_a_training_that_stands_still_is_ended(steps, monkeypatch):
    monkeypatch.setattr(pulse, "LOOK", 0.2)
    monkeypatch.setattr(pulse, "STILL", 0.4)
    module = student()
    module.train([4], steps=1)  # what is imported first takes its time
    exec(
        STUDENT.replace("    return {", "    while steps != 400:\n        pass\n    return {"),
        vars(module),
    )
    with watching(module, "CartPole-v1", SIGNS, 1, 100, (), {}) as seen:
        if steps:
            module.train(range(20), steps=steps)  # longer than STILL, but it goes on
            return
        with pytest.raises(pulse.StandsStill):
            module.train([4])
    assert len(seen.returns) == 1


def test_a_training_is_broken_off():
    answer, seen = watched(student(), [4, 5, 6, 7], most=2)
    assert answer is None
    assert seen.seeds == [4, 5]


def test_an_environment_is_made_up():
    spaces = ([-1, -2, -3], [1, 2, np.inf]), (3, 2)
    name, got = made_up(*spaces, [1.0, -2.0], maxsteps=2)
    other, _ = made_up(*spaces, [1.0, -2.0, 3.0], maxsteps=2)
    assert name != other
    with gymnasium.make(name) as env:
        assert env.observation_space == gymnasium.spaces.Box(*map(np.float32, spaces[0]))
        assert env.action_space == gymnasium.spaces.Discrete(3, start=2)
        first = env.reset(seed=3)[0]
        assert env.step(2)[1:4] == (1.0, False, False)
        assert env.step(4)[1:4] == (-2.0, True, True)
        assert np.array_equal(env.reset(seed=3)[0], first)
    with gymnasium.make(other) as env:
        env.reset()
        assert [env.step(2)[2:4] for _ in range(2)] == [(False, False), (False, True)]
    assert [float(each) for each in got] == [2.0, 4.0]
