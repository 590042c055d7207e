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
# # Exercise 2. A neural controller
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 2` grades
# them, `botschool grade 2.1` one task.

# %%
"""Exercise 2: a neural network that controls a robot in any Gymnasium environment."""

import gymnasium
import numpy as np
from gymnasium import spaces

# %% [markdown]
# ## Task 2.1. The parameters
#
# The parameters are a dict of four arrays. `W1[h, i]` is the weight from input i to hidden neuron
# h, `W2[o, h]` the weight from hidden neuron h to output o; `b1` and `b2` are the biases.


# %%
def parameters(ninputs: int, nhiddens: int, noutputs: int, seed: int) -> dict:
    """Return random parameters of a network.

    All weights are Gaussian random numbers with mean 0.0 and standard deviation 0.1, each drawn
    on its own; all biases are 0. The same seed gives the same parameters. Two seeds, even 1 and 2,
    have no weight in common.

    Returns a dict of arrays: "W1" of shape (nhiddens, ninputs), "b1" of shape (nhiddens,), "W2" of
    shape (noutputs, nhiddens), "b2" of shape (noutputs,).
    """
    ### BEGIN SOLUTION task 2.1: draw the parameters
    rng = np.random.default_rng(seed)
    return {
        "W1": 0.1 * rng.standard_normal((nhiddens, ninputs)),
        "b1": np.zeros(nhiddens),
        "W2": 0.1 * rng.standard_normal((noutputs, nhiddens)),
        "b2": np.zeros(noutputs),
    }
    ### END SOLUTION


# %% [markdown]
# ## Task 2.2. From observation to outputs
#
# For the observation $x$, the hidden neurons $h$ and the outputs $y$:
#
# $$h = \tanh(W_1 x + b_1), \qquad y = \tanh(W_2 h + b_2)$$


# %%
def forward(network: dict, observation: np.ndarray) -> np.ndarray:
    """Return the outputs of a network as in task 2.1 for an observation.

    The observation has shape (ninputs,), the outputs have shape (noutputs,). Hidden neurons and
    outputs use tanh. The biases may have any values. The arrays given stay as they are.
    """
    ### BEGIN SOLUTION task 2.2: compute the outputs
    hidden = np.tanh(network["W1"] @ observation + network["b1"])
    return np.tanh(network["W2"] @ hidden + network["b2"])
    ### END SOLUTION


# %% [markdown]
# ## Task 2.3. As many neurons as the environment needs
#
# One input for each number of the observation. If the actions are a `spaces.Box`, one output for
# each number of the action; if they are `spaces.Discrete`, one output for each choice.


# %%
def sizes(environment_id: str) -> tuple[int, int]:
    """Return (number of inputs, number of outputs) of a network for this environment.

    Its observations are a one-dimensional Box, its actions a one-dimensional Box or Discrete. The
    choices of a Discrete space need not begin at 0.
    """
    ### BEGIN SOLUTION task 2.3: count inputs and outputs
    env = gymnasium.make(environment_id)
    ninputs, actions = env.observation_space.shape[0], env.action_space
    env.close()
    return ninputs, int(actions.n) if isinstance(actions, spaces.Discrete) else actions.shape[0]
    ### END SOLUTION


# %% [markdown]
# ## Task 2.4. From outputs to an action
#
# - Discrete actions: the most active output decides. Output 0 stands for the first choice,
#   `space.start`.
# - A Box: an output $y$ of -1 gives the number's lower limit $l$ (`space.low`), 0 the middle, and 1
#   the upper limit $u$ (`space.high`): $a = l + \frac{y + 1}{2} (u - l)$.


# %%
def act(outputs: np.ndarray, action_space: spaces.Space) -> int | np.ndarray:
    """Return the action that the outputs, shape (noutputs,), stand for.

    For a Discrete space an int: its first choice plus the number of the most active output (of
    equals, the lowest). For a Box an array of shape (noutputs,): the outputs stretched from
    [-1, 1] to the limits of the space, number by number. All limits are finite. The array `outputs`
    stays as it is.
    """
    ### BEGIN SOLUTION task 2.4: choose the action
    if isinstance(action_space, spaces.Discrete):
        return int(action_space.start + np.argmax(outputs))
    low, high = action_space.low, action_space.high
    return (low + (outputs + 1) / 2 * (high - low)).astype(action_space.dtype)
    ### END SOLUTION


# %% [markdown]
# ## Task 2.5. An episode
#
# Observe, compute, act, and again, until the episode is terminated or truncated (exercise 1), or
# `maxsteps` are done.


# %%
def run_episode(environment_id: str, network: dict, seed: int, maxsteps: int = 200) -> dict:
    """Run one episode of a robot with this network; the environment is reset with `seed`.

    Returns a dict with "actions", the list of all actions, and "return", the sum of all rewards.
    """
    ### BEGIN SOLUTION task 2.5: run an episode
    env = gymnasium.make(environment_id)
    observation, _ = env.reset(seed=seed)
    actions, total = [], 0.0
    terminated = truncated = False
    while len(actions) < maxsteps and not (terminated or truncated):
        action = act(forward(network, observation), env.action_space)
        observation, reward, terminated, truncated, _ = env.step(action)
        actions.append(action)
        total += float(reward)
    env.close()
    return {"actions": actions, "return": total}
    ### END SOLUTION


# %% [markdown]
# ## Task 2.6. Fitness
#
# The mean return over several episodes.


# %%
def fitness(environment_id: str, network: dict, seeds: list[int], maxsteps: int = 200) -> float:
    """Return the mean return of the network over one episode, of at most maxsteps, for each seed.

    A seed that comes twice counts twice.
    """
    ### BEGIN SOLUTION task 2.6: compute the fitness
    returns = [run_episode(environment_id, network, seed, maxsteps)["return"] for seed in seeds]
    return float(np.mean(returns))
    ### END SOLUTION


# %% [markdown]
# ## Task 2.7. Many networks at once
#
# NumPy computes all networks in one operation: use `@` on stacks of matrices, or `np.einsum`. For
# network $n$,
#
# $$h_{nj} = \tanh\Big(\sum_i W_{1,nji}\, x_{ni} + b_{1,nj}\Big)$$


# %%
def forward_batch(networks: dict, observations: np.ndarray) -> np.ndarray:
    """Return what forward gives for n networks, each with its own observation, without a loop.

    networks holds "W1" of shape (n, nhiddens, ninputs), "b1" (n, nhiddens), "W2"
    (n, noutputs, nhiddens), "b2" (n, noutputs); observations has shape (n, ninputs). The arrays
    given stay as they are.

    Returns an array of shape (n, noutputs).
    """
    ### BEGIN SOLUTION task 2.7: compute the outputs of many networks
    hidden = np.tanh((networks["W1"] @ observations[:, :, None])[:, :, 0] + networks["b1"])
    return np.tanh((networks["W2"] @ hidden[:, :, None])[:, :, 0] + networks["b2"])
    ### END SOLUTION


# %% [markdown]
# ## Task 2.8. The luckiest network
#
# Try many random networks in the same episodes and keep the best.


# %%
def random_search(environment_id: str, nnetworks: int, nhiddens: int, seed: int) -> dict:
    """Try random networks in an environment, whichever it is; returns may be negative.

    Network i (from 0) has the parameters of task 2.1 with seed + i. The fitness of each is that of
    task 2.6 with the 10 seeds from seed to seed + 9, and at most 200 steps.

    Returns a dict with "networks", the list of all networks; "fitness", the list of their fitness;
    and "best", the number of the best network (of equals, the lowest).
    """
    ### BEGIN SOLUTION task 2.8: search at random
    ninputs, noutputs = sizes(environment_id)
    networks = [parameters(ninputs, nhiddens, noutputs, seed + i) for i in range(nnetworks)]
    seeds = list(range(seed, seed + 10))
    measured = [fitness(environment_id, network, seeds) for network in networks]
    return {"networks": networks, "fitness": measured, "best": int(np.argmax(measured))}
    ### END SOLUTION


# %% [markdown]
# ## The picture
#
# `botschool show 2` runs this part. It takes a minute or two.

# %%
if __name__ == "__main__":
    from botschool.course import draw_distributions, film_agent

    found = {}
    for name in ("CartPole-v1", "Pendulum-v1", "Acrobot-v1", "MountainCarContinuous-v0"):
        found[name] = random_search(name, nnetworks=200, nhiddens=5, seed=1)
        print(f"{name}: the best of 200 random networks reaches {max(found[name]['fitness']):.1f}")
    draw_distributions(
        "random_networks.png",
        {name: search["fitness"] for name, search in found.items()},
        "200 random networks",
        label="fitness",
    )
    search = found["CartPole-v1"]
    network = search["networks"][search["best"]]
    film_agent(
        "luckiest.mp4",
        "CartPole-v1",
        lambda observation: act(forward(network, observation), spaces.Discrete(2)),
        episodes=3,
    )
