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
# # Exercise 12. Cross-entropy
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 12` grades
# them, `botschool grade 12.1` one task.

# %%
"""Exercise 12: the cross-entropy method, with discrete and with continuous actions."""

from collections.abc import Callable

import gymnasium
import numpy as np
import torch

import botschool.envs

gymnasium.register_envs(botschool.envs)  # botschool's own ones, beside Gymnasium's

# %% [markdown]
# The networks of this exercise are ready-made. While episodes run, one observation goes through
# the network at a time; NumPy does this several times faster than torch, so `outputs_of` does it
# with a copy of the parameters.


# %%
def make_network(ninputs: int, noutputs: int, nhiddens: int = 32) -> torch.nn.Sequential:
    """A network with one layer of tanh hidden neurons and linear outputs."""
    return torch.nn.Sequential(
        torch.nn.Linear(ninputs, nhiddens), torch.nn.Tanh(), torch.nn.Linear(nhiddens, noutputs)
    )


def parameters_of(network: torch.nn.Sequential) -> list[np.ndarray]:
    """Copies of a network's parameters, [W1, b1, W2, b2], as arrays."""
    return [each.detach().numpy().astype(np.float64) for each in network.parameters()]


def outputs_of(parameters: list[np.ndarray], observation: np.ndarray) -> np.ndarray:
    """The outputs of the network with these parameters for one observation, shape (noutputs,)."""
    W1, b1, W2, b2 = parameters
    return W2 @ np.tanh(W1 @ observation + b1) + b2


# %% [markdown]
# ## Task 12.1. Softmax
#
# $$p_i = \frac{e^{s_i}}{\sum_j e^{s_j}}$$


# %%
def softmax(scores: np.ndarray) -> np.ndarray:
    """Probabilities from scores, along the last axis; the shape stays.

    softmax([0, 0]) returns [0.5, 0.5]. Scores may be as large as 1000, where e^1000 is more than a
    computer can hold: adding the same number to all scores changes no probability.
    """
    raise NotImplementedError("task 12.1: turn scores into probabilities")


# %% [markdown]
# ## Task 12.2. Choosing at random
#
# Lay the probabilities one after another on a ruler from 0 to 1, and throw a dart. With
# probabilities 0.2, 0.5 and 0.3, action 0 owns what is below 0.2, action 1 what is from 0.2 to
# below 0.7, and action 2 the rest.


# %%
def choose(probabilities: np.ndarray, rng: np.random.Generator) -> int:
    """An action drawn with these probabilities, shape (actions,).

    u = rng.random() is the dart, the only random number; the action is the first one for which
    the sum of the probabilities up to and including its own is greater than u, or the last one if
    rounding leaves no such sum.
    """
    raise NotImplementedError("task 12.2: choose an action")


# %% [markdown]
# ## Task 12.3. An episode


# %%
def run_episode(environment: str, act: Callable, seed: int, maxsteps: int = 200) -> dict:
    """An episode of at most `maxsteps` steps, from reset(seed=seed).

    The environment keeps its own limit of steps, too: an episode ends with the lower one.

    act(observation) chooses the actions: an int, or an array of the action space's shape. An
    array is cut to the limits of the space before the environment gets it, since Gaussian noise
    knows no limits; what is recorded is what was chosen, not cut.

    Returns a dict with
    - "observations": what the policy saw before each step, shape (steps, numbers observed);
    - "actions": what it then chose, shape (steps,) for discrete actions, else (steps, actuators);
    - "return": the sum of the rewards, a float.
    """
    raise NotImplementedError("task 12.3: run an episode and record it")


# %% [markdown]
# ## Task 12.4. The elite
#
# The best episodes are those with a return of at least the *bound*, the percentile of all returns.


# %%
def elite(episodes: list[dict], percentile: float) -> dict:
    """What happened in the best episodes, one after another in the order of the list.

    episodes: dicts as `run_episode` returns them. The bound is np.percentile(returns, percentile);
    an episode is kept when its return is at least the bound.

    Returns a dict with
    - "observations": of all steps of the kept episodes, shape (steps, numbers observed);
    - "actions": likewise, shape (steps,) or (steps, actuators);
    - "bound": a float.
    """
    raise NotImplementedError("task 12.4: keep the best episodes")


# %% [markdown]
# ## Task 12.5. Cross-entropy
#
# The mean surprise over the N steps:
#
# $$L = -\frac{1}{N} \sum_t \ln p(a_t), \qquad \ln p(a) = s_a - \ln \sum_j e^{s_j}$$


# %%
def cross_entropy(scores: torch.Tensor, actions: torch.Tensor) -> torch.Tensor:
    """The loss, a tensor of shape (), through which torch can compute gradients.

    scores has the shape (N, actions); actions, shape (N,), holds whole numbers from 0. Write it
    with torch's functions, but without those that are the answer: cross_entropy (also the binary
    one), nll_loss, log_softmax (also torch.log_softmax and that of tensors) and torch's
    distributions are refused. As in task 12.1, scores may be large.
    """
    raise NotImplementedError("task 12.5: measure the surprise")


# %% [markdown]
# ## Task 12.6. Learning from the elite


# %%
def improve(
    network: torch.nn.Module,
    optimiser: torch.optim.Optimizer,
    observations: np.ndarray,
    actions: np.ndarray,
    loss: Callable[[torch.Tensor, torch.Tensor], torch.Tensor],
    updates: int,
) -> list[float]:
    """Makes `updates` updates of the network, each on all of the steps at once.

    observations, shape (N, numbers observed), and actions, shape (N,) or (N, actuators), are
    arrays: make a tensor of float32 of the observations, and one of int64 of whole actions, of
    float32 of others. An update computes loss(outputs of the network, actions) and the gradients
    of it alone, and lets the optimiser make its step.

    Returns the losses before each update, a list of floats.
    """
    raise NotImplementedError("task 12.6: update the network")


# %% [markdown]
# ## Task 12.7. Continuous actions
#
# The outputs are the means of the action's numbers. The standard deviation $\sigma$ is learnt, too,
# one for each number; the parameter is $\ln \sigma$.
#
# $$L = \frac{1}{N} \sum_t \sum_i \left( \frac{(a_{ti} - \mu_{ti})^2}{2 \sigma_i^2}
# + \ln \sigma_i + \frac{1}{2} \ln 2\pi \right)$$


# %%
def gaussian_action(
    mean: np.ndarray, log_deviation: np.ndarray, rng: np.random.Generator
) -> np.ndarray:
    """mean + deviation * noise, shape (actuators,).

    The noise is rng.standard_normal(actuators), drawn in one call.
    """
    raise NotImplementedError("task 12.7: draw an action")


def gaussian_loss(
    means: torch.Tensor, log_deviation: torch.Tensor, actions: torch.Tensor
) -> torch.Tensor:
    """The loss by the formula above, a tensor of shape ().

    means and actions have the shape (N, actuators), log_deviation has (actuators,). Torch's
    distributions and gaussian_nll_loss are refused.
    """
    raise NotImplementedError("task 12.7: measure the surprise in continuous actions")


# %% [markdown]
# ## Task 12.8. Training
#
# One iteration: run episodes with the policy, keep the elite, learn from it. The episode number e
# of iteration i has the seed `seed + i * starts + e % starts`. With as many `starts` as episodes,
# each one has a start of its own; with 1, all of an iteration begin alike, and none is among the
# best just for an easy start.
#
# Adam (`torch.optim.Adam`) suits as the optimiser. $\ln \sigma$ is no part of the network: make it
# a tensor that requires a gradient, begin with 0, and give it to the optimiser beside the network's
# parameters. `improve` wants a loss of two arguments: wrap `gaussian_loss`. The network's first
# weights are random, too: `torch.manual_seed` makes them repeat.
#
# The second environment is CartPole with a motor that pushes with any force: its action is a number
# from -1 (10 N to the left) to 1 (10 N to the right). The policy must learn by your losses, from
# episodes in what `gymnasium.make` gives: when it is graded, the signs of what is observed and done
# there may differ from the usual.


# %%
def train(
    environment: str,
    seed: int,
    iterations: int = 50,
    episodes: int = 20,
    starts: int = 20,
    percentile: float = 70,
    updates: int = 10,
    learning_rate: float = 0.01,
    goal: float = 195.0,
    attempts: int = 3,
) -> dict:
    """A policy for an environment with discrete or continuous actions, from random parameters.

    Training ends when the mean return of an iteration reaches the goal. Now and then a policy
    settles for less: if the goal is not reached after `iterations`, begin again with other random
    numbers, up to as many `attempts`, and return the last one.

    The same seed gives the same training, another seed another one.

    Change the defaults as you like: the grader passes environment and seed only. Without chance,
    that is with the action of the highest score or with the mean itself, your policy must stay up
    for 180 of 200 steps, on average over new episodes of CartPole-v1 and of
    botschool/PushedCartPole-v0.

    Returns a dict with
    - "parameters": [W1, b1, W2, b2], as `parameters_of` gives them;
    - "returns": the returns of all episodes of each iteration, a list of lists.
    """
    raise NotImplementedError("task 12.8: train a policy")


# %% [markdown]
# ## Every episode a dot
#
# `botschool show 12` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import film_agent
    from botschool.course.rl import draw_learning

    torch.set_num_threads(1)
    pendulum = {"iterations": 40, "starts": 1, "percentile": 85, "updates": 20}
    pendulum |= {"learning_rate": 0.02, "goal": -150, "attempts": 1}
    problems = {
        "CartPole-v1": {},
        "botschool/PushedCartPole-v0": {},
        "Pendulum-v1": pendulum,
    }
    policies = {name: train(name, seed=1, **options) for name, options in problems.items()}
    runs = {
        name: (policies[name]["returns"], options.get("percentile", 70))
        for name, options in problems.items()
    }
    maps = {}
    for name, policy in policies.items():
        if name == "Pendulum-v1":
            limits, labels, meaning = (-np.pi, np.pi, -8.0, 8.0), ("angle", "speed"), "torque (Nm)"
        else:
            limits, labels = (-0.2, 0.2, -2.0, 2.0), ("pole's angle", "pole's speed")
            meaning = "force (N)" if "Pushed" in name else "score: right minus left"
        picture = np.empty((61, 61))
        for row, speed in enumerate(np.linspace(limits[2], limits[3], 61)):
            for column, angle in enumerate(np.linspace(limits[0], limits[1], 61)):
                upright = np.array([0.0, 0.0, angle, speed])
                turned = np.array([np.cos(angle), np.sin(angle), speed])
                seen = turned if name == "Pendulum-v1" else upright
                outputs = outputs_of(policy["parameters"], seen)
                picture[row, column] = outputs[-1] - (outputs[0] if len(outputs) > 1 else 0)
        if name == "Pendulum-v1":
            picture = picture.clip(-2, 2)
        elif "Pushed" in name:
            picture = 10 * picture.clip(-1, 1)
        maps[name] = picture, labels, limits, meaning
    draw_learning("learning.png", runs, maps)
    parameters = policies["Pendulum-v1"]["parameters"]

    def act(observation):
        return outputs_of(parameters, observation).clip(-2, 2).astype(np.float32)

    film_agent("pendulum.mp4", "Pendulum-v1", act, episodes=3)
