"""The balancing robot, which lives in a package of its own, as a problem."""

import sys

import gymnasium
import numpy as np
import pytest

from botschool import problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes

NAME = "BalanceBotBulletEnv-v0"


def test_is_found_and_evaluated():
    pytest.importorskip("balance_bot")
    problem = problems.make(NAME)
    policy = Policy(NAME, problem.interface, PolicyConfig(nhiddens=0, bias=1, out_type=3))
    genotypes = np.array([[0.0, -10.0, -1.0, 0.0], [0.0, 10.0, 1.0, 0.0]])
    batch = Episodes.of(np.array([1, 1], dtype=np.uint64), 2)
    outcome = problem.evaluate(policy, genotypes, None, batch, 1000)
    assert np.all(outcome.steps[:2] == 500)
    assert np.all(outcome.steps[2:] < 100)
    again = problem.evaluate(policy, genotypes, None, batch, 1000)
    np.testing.assert_array_equal(again.fitness, outcome.fitness)


def test_missing_package_is_said_in_a_sentence(monkeypatch):
    monkeypatch.setitem(sys.modules, "balance_bot", None)
    monkeypatch.delitem(gymnasium.registry, NAME, raising=False)
    with pytest.raises(BotschoolError, match=r"pip install -e envs/balance_bot") as raised:
        problems.make(NAME)
    assert str(raised.value).count(".") == 1


def test_a_name_nearly_right_is_suggested(monkeypatch):
    with pytest.raises(BotschoolError, match=f"did you mean {NAME}"):
        problems.make("BalanceBotBulletEnv-v1")
