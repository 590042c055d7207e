"""The cross-entropy method, whole and in one file. Read it from top to bottom.

The simplest reinforcement learning there is: play some episodes with a policy that chooses its
actions at random, keep the best of them, and make what was done in these more probable.

    python lib/walkthroughs/crossentropy.py
    python lib/walkthroughs/crossentropy.py --env CartPoleMotor

The first has discrete actions (left or right, chosen by a softmax of the outputs); the second is
the same pole with a motor, whose action is a number (a Gaussian around the output: below 0 pushes
left, above 0 right). Any Gymnasium id works, though not every problem is solved.

Rubinstein and Kroese, The cross-entropy method, 2004.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import gymnasium
import numpy as np
import torch
from gymnasium import spaces
from shared import new_folder, read_hyperparameters, run
from torch import nn
from torch.distributions import Categorical, Distribution, Independent, Normal

from botschool.config import hyper
from botschool.errors import BotschoolError
from botschool.problems.gym import make_env


# 1. Hyperparameters ---------------------------------------------------------------------------
@dataclass
class Hyperparameters:
    """Hyperparameters; the defaults are those of CartPole."""

    env: str = hyper("CartPole-v1", "Gymnasium id, or CartPoleMotor")
    seed: int = hyper(1, "decides every random number", low=0)
    episodes: int = hyper(16, "episodes in an iteration", low=2)
    percentile: float = hyper(70.0, "% of the episodes that are thrown away", low=0, high=99.9)
    iterations: int = hyper(100, "at most", low=1)
    goal: float = hyper(475.0, "training ends when the mean return of an iteration reaches it")
    maxsteps: int = hyper(500, "steps of an episode, at most", low=1)
    nhiddens: int = hyper(64, "hidden neurons", low=1)
    learning_rate: float = hyper(0.01, "step size of Adam", above=0)
    epochs: int = hyper(5, "passes through the kept steps in an iteration", low=1)


# 2. Problems ----------------------------------------------------------------------------------
def make(name: str) -> gymnasium.Env:
    """Return an environment by its Gymnasium id, or CartPoleMotor: CartPole with a Box action."""
    if name != "CartPoleMotor":
        return make_env(name)
    motor = spaces.Box(-1.0, 1.0, (1,), np.float32)
    return gymnasium.wrappers.TransformAction(
        make_env("CartPole-v1"), lambda action: int(action[0] > 0), motor
    )


def check_spaces(name: str, env: gymnasium.Env) -> None:
    """Raise BotschoolError if the policies below do not suit the environment."""
    observed, acted = env.observation_space, env.action_space
    suits = isinstance(observed, spaces.Box) and isinstance(acted, (spaces.Box, spaces.Discrete))
    if not suits or len(observed.shape) != 1 or len(acted.shape) > 1:
        raise BotschoolError(
            f"{name} observes {observed} and acts by {acted}, but flat Box observations and "
            "Discrete or flat Box actions are needed: choose another environment."
        )


# 3. The policy --------------------------------------------------------------------------------
class Policy(nn.Module):
    """A network whose outputs determine the probability of each action."""

    def __init__(self, env: gymnasium.Env, nhiddens: int) -> None:
        super().__init__()
        self.discrete = isinstance(env.action_space, spaces.Discrete)
        inputs = env.observation_space.shape[0]
        outputs = int(env.action_space.n) if self.discrete else env.action_space.shape[0]
        self.network = nn.Sequential(
            nn.Linear(inputs, nhiddens), nn.ReLU(), nn.Linear(nhiddens, outputs)
        )
        self.log_std = None if self.discrete else nn.Parameter(torch.zeros(outputs))

    def forward(self, observations: torch.Tensor) -> Distribution:
        """Return the distribution of the action for each observation, shape (..., inputs)."""
        outputs = self.network(observations)
        if self.discrete:
            return Categorical(logits=outputs)
        return Independent(Normal(outputs, self.log_std.exp().expand_as(outputs)), 1)


# 4. Episodes ----------------------------------------------------------------------------------
@dataclass
class Episode:
    """One episode that was played."""

    observations: list[np.ndarray] = field(default_factory=list)
    actions: list[np.ndarray] = field(default_factory=list)
    reward: float = 0.0
    """Sum of the rewards: the return."""


@torch.no_grad()
def play(policy: Policy, envs: list[gymnasium.Env], maxsteps: int, explore=True) -> list[Episode]:
    """Play one episode in each environment, in parallel; without exploring, take the likeliest
    actions.
    """
    episodes = [Episode() for _ in envs]
    observations = [env.reset()[0] for env in envs]
    alive = list(range(len(envs)))
    for _ in range(maxsteps):
        distribution = policy(torch.tensor(np.array([observations[i] for i in alive])).float())
        actions = (distribution.sample() if explore else distribution.mode).numpy()
        for i, action in zip(tuple(alive), actions, strict=True):
            episodes[i].observations.append(observations[i])
            episodes[i].actions.append(action)
            observations[i], reward, terminated, truncated, _ = envs[i].step(
                fitted(action, envs[i].action_space)
            )
            episodes[i].reward += float(reward)
            if terminated or truncated:
                alive.remove(i)
        if not alive:
            break
    return episodes


def fitted(action: np.ndarray, space):
    """Return an action that the environment accepts: a Gaussian may exceed the motor's force."""
    if isinstance(space, spaces.Discrete):
        return int(space.start + action)
    return np.clip(action, space.low, space.high).astype(space.dtype)


# 5. The filter --------------------------------------------------------------------------------
def keep_best(episodes: list[Episode], percentile: float) -> tuple[list[Episode], float]:
    """Return the episodes whose return reaches the percentile of all returns,
    and that threshold.
    """
    threshold = float(np.percentile([episode.reward for episode in episodes], percentile))
    return [episode for episode in episodes if episode.reward >= threshold], threshold


# 6. Learning ----------------------------------------------------------------------------------
def learn(policy: Policy, optimiser, kept: list[Episode], epochs: int) -> float:
    """Make the actions of these episodes more probable; return the last loss.

    The loss is minus the mean logarithm of their probability: the cross-entropy.
    """
    observations = torch.tensor(np.concatenate([each.observations for each in kept])).float()
    actions = torch.tensor(np.concatenate([each.actions for each in kept]))
    for _ in range(epochs):
        optimiser.zero_grad()
        loss = -policy(observations).log_prob(actions).mean()
        loss.backward()
        optimiser.step()
    return loss.item()


def train(
    h: Hyperparameters, report=lambda text: None
) -> tuple[Policy, list[list[float]], list[float]]:
    """Return a trained policy; and for each iteration the returns of all episodes and the
    threshold.
    """
    torch.manual_seed(h.seed)
    envs = [make(h.env) for _ in range(h.episodes)]
    check_spaces(h.env, envs[0])
    for i, env in enumerate(envs):
        env.reset(seed=h.seed * h.episodes + i)  # seeds all later resets, too
    policy = Policy(envs[0], h.nhiddens)
    optimiser = torch.optim.Adam(policy.parameters(), lr=h.learning_rate)
    returns: list[list[float]] = []
    thresholds: list[float] = []
    for iteration in range(h.iterations):
        episodes = play(policy, envs, h.maxsteps)
        kept, threshold = keep_best(episodes, h.percentile)
        loss = learn(policy, optimiser, kept, h.epochs)
        returns.append([episode.reward for episode in episodes])
        thresholds.append(threshold)
        mean = float(np.mean(returns[-1]))
        report(
            f"iteration {iteration + 1:3d}   loss {loss:6.3f}   mean return {mean:8.1f}"
            f"   threshold {threshold:8.1f}   kept {len(kept)} of {h.episodes}"
        )
        if mean >= h.goal:
            break
    for env in envs:
        env.close()
    return policy, returns, thresholds


# 7. The picture -------------------------------------------------------------------------------
def draw(file: Path, returns: list[list[float]], thresholds: list[float], title: str) -> None:
    """Draw every episode of every iteration, kept or thrown away, and the
    threshold between them.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 5), layout="constrained")
    axes = figure.subplots()
    x = np.arange(1, len(returns) + 1)
    iterations, rewards = np.repeat(x, len(returns[0])), np.ravel(returns)
    kept = rewards >= np.repeat(thresholds, len(returns[0]))
    for chosen, colour, label in ((~kept, "#999999", "thrown away"), (kept, "#d55e00", "kept")):
        axes.plot(
            iterations[chosen],
            rewards[chosen],
            ".",
            color=colour,
            alpha=0.7,
            label=f"episode {label}",
        )
    axes.plot(x, np.mean(returns, axis=1), color="#0072b2", linewidth=2, label="mean")
    axes.step(x, thresholds, where="mid", color="black", linewidth=1, label="threshold")
    axes.set(title=title, xlabel="iteration", ylabel="return of an episode")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def main() -> None:
    h = read_hyperparameters(Hyperparameters, __doc__)
    torch.set_num_threads(1)  # this network is too small for more threads
    policy, returns, thresholds = train(h, print)
    envs = [make(h.env) for _ in range(20)]
    for i, env in enumerate(envs):
        env.reset(seed=1_000_000 + i)
    new = [each.reward for each in play(policy, envs, h.maxsteps, explore=False)]
    solved = "Solved. " if np.mean(returns[-1]) >= h.goal else ""
    print(f"{solved}20 new episodes without exploring: {np.mean(new):.1f} +- {np.std(new):.1f}")
    folder = new_folder(f"crossentropy_{h.env.replace('/', '_').replace(':', '_')}")
    draw(folder / "episodes.png", returns, thresholds, f"Cross-entropy on {h.env}, seed {h.seed}")


if __name__ == "__main__":
    run(main)
