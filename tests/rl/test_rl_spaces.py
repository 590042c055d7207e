"""Spaces reach learners as they reach evolution: every action is legal, every observation read."""

from typing import ClassVar

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

from botschool.errors import BotschoolError
from botschool.problems.spaces import PlainObservations, fitted, plain_actions
from botschool.rl.environments import make

pytest.importorskip("stable_baselines3")

pytestmark = pytest.mark.slow

POINT = spaces.Box(-1, 1, (2,), np.float32)
INFINITE = np.inf
ACTIONS = {
    "discrete": spaces.Discrete(3, start=-1),
    "multidiscrete": spaces.MultiDiscrete([3, 2], start=[-1, 4]),
    "table": spaces.MultiDiscrete([[3, 2], [2, 4]], start=[[-1, 4], [0, 9]]),
    "binary": spaces.MultiBinary([2, 2]),
    "integers": spaces.Box(-1, 1, (2,), np.int32),
    "bytes": spaces.Box(0, 255, (2,), np.uint8),
    "double": spaces.Box(np.array([-0.1, 0.7]), np.array([0.2, 0.9]), dtype=np.float64),
    "scalar": spaces.Box(-1, 1, (), np.float32),
    "matrix": spaces.Box(-0.1, 0.1, (2, 2), np.float64),
    "unbounded": spaces.Box(-INFINITE, INFINITE, (2,), np.float32),
    "half bounded": spaces.Box(
        np.array([-INFINITE, -1]), np.array([1, INFINITE]), dtype=np.float64
    ),
}
OBSERVATIONS = {
    "discrete": spaces.Discrete(3, start=5),
    "below 0": spaces.Discrete(3, start=-1),
    "table": ACTIONS["table"],
    "binary": spaces.MultiBinary([2, 2]),
    "integers": spaces.Box(-3, 3, (2,), np.int32),
    "scalar": spaces.Box(-1, 1, (), np.float32),
    "small picture": spaces.Box(0, 255, (10, 10, 3), np.uint8),
    "pictures": spaces.Dict(
        small=spaces.Box(0, 255, (7, 7, 3), np.uint8),
        large=spaces.Box(0, 255, (40, 40, 3), np.uint8),
    ),
    "nest": spaces.Dict(
        a=spaces.Tuple([spaces.Discrete(3, start=2), spaces.Dict(x=POINT, t=spaces.Text(3))]),
        b=spaces.MultiDiscrete([[2, 2]], start=[[1, -1]]),
    ),
    "names": spaces.Dict({"type": POINT, "a.b": POINT, "a/b": spaces.Discrete(2, start=1)}),
}
QUICK = {"n_steps": 16, "batch_size": 16, "n_epochs": 1}


class Asserting(gymnasium.Env):
    """Refuses actions outside its space, and notes them."""

    metadata: ClassVar = {"render_modes": ["rgb_array"]}
    performed: ClassVar[list] = []

    def __init__(self, acts=POINT, sees=POINT, render_mode=None):
        self.action_space, self.observation_space = acts, sees
        self.render_mode, self.steps = render_mode, 0

    def reset(self, seed=None, options=None):
        super().reset(seed=seed)
        self.steps = 0
        self.observation_space.seed(seed)
        return self.observation_space.sample(), {}

    def step(self, action):
        assert self.action_space.contains(action), f"illegal {action!r}"
        Asserting.performed.append(np.ravel(action))
        self.steps += 1
        return self.observation_space.sample(), 1.0, False, self.steps >= 8, {}


class Faulty(Asserting):
    """Breaks one rule."""

    def __init__(self, fault, render_mode=None):
        super().__init__(render_mode=render_mode)
        self.fault = fault

    def reset(self, seed=None, options=None):
        observation, info = super().reset(seed=seed)
        return {
            "alone": observation,
            "three": (observation, info, 1),
            "info": (observation, 3),
            "no info": (observation, None),
        }.get(self.fault, (observation, info))

    def step(self, action):
        observation, _, *ends, info = super().step(action)
        reward = {"huge": 1e200, "whole": 10**400, "infinite": np.inf}.get(self.fault, 1.0)
        return observation, reward, *ends, None if self.fault == "no info" else info


class Unseeded(Asserting):
    """Takes no seed."""

    def reset(self):
        return self.observation_space.sample(), {}


class Unpainted(Asserting):
    """Knows no render_mode."""

    metadata: ClassVar = {}

    def __init__(self):
        super().__init__()


gymnasium.register("Unpainted-v0", Unpainted)
gymnasium.register("Unlimited-v0", lambda: gymnasium.make("Pendulum-v1").unwrapped)
for name, space in ACTIONS.items():
    gymnasium.register(f"Acts-{name.replace(' ', '')}-v0", Asserting, kwargs={"acts": space})
for name, space in OBSERVATIONS.items():
    gymnasium.register(f"Sees-{name.replace(' ', '')}-v0", Asserting, kwargs={"sees": space})
gymnasium.register("Faulty-v0", Faulty, disable_env_checker=True, order_enforce=False)
gymnasium.register("Unseeded-v0", Unseeded, disable_env_checker=True, order_enforce=False)


def trained(env, folder, algo="ppo", **params):
    from botschool.rl.player import Player
    from botschool.rl.training import train

    run = train(
        algo, env, folder, params=params or QUICK, steps=48, evaluations=1, episodes=2, engine="sb3"
    )
    player = Player(run.best)
    player.play(2)
    return player


@pytest.mark.parametrize("name", ACTIONS)
def test_a_learner_gives_actions_of_the_space(name, tmp_path):
    Asserting.performed.clear()
    player = trained(f"Acts-{name.replace(' ', '')}-v0", tmp_path)
    assert player.returns == [8.0, 8.0] and len(Asserting.performed) > 48


@pytest.mark.parametrize("name", OBSERVATIONS)
def test_a_learner_reads_the_observations(name, tmp_path):
    assert trained(f"Sees-{name.replace(' ', '')}-v0", tmp_path).returns == [8.0, 8.0]


@pytest.mark.parametrize("space", [*OBSERVATIONS.values(), *ACTIONS.values()])
def test_plain_spaces_hold_what_is_translated(space):
    space.seed(1)
    plain = PlainObservations(space, "it")
    for _ in range(20):
        assert plain.space.contains(plain(space.sample()))
    if isinstance(space, (spaces.Dict, spaces.Tuple)):
        return
    acted = plain_actions(space)
    acted.seed(1)
    for _ in range(20):
        assert space.contains(fitted(acted.sample(), space))


@pytest.mark.parametrize("fault, says", [
    ("alone", "reset does not return (observation, info)"),
    ("three", "reset does not return (observation, info)"),
    ("info", "reset does not return (observation, info)"),
    ("huge", "its reward was 1e+200"),
    ("whole", "its reward was 1000"),
    ("infinite", "its reward was inf"),
])  # fmt: skip
def test_broken_rules_are_one_sentence(fault, says):
    env = make("Faulty-v0", fault=fault)
    with pytest.raises(BotschoolError) as caught:
        env.reset(seed=1)
        env.step(env.action_space.sample())
    assert says in str(caught.value) and "mend the environment." in str(caught.value)


class Goals(Asserting):
    """Its episodes are longer than the steps before learning starts."""

    def __init__(self, render_mode=None):
        super().__init__(render_mode=render_mode)
        self.observation_space = spaces.Dict(
            observation=POINT, achieved_goal=POINT, desired_goal=POINT
        )

    def compute_reward(self, achieved, desired, info):
        return -np.abs(achieved - desired).max(axis=-1)


gymnasium.register("Goals-v0", Goals)


@pytest.mark.parametrize(
    ("wrapper", "steps"), [("", 1000), ("TimeLimit(max_episode_steps=1200)", 1200)]
)
def test_episodes_without_a_limit_are_cut(wrapper, steps):
    env = make("Unlimited-v0", wrapper)
    env.reset(seed=1)
    cut = [env.step(env.action_space.sample())[3] for _ in range(steps)]
    assert cut == [False] * (steps - 1) + [True]
