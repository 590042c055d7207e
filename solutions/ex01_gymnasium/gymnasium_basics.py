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
# # Exercise 1. Gymnasium
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 1` grades
# them, `botschool grade 1.1` one task.

# %%
"""Exercise 1: environments, episodes and rewards."""

import gymnasium
import numpy as np
from gymnasium import spaces

# %% [markdown]
# ## Task 1.1. What an agent sees and does
#
# `gymnasium.make("CartPole-v1")` makes an environment, `env.observation_space` and
# `env.action_space` are its two spaces: print them first. A `spaces.Box` has the limits `space.low`
# and `space.high` (which may be infinite), a `spaces.Discrete` has `space.n` choices that begin
# with `space.start`. `env.spec.max_episode_steps` is the time limit, or None if there is none.


# %%
def describe(environment_id: str) -> dict:
    """Describe the spaces and the time limit of an environment, in a dict.

    Returns a dict with
    - "observation" and "action": a dict for each of the two spaces. For a Box
      {"kind": "Box", "size": how many numbers, "low": [...], "high": [...]}, where low and high
      are lists of `size` floats, of Python or NumPy; for a Discrete
      {"kind": "Discrete", "choices": how many, "first": the lowest choice};
    - "maxsteps": the time limit in steps, or None.

    It works for every environment with such spaces, not only for those that you know.
    """
    ### BEGIN SOLUTION task 1.1: describe the spaces

    def plain(space):
        if isinstance(space, spaces.Discrete):
            return {"kind": "Discrete", "choices": int(space.n), "first": int(space.start)}
        low, high = space.low.ravel().tolist(), space.high.ravel().tolist()
        return {"kind": "Box", "size": len(low), "low": low, "high": high}

    env = gymnasium.make(environment_id)
    description = {
        "observation": plain(env.observation_space),
        "action": plain(env.action_space),
        "maxsteps": env.spec.max_episode_steps,
    }
    env.close()
    return description
    ### END SOLUTION


# %% [markdown]
# ## Task 1.2. A random episode
#
# `env.action_space.sample()` draws a random action. The space has random numbers of its own, which
# `env.action_space.seed(seed)` sets.


# %%
def random_episode(environment_id: str, seed: int, maxsteps: int) -> dict:
    """Record what happens to an agent that acts at random, from the reset to the end.

    Both the reset and, before the first action, the action space are seeded with `seed`; each
    action is then one `sample()`. The episode stops when it is terminated or truncated, and at the
    latest after `maxsteps` steps.

    Returns a dict with
    - "observations": an array of shape (steps + 1, size), the one of the reset first;
    - "actions": a list of the `steps` actions, as they were drawn;
    - "rewards": a list of the `steps` rewards;
    - "terminated", "truncated": True or False, as the last step said. Both are False when only
      `maxsteps` stopped the episode; when the last of `maxsteps` steps ended it, one is True. Both
      are True when the task ends in the very step in which the environment's time limit is over.
    """
    ### BEGIN SOLUTION task 1.2: run a random episode
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    env.action_space.seed(seed)
    observations, actions, rewards = [observation], [], []
    terminated = truncated = False
    while len(actions) < maxsteps and not (terminated or truncated):
        action = env.action_space.sample()
        observation, reward, terminated, truncated, _ = env.step(action)
        observations.append(observation)
        actions.append(action)
        rewards.append(float(reward))
    env.close()
    return {
        "observations": np.array(observations),
        "actions": actions,
        "rewards": rewards,
        "terminated": bool(terminated),
        "truncated": bool(truncated),
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 1.3. The reward of CartPole
#
# CartPole observes four numbers: the position of the cart (in metres, 0 is the middle), its speed,
# the angle of the pole (in radians, 0 is upright) and the speed of the angle. The episode is
# terminated as soon as the cart is more than 2.4 metres from the middle or the pole leans more than
# 12 degrees, to either side.
#
# A step is worth 1 if it *begins* with the pole up, so the step in which the pole falls counts,
# too. If you go on after the fall, Gymnasium warns you and gives 0.


# %%
def fallen(observation: np.ndarray) -> bool:
    """Tell whether CartPole terminates the episode in this state.

    True if the cart is beyond 2.4 metres or the pole beyond 12 degrees, on either side. Exactly 2.4
    metres or 12 degrees is not beyond.
    """
    ### BEGIN SOLUTION task 1.3: say when CartPole is over
    position, _, angle, _ = observation
    return bool(abs(position) > 2.4 or abs(angle) > np.deg2rad(12))
    ### END SOLUTION


def cartpole_reward(observation: np.ndarray, action: int) -> float:
    """Return the reward of a CartPole step that begins with this observation, shape (4,)."""
    ### BEGIN SOLUTION task 1.3: compute the reward of CartPole
    return 0.0 if fallen(observation) else 1.0
    ### END SOLUTION


# %% [markdown]
# ## Task 1.4. The reward of Pendulum
#
# Pendulum observes $(\cos\theta, \sin\theta, \dot\theta)$: the angle $\theta$ (0 is upright, $\pi$
# is hanging down) through its cosine and sine, and the speed of the angle. The action is an array
# with one number, the torque $u$. The reward of a step is
#
# $$r = -(\theta^2 + 0.1\,\dot\theta^2 + 0.001\,u^2)$$
#
# with $\theta$ between $-\pi$ and $\pi$, so the best reward is 0. $\theta$ and $\dot\theta$ are
# those at the *beginning* of the step. The motor gives at most 2 in either direction: a larger
# torque is cut to that before anything else happens.


# %%
def pendulum_reward(observation: np.ndarray, action: np.ndarray) -> float:
    """Return the reward of a Pendulum step that begins with this observation, as one number.

    observation has shape (3,), action has shape (1,) and may exceed the limits of the motor.
    """
    ### BEGIN SOLUTION task 1.4: compute the reward of Pendulum
    cosine, sine, speed = (float(value) for value in observation)
    angle = np.arctan2(sine, cosine)
    torque = np.clip(float(action[0]), -2.0, 2.0)
    return float(-(angle**2 + 0.1 * speed**2 + 0.001 * torque**2))
    ### END SOLUTION


# %% [markdown]
# ## Task 1.5. Balance the pole
#
# A positive angle means that the pole leans to the right. Random actions keep it up for some 22
# steps; a rule of one line that you think up yourself keeps it up for hundreds.


# %%
def balance(observation: np.ndarray) -> int:
    """Return the action, 0 or 1, that keeps CartPole's pole up.

    It depends on the observation alone: no memory of earlier ones and no random numbers. The pole
    must stay up for at least 195 of 200 steps, on average over 20 episodes.
    """
    ### BEGIN SOLUTION task 1.5: balance the pole
    _, _, angle, speed = observation
    return int(angle + 0.5 * speed > 0)
    ### END SOLUTION


# %% [markdown]
# ## Task 1.6. Random agents compared
#
# One random episode says little, so play several and write down their mean return and how much they
# differ. With the returns $R_1$ to $R_n$ and their mean $\bar R$, the standard deviation is
#
# $$s = \sqrt{\frac{1}{n-1} \sum_{i=1}^{n} (R_i - \bar R)^2}$$


# %%
def compare(environment_ids: list[str], episodes: int, seed: int) -> list[dict]:
    """Make a table of random agents, with one row for each environment in the order given.

    Episode i (from 0) of every environment is the random episode of task 1.2 with seed + i, and
    goes on until it is terminated or truncated.

    Each row is a dict with
    - "environment": the id;
    - "mean": the mean return over the episodes;
    - "deviation": the standard deviation of the returns, dividing by the number of episodes minus
      one (0 when there is a single one);
    - "length": the mean number of steps of an episode.
    """
    ### BEGIN SOLUTION task 1.6: compare random agents
    table = []
    for environment_id in environment_ids:
        runs = [random_episode(environment_id, seed + i, 1_000_000) for i in range(episodes)]
        returns = [sum(run["rewards"]) for run in runs]
        table.append(
            {
                "environment": environment_id,
                "mean": float(np.mean(returns)),
                "deviation": float(np.std(returns, ddof=1)) if episodes > 1 else 0.0,
                "length": float(np.mean([len(run["rewards"]) for run in runs])),
            }
        )
    return table
    ### END SOLUTION


# %% [markdown]
# ## The picture
#
# `botschool show 1` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import draw_distributions, film_agent

    classic = [
        "CartPole-v1",
        "Pendulum-v1",
        "Acrobot-v1",
        "MountainCar-v0",
        "MountainCarContinuous-v0",
    ]
    print(f"{'environment':<26} {'mean':>9} {'deviation':>10} {'steps':>7}")
    for row in compare(classic, episodes=30, seed=1):
        print(
            f"{row['environment']:<26} {row['mean']:>9.2f} {row['deviation']:>10.2f} "
            f"{row['length']:>7.1f}"
        )
    returns = {
        name: np.array([sum(random_episode(name, seed, 1000)["rewards"]) for seed in range(1, 61)])
        for name in classic
    }
    draw_distributions("random_agents.png", returns, "60 episodes of random agents")
    film_agent("balance.mp4", "CartPole-v1", balance, episodes=2)
