"""Ctrl-C and SIGTERM end a training of Stable-Baselines3 also while it post-evaluates."""

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

from botschool.rl import callbacks
from botschool.rl.model import choose
from botschool.rl.training import learn

pytest.importorskip("stable_baselines3")

pytestmark = pytest.mark.slow


class Endless(gymnasium.Env):
    """Episodes in evaluation never end; those of the training end after 20 steps."""

    observation_space = spaces.Box(-1, 1, (2,), np.float32)
    action_space = spaces.Discrete(2)
    made = 0

    def __init__(self, render_mode=None):
        Endless.made += 1
        self._endless = Endless.made > 2  # the first is to look at, the second trains
        self.render_mode = render_mode

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self._t = 0
        return np.zeros(2, np.float32), {}

    def step(self, action):
        self._t += 1
        return np.zeros(2, np.float32), 1.0, not self._endless and self._t >= 20, False, {}


gymnasium.register("Endless-v0", Endless, max_episode_steps=10**9)


@pytest.mark.parametrize("algo", ["dqn", "ppo", "ars", "sac"])
def test_a_user_who_stops_waits_for_no_episode(algo, tmp_path, monkeypatch):
    monkeypatch.setattr(callbacks, "PATIENCE", 0.01)
    monkeypatch.setattr(Endless, "made", 0)
    if algo == "sac":
        monkeypatch.setattr(Endless, "action_space", spaces.Box(-1, 1, (1,), np.float32))
    asked = 0

    def stopping():
        nonlocal asked
        asked += 1
        return asked > 8

    settings = choose(algo, "Endless-v0", steps=100, envs=1, episodes=2, evaluations=1)
    run, found = learn(settings, tmp_path, lambda steps, found: None, stopping=stopping)
    assert found is None
    assert run.last.is_file() and not run.best.is_file()
