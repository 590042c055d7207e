"""Submissions learn on an environment of the grader, which sees how they begin."""

from types import SimpleNamespace

import gymnasium
import numpy as np
import pytest

from botschool.grading.run.learning import BrokenOff, Turned, Updates, lasted, learnt

NAME = "LearningOfTests-v0"
TWIN = {"problem": "SpatialBalanceBot-v0", "signs": [1, 1, 1], "side": 1}
WHEELS = TWIN | {"signs": [1, 1, -1], "side": -1}
BALANCES = np.array([[-10.0, -1.0, 0.2]])


def layers(*signs):
    return [(BALANCES * signs, np.zeros(1))]


@pytest.mark.parametrize(
    ("robot", "signs"), [(TWIN, (1, 1, 1)), (TWIN | {"signs": [1, -1, 1]}, (1, -1, 1)),
                         (WHEELS, (-1, -1, 1))]
)  # fmt: skip
def test_only_weights_of_this_robot_balance_it(robot, signs):
    assert lasted(layers(*signs), robot, 5, 4, 500) == [500] * 4
    others = [(a, b, c) for a in (1, -1) for b in (1, -1) for c in (1,) if (a, b, c) != signs]
    for other in others:
        assert 500 not in lasted(layers(*other), robot, 5, 4, 500)


def test_layers_but_the_first_get_the_tanh_of_those_before():
    small = [(BALANCES / 1e4, np.zeros(1)), (np.array([[1e4]]), np.zeros(1))]
    assert lasted(small, TWIN, 5, 4, 500) == [500] * 4


def plays(seed, episodes=3):
    env = gymnasium.make(NAME)
    for episode in range(episodes):
        observation, _ = env.reset(seed=seed + episode)
        for _ in range(4):
            observation, *_ = env.step(np.float32(BALANCES @ observation))
    return [seed, episodes]


def test_the_first_action_of_each_episode_is_seen():
    module = SimpleNamespace(plays=plays)
    answer, actions, change = learnt(module, "plays", NAME, WHEELS, 7, 99, False)
    assert (answer, len(actions), change) == ([7, 3], 3, 0.0)
    again = learnt(module, "plays", NAME, WHEELS, 7, 2, False)
    assert again[0] is None and np.array_equal(again[1], actions[:2])
    other = learnt(module, "plays", NAME, WHEELS, 8, 2, False)
    assert not np.array_equal(other[1], actions[:2])


def test_learning_is_broken_off_when_another_episode_begins():
    robot = Turned(**TWIN, episodes=1)
    robot.reset(seed=1)
    robot.reset(seed=2)  # nothing was done in the one before
    robot.step(np.zeros(1))
    with pytest.raises(BrokenOff):
        robot.reset(seed=3)


class Actor:
    """A model of PPO with two layers of an actor, and one of a critic."""

    def __init__(self, value):
        self.value, self.policy = value, self

    def named_parameters(self):
        for name in ("policy_net.0", "action_net", "value_net.0"):
            yield name, self
        yield "log_std", self

    def detach(self):
        return self

    cpu = detach

    def numpy(self):
        return np.full((2, 2), self.value)


def test_layers_are_those_that_ppo_has_made():
    updates, one, other = Updates(), Actor(1.0), Actor(5.0)

    def update(model):
        model.value += 0.25

    for model in (one, one, other):
        updates.watch(update, model)
    two = np.ones((2, 2))
    assert updates.change_of([[1.5 * two, 1.5 * two]]) == 0.5
    assert updates.change_of([[1.25 * two, 1.25 * two]]) == 0.25
    assert updates.change_of([[5.25 * two, 5.25 * two]]) == 0.25
    wrong = [[two, two]], [[5 * two, 5 * two]], [[1.5 * two, 5.25 * two]], [[1.5 * two]]
    for layers in (*wrong, None, 3, [["a", "b"]], [[1.5 * two, 1.5 * two], [two, two]]):
        assert updates.change_of(layers) == 0.0
