# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercise 10. A new environment
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 10` grades
# them, `botschool grade 10.1` one task.

# %%
"""Exercise 10: a balancing robot, from its description to a trained controller."""

import os
import time
import xml.etree.ElementTree as ElementTree

import gymnasium
import numpy as np

from botschool.course import Robot
from botschool.course.bullet import pybullet, pybullet_data
from botschool.course.robots import robot_file

PLANE = os.path.join(pybullet_data.getDataPath(), "plane.urdf")
FASTEST = 24.6  # rad/s: what the motors can do, 235 turns a minute
TIME_STEP = 0.01  # seconds
LOWEST = 0.15  # metres: with the centre of its body below, the robot has fallen

# %% [markdown]
# ## Task 10.1. Read the robot
#
# Open `data/robots/balance_bot.urdf` and read it. `root = ElementTree.fromstring(urdf)` makes a
# tree of the text. `root.findall("link")` are the links in the order of the file,
# `element.find("inertial/mass")` is an element inside another one, or None if there is none, and
# `element.get("value")` is an attribute, which is a text.


# %%
def numbers_of(element: ElementTree.Element | None, attribute: str, default: list) -> list[float]:
    """The numbers in an attribute, as "0 0 0.3"; default if there is no element or attribute."""
    text = None if element is None else element.get(attribute)
    return default if text is None else [float(number) for number in text.split()]


def describe(urdf: str) -> dict:
    """What a robot is made of. urdf: the text of a URDF file.

    Every link has an inertial part with a mass; none is turned (no rpy); a link and its own joint
    come before the joint that hangs another link on it. What the file leaves out has its default:
    an origin "0 0 0", an axis "1 0 0".

    Returns a dict with
    - "links": a dict, the name of each link -> its mass in kg;
    - "joints": a list with a dict for each joint, in the order of the file: "name", "type",
      "parent" and "child" (names of links), "axis" (a list of three numbers);
    - "mass": the mass of the whole robot in kg;
    - "centre": the centre of mass of the whole robot, [x, y, z] in metres, seen from the frame of
      the first link, with all joints in their zero position.
    """
    raise NotImplementedError("task 10.1: read masses and joints from the description")


# %% [markdown]
# ## Tasks 10.2 to 10.6. The environment
#
# Two functions are given: `connect` starts a simulation of its own for each environment, with or
# without a window, and `picture` holds the camera.
#
# The robot lives on the plane z = 0. Its wheels turn around the x axis, so it drives along y and
# falls over around x. In the simulation the wheels are joints number 0 and 1, and the base of the
# robot is its body.
#
# Every function of PyBullet takes the number of the simulation, as in
# `pybullet.stepSimulation(physicsClientId=self.client)`. Without it you talk to simulation 0, which
# may be another environment's.


# %%
def connect(render_mode: str | None) -> int:
    """A simulation of its own; returns its number."""
    return pybullet.connect(pybullet.GUI if render_mode == "human" else pybullet.DIRECT)


def picture(client: int, robot: int, width: int = 480, height: int = 360) -> np.ndarray:
    """What a camera that follows the robot sees: uint8, shape (height, width, 3)."""
    (x, y, _), _ = pybullet.getBasePositionAndOrientation(robot, client)
    view = pybullet.computeViewMatrixFromYawPitchRoll([x, y, 0.22], 1.3, 60, -18, 0, 2)
    lens = pybullet.computeProjectionMatrixFOV(35, width / height, 0.1, 30)
    *_, pixels, _, _ = pybullet.getCameraImage(
        width, height, view, lens, shadow=0, lightDirection=[1, 1, 2], physicsClientId=client
    )
    return np.reshape(pixels, (height, width, 4))[..., :3].astype(np.uint8)


class BalanceBotEnv(gymnasium.Env):
    """A robot on two wheels, which falls over unless its wheels keep rolling under its body."""

    metadata = {"render_modes": ["human", "rgb_array"], "render_fps": 100}  # noqa: RUF012

    def __init__(self, render_mode: str | None = None) -> None:
        """render_mode: "human" (PyBullet's window), "rgb_array" (pictures) or None.

        Sets self.observation_space, a Box of three numbers: the inclination of the body, between
        -pi and pi (rad); its angular velocity, without limits (rad/s); the target speed of the
        wheels, between -FASTEST and FASTEST (rad/s).
        Sets self.action_space, a Box of one number between -1 and 1. Both are of type float32.
        """
        self.render_mode = render_mode
        self.client = connect(render_mode)  # the number of our simulation
        self.robot = None  # the number of the robot in it, known after reset
        self.speed = 0.0  # the target speed of the wheels
        raise NotImplementedError("task 10.2: make the two spaces")

    def observe(self) -> np.ndarray:
        """Inclination (rad), angular velocity (rad/s) and target speed of the wheels (rad/s).

        The inclination is the first of the base's three Euler angles (around x), as PyBullet counts
        them; the angular velocity is that of the base around the world's x axis. Returns float32,
        shape (3,).
        """
        raise NotImplementedError("task 10.3: observe the robot")

    def reset(self, *, seed: int | None = None, options: dict | None = None) -> tuple:
        """Makes the world anew, with the robot at rest, and returns (observation, {}).

        The world: an empty simulation, gravity -10 along z, steps of TIME_STEP, the file PLANE,
        and the robot with its base at [0, 0, 0.001]. Load the plane first: the order changes what
        PyBullet computes. The robot's inertias are those of its file
        (flags=pybullet.URDF_USE_INERTIA_FROM_FILE). The inclination, around x, is the one random
        number of the episode, drawn by self.np_random.uniform(-0.3, 0.3). The target speed of the
        wheels is 0. `options` is not used.
        """
        raise NotImplementedError("task 10.4: make the world and put the robot into it")

    def drive(self, action: np.ndarray) -> None:
        """Changes the target speed of the wheels by the action, and hands it to both motors.

        The action, shape (1,), is first cut to between -1 and 1; the new self.speed is cut to
        between -FASTEST and FASTEST. Motor 0 gets the target velocity self.speed, motor 1
        -self.speed, because its axis points the other way.
        """
        raise NotImplementedError("task 10.5: drive the motors")

    def reward(self) -> float:
        """1 for a step, less 0.05 for each rad/s of the target speed, in either direction."""
        raise NotImplementedError("task 10.6: compute the reward")

    def fallen(self) -> bool:
        """Whether the position of the base (the centre of the body) is lower than LOWEST."""
        raise NotImplementedError("task 10.6: say when the robot has fallen")

    def step(self, action: np.ndarray) -> tuple:
        """One step: drives, lets the simulation make a step, and looks at what came of it.

        Returns (observation, reward, terminated, truncated, info): the three in the middle as a
        float and two bools; truncated is always False here, and info is empty. In a window
        (self.render_mode is "human") self.render() is called, too.
        """
        raise NotImplementedError("task 10.6: make a step")

    def render(self) -> np.ndarray | None:
        """The picture, uint8 of shape (360, 480, 3); in a window, waits for the next one."""
        if self.render_mode == "rgb_array":
            return picture(self.client, self.robot)
        if self.render_mode == "human":
            time.sleep(TIME_STEP)
        return None

    def close(self) -> None:
        """Ends the physics client, and closes its window."""
        if self.client is not None:
            pybullet.disconnect(self.client)
            self.client = None


# %% [markdown]
# ## Task 10.7. A name for the environment
#
# `gymnasium.make(name)` can make every environment that has been *registered*: with
# `gymnasium.register(id=..., entry_point=..., max_episode_steps=...)` you say the name, the class,
# and the time limit. Gymnasium watches the limit for you: the last step is then `truncated`.
#
# Then let Gymnasium check what you have built:
#
#     from gymnasium.utils.env_checker import check_env
#     register_robot()
#     check_env(gymnasium.make("BalanceBotBulletEnv-v0").unwrapped, skip_render_check=True)
#
# It tries spaces, seeds and types, and raises an error that says what is wrong. (Two warnings about
# an infinite limit are all right: an angular velocity has none.)


# %%
def register_robot() -> None:
    """Registers BalanceBotEnv as "BalanceBotBulletEnv-v0", with episodes of at most 500 steps."""
    raise NotImplementedError("task 10.7: register the environment")


# %% [markdown]
# ## Task 10.8. A package of its own
#
# To give the environment to somebody, make an installable package of it. It is a folder like this:
#
#     balance_bot/                  what you hand on
#       pyproject.toml              what it is called, and what it needs
#       balance_bot/                what gets installed: `import balance_bot`
#         __init__.py               registers the environment
#         env.py                    the class
#         balance_bot.urdf          the robot
#
# `env.py` holds your class BalanceBotEnv, so two files are left. (Functions and numbers of your own
# that stand outside the class do not get there: keep what its methods need inside it.) Whoever
# imports the package wants to find the name registered; but the class, and with it PyBullet, is
# only loaded when somebody makes the environment. So give `entry_point` as a text, "module:class".


# %%
def package_files() -> dict[str, str]:
    """The texts of the files "pyproject.toml" and "balance_bot/__init__.py".

    pyproject.toml has
    - [build-system]: requires = ["setuptools>=64"], build-backend = "setuptools.build_meta";
    - [project]: name = "balance_bot", a version, and dependencies, a list with gymnasium, numpy
      and pybullet (which versions is up to you);
    - [tool.setuptools]: packages = ["balance_bot"], and package-data, a table that says which
      other files of the package balance_bot get installed: ["*.urdf"].

    __init__.py registers "BalanceBotBulletEnv-v0", with the class BalanceBotEnv of its module
    balance_bot.env and at most 500 steps.
    """
    raise NotImplementedError("task 10.8: write the files of the package")


# %% [markdown]
# ## Task 10.9. Evolve a controller
#
# For a robot this simple a network without hidden neurons is enough. It has four parameters: the
# bias $b$ and the weights $w_1$, $w_2$, $w_3$ of inclination, angular velocity and wheel speed. The
# action is
#
# $$a = b + w_1 o_1 + w_2 o_2 + w_3 o_3$$
#
# `robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)` is such a network, and
# `robot.evaluate(population, seed, episodes=1, maxsteps=500)` measures a whole population, as in
# exercise 3; a row of it is $(b, w_1, w_2, w_3)$. It must be registered before. PyBullet simulates
# each step, which takes much longer than in exercise 3: be content with few candidates and
# generations. The angles are small numbers, so useful weights are large: vary them boldly.


# %%
def evolve(seed: int) -> np.ndarray:
    """Evolves a controller for "BalanceBotBulletEnv-v0", which is registered already.

    Choose algorithm and hyperparameters yourself: your own of exercise 3 or 8, or another one.
    Asked for: in each of 20 episodes that it has not met, the robot balances for all 500 steps.
    It should take some ten seconds. The same seed gives the same controller, another seed another.

    Returns its parameters, shape (4,).
    """
    raise NotImplementedError("task 10.9: evolve a controller")


# %% [markdown]
# ## Task 10.10. Train a controller
#
# PPO of Stable-Baselines3 needs the name of the environment, too, and a number of steps:
#
#     model = PPO("MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu")
#     model.learn(total_timesteps)
#
# (`from stable_baselines3 import PPO`; inside the function, as it takes seconds to load.) Its
# network of two hidden layers is made of plain numbers. `actor_layers`, which is given, takes them
# out: they can be saved with `np.savez`, or run on a robot without any library. The defaults learn
# too slowly here: shorter rollouts (`n_steps`) and a larger `learning_rate` help.


# %%
def actor_layers(model) -> list[list[np.ndarray]]:
    """The layers of a PPO model's network from observations to actions: [weights, biases] each.

    Between layers, but not after the last one, is a tanh.
    """
    layers = [*model.policy.mlp_extractor.policy_net, model.policy.action_net]
    return [
        [layer.weight.detach().numpy().copy(), layer.bias.detach().numpy().copy()]
        for layer in layers
        if hasattr(layer, "weight")
    ]


def train(seed: int) -> list[list[np.ndarray]]:
    """Trains a controller by PPO for "BalanceBotBulletEnv-v0", which is registered already.

    Asked for: in each of 20 episodes that it has not met, the robot balances for all 500 steps if
    it does what the network puts out, cut to between -1 and 1. It should take about half a minute.

    Returns actor_layers(model). The same seed gives the same.
    """
    raise NotImplementedError("task 10.10: train a controller")


# %% [markdown]
# ## The picture
#
# `botschool show 10` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course.robots import draw_balance, film_balance, write_package

    register_robot()
    env = gymnasium.make("BalanceBotBulletEnv-v0", render_mode="rgb_array")

    def network(layers):
        def act(observation):
            for number, (weights, biases) in enumerate(layers, 1):
                observation = weights @ observation + biases
                observation = observation if number == len(layers) else np.tanh(observation)
            return observation

        return act

    def inclinations(act, seed):
        observation, _ = env.reset(seed=seed)
        seen, ended = [observation[0]], False
        while not ended:
            observation, _, terminated, truncated, _ = env.step(act(observation))
            seen.append(observation[0])
            ended = terminated or truncated
        return np.array(seen)

    evolved = evolve(seed=1)
    print("evolved: action = {:.2f} {:+.2f} o1 {:+.2f} o2 {:+.2f} o3".format(*evolved))
    controllers = {
        "wheels at rest": lambda observation: np.zeros(1),
        "evolved": network([(evolved[None, 1:], evolved[:1])]),
        "trained by PPO": network(train(seed=1)),
    }
    panels = {
        title: [inclinations(act, seed) for seed in range(100, 120)]
        for title, act in controllers.items()
    }
    for title, episodes in panels.items():
        print(f"{title}: {sum(len(each) == 501 for each in episodes)} of 20 episodes balanced")
    draw_balance("balance.png", panels)
    film_balance("balance.mp4", env, controllers["evolved"], seeds=[101, 105, 106])
    write_package("package", package_files(), [connect, picture, BalanceBotEnv])
