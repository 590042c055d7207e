"""What all jointed bodies have in common as problems."""

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from test_planar_runners import SECONDS

INFOS = problems.native.INFOS
BROKEN = {
    "PlanarHopper": (1, 3, 11),
    "PlanarWalker2D": (1, 3, 17),
    "PlanarHalfCheetah": (1, 3, 17),
    "PlanarBodyBrain": (1, 3, 15),
    "SpatialAnt": (2, 3, 9, 17),
    "SpatialHumanoid": (2, 3, 9, 26),
    "SpatialHumanoidStandup": (2, 3, 9, 26),
    "SpatialBalanceBot": (2, 3, 9, 15),
}
"""Rows of a state: some of the places, and one of the speeds."""
NAMES = [name for name in INFOS if name.split("-")[0] in BROKEN]


@pytest.mark.parametrize("name", NAMES)
def test_broken_physics_end_the_episode(name):
    """The state stays what it was, so that it can be drawn."""
    stepper, rows = _core.make_stepper(name), BROKEN[name.split("-")[0]]
    still = np.zeros(INFOS[name]["outputs"])
    for row, value in zip(rows, (np.nan, *[np.inf] * (len(rows) - 2), 1e30), strict=True):
        stepper.start(0)
        state = stepper.state
        state[row] = value
        stepper.state = state
        assert stepper.step(still) == (-100 if "BodyBrain" in name else 0, True)
        assert np.array_equal(stepper.state, state, equal_nan=True)
    for action in (1e30, -np.inf, np.nan):
        stepper.start(0)
        stepper.step(still + action)
        assert np.isfinite(stepper.state).all()


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.filterwarnings("ignore:.*(minimum|maximum) value.*infinity")
def test_gymnasium_accepts_them(name):
    """Pictures of bodies in space: tests/pictures/test_spatial_scene.py."""
    planar = name.startswith("Planar")
    env = gymnasium.make(f"botschool/{name}", render_mode="rgb_array" if planar else None)
    check_env(env.unwrapped, skip_render_check=not planar)
    assert env.spec.max_episode_steps == (500 if "Balance" in name else 1000)
    if planar:
        seconds = SECONDS.get(name.split("-")[0], 0.02)
        assert env.unwrapped.metadata["render_fps"] == round(1 / seconds)
        env.reset(seed=1)
        frame = env.render()
        env.step(env.action_space.sample())
        assert frame.shape == (300 if "BodyBrain" in name else 360, 600, 3) and frame.std() > 10
    env.close()
