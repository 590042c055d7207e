"""PPO, proximal policy optimisation. Read it from top to bottom: the whole method is here.

The rest is not PPO: options and folders (shared.py), the picture (ppo_picture.py), and environments
by name (botschool).

A policy network acts in several environments at once, and a value network (the critic) learns to
predict the return that will follow. What went better than predicted is made more probable, what
went worse less probable; and to be safe, no probability may change by much in one update.

    python lib/walkthroughs/ppo.py
    python lib/walkthroughs/ppo.py --env Pendulum-v1 --n_envs 4 --n_steps 1024 --batch_size 64 \\
        --n_epochs 10 --gamma 0.9 --gae_lambda 0.95 --anneal 0

Look at the indicators while it runs: tensorboard --logdir results/walkthroughs

Schulman and others, Proximal policy optimization algorithms, 2017 (arXiv 1707.06347); generalised
advantage estimation: the same, 2016 (arXiv 1506.02438). Hyperparameters and indicators are named as
in Stable-Baselines3, whose learning curves this file is compared with in docs/reports/results.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import gymnasium
import numpy as np
import torch
from gymnasium import spaces
from gymnasium.vector import AutoresetMode, SyncVectorEnv
from ppo_picture import draw
from shared import new_folder, read_hyperparameters, run
from torch import nn
from torch.distributions import Categorical, Independent, Normal

from botschool.config import NO_YES, hyper
from botschool.errors import BotschoolError
from botschool.problems.gym import make_env


# 1. Hyperparameters ---------------------------------------------------------------------------
@dataclass
class Hyperparameters:
    """Hyperparameters; the defaults are those of CartPole, the text above has those of Pendulum."""

    env: str = hyper("CartPole-v1", "Gymnasium id, with Discrete or Box actions")
    seed: int = hyper(1, "decides every random number", low=0)
    total_timesteps: int = hyper(100_000, "steps of training, of all environments together", low=1)
    n_envs: int = hyper(8, "environments side by side", low=1)
    n_steps: int = hyper(32, "steps of each environment between two updates", low=1)
    batch_size: int = hyper(256, "steps in a minibatch", low=2)
    n_epochs: int = hyper(20, "how often an update goes through its data", low=1)
    gamma: float = hyper(0.98, "discount: what a reward one step later is worth", low=0, high=1)
    gae_lambda: float = hyper(0.8, "0: trust the critic; 1: trust the rewards", low=0, high=1)
    learning_rate: float = hyper(0.001, "step size of Adam", above=0)
    clip_range: float = hyper(0.2, "how far the ratio of probabilities may leave 1", above=0)
    anneal: int = hyper(1, "learning rate and clip range fall to 0 by the end", choices=NO_YES)
    ent_coef: float = hyper(0.0, "weight of the entropy: keeps the policy curious", low=0)
    vf_coef: float = hyper(0.5, "weight of the critic's loss", low=0)
    max_grad_norm: float = hyper(0.5, "longer gradients are shortened to this length", above=0)
    target_kl: float = hyper(
        0.0, "an update stops at 1.5 times this KL divergence; 0: never", low=0
    )
    nhiddens: int = hyper(64, "neurons in each of the two hidden layers", low=1)


# 2. The networks ------------------------------------------------------------------------------
class Agent(nn.Module):
    """A policy and a critic that share only the observation."""

    def __init__(self, observation_space: spaces.Box, action_space, nhiddens: int) -> None:
        super().__init__()
        self.discrete = isinstance(action_space, spaces.Discrete)
        inputs = observation_space.shape[0]
        outputs = int(action_space.n) if self.discrete else action_space.shape[0]
        # A policy whose outputs are tiny at first prefers no action.
        self.actor = layers(inputs, nhiddens, outputs, last_gain=0.01)
        self.critic = layers(inputs, nhiddens, 1, last_gain=1.0)
        if not self.discrete:
            self.log_std = nn.Parameter(torch.zeros(outputs))

    def policy(self, observations: torch.Tensor) -> torch.distributions.Distribution:
        """Return the distribution of the action for each observation, shape (..., inputs)."""
        outputs = self.actor(observations)
        if self.discrete:
            return Categorical(logits=outputs, validate_args=False)
        gaussian = Normal(outputs, self.log_std.exp().expand_as(outputs), validate_args=False)
        return Independent(gaussian, 1, validate_args=False)

    def value(self, observations: torch.Tensor) -> torch.Tensor:
        """Return the predicted discounted return, shape (...,)."""
        return self.critic(observations).squeeze(-1)


def layers(inputs: int, nhiddens: int, outputs: int, last_gain: float) -> nn.Sequential:
    """Return two tanh layers and a linear one; orthogonal weights, biases 0."""
    linear = [
        nn.Linear(*s) for s in ((inputs, nhiddens), (nhiddens, nhiddens), (nhiddens, outputs))
    ]
    for layer, gain in zip(linear, (2**0.5, 2**0.5, last_gain), strict=True):
        nn.init.orthogonal_(layer.weight, gain)
        nn.init.zeros_(layer.bias)
    return nn.Sequential(linear[0], nn.Tanh(), linear[1], nn.Tanh(), linear[2])


# 3. Experience --------------------------------------------------------------------------------
@dataclass
class Rollout:
    """The experience of n_envs environments in n_steps steps; arrays of shape (n_steps, n_envs)."""

    observations: torch.Tensor
    """(n_steps, n_envs, inputs)."""
    actions: torch.Tensor
    """(n_steps, n_envs), or (n_steps, n_envs, outputs) of a Box."""
    log_probs: torch.Tensor
    """Logarithm of the probability (density) with which the policy chose the action."""
    values: torch.Tensor
    """The critic's prediction for the observation."""
    rewards: torch.Tensor
    ended: torch.Tensor
    """1 where the episode ended with this step, else 0."""
    last_values: torch.Tensor
    """(n_envs,): the critic's predictions for the observations after the last step."""


class Experience:
    """Environments in which an agent acts, rollout after rollout."""

    def __init__(self, h: Hyperparameters) -> None:
        self.h = h
        # SAME_STEP: after an episode's last step the environment is reset at once. It returns the
        # first observation of the next episode; the last one is in "final_obs".
        self.envs = SyncVectorEnv(
            [lambda: make_env(h.env)] * h.n_envs, autoreset_mode=AutoresetMode.SAME_STEP
        )
        check_spaces(h.env, self.envs.single_observation_space, self.envs.single_action_space)
        self.observations, _ = self.envs.reset(seed=h.seed)
        self.returns = np.zeros(h.n_envs)
        self.lengths = np.zeros(h.n_envs, dtype=int)
        self.steps = 0
        self.episodes: list[tuple[int, float, int]] = []
        """(steps so far, return, length) of every episode that has ended."""

    @torch.no_grad()
    def collect(self, agent: Agent) -> Rollout:
        """Play and return the next n_steps steps."""
        moments = []
        for _ in range(self.h.n_steps):
            observations = tensor(self.observations)
            policy = agent.policy(observations)
            actions = policy.sample()
            self.observations, rewards, terminated, truncated, info = self.envs.step(
                fitted(actions.numpy(), self.envs.single_action_space)
            )
            ended = terminated | truncated
            self._count(rewards, ended)
            rewards = tensor(rewards)
            for i in np.flatnonzero(truncated & ~terminated):
                # Time ran out, but the task continued: add the critic's prediction of the rest.
                rewards[i] += self.h.gamma * agent.value(tensor(info["final_obs"][i]))
            moments.append(
                (observations, actions, policy.log_prob(actions), agent.value(observations),
                 rewards, tensor(ended))
            )  # fmt: skip
        columns = [torch.stack(column) for column in zip(*moments, strict=True)]
        return Rollout(*columns, last_values=agent.value(tensor(self.observations)))

    def _count(self, rewards: np.ndarray, ended: np.ndarray) -> None:
        self.steps += len(rewards)
        self.returns += rewards
        self.lengths += 1
        for i in np.flatnonzero(ended):
            self.episodes.append((self.steps, float(self.returns[i]), int(self.lengths[i])))
        self.returns[ended], self.lengths[ended] = 0.0, 0


def tensor(array: np.ndarray) -> torch.Tensor:
    return torch.as_tensor(np.asarray(array, dtype=np.float32))


def fitted(actions: np.ndarray, space) -> np.ndarray:
    """Return actions that the environment accepts: a Gaussian may exceed the motor's force."""
    if isinstance(space, spaces.Discrete):
        return space.start + actions
    return np.clip(actions, space.low, space.high).astype(space.dtype)


def check_spaces(env: str, observation_space, action_space) -> None:
    """Raise BotschoolError if the networks above do not suit these spaces."""
    for what, space, kinds in (
        ("observations", observation_space, spaces.Box),
        ("actions", action_space, (spaces.Box, spaces.Discrete)),
    ):
        if not isinstance(space, kinds) or len(space.shape) > 1:
            raise BotschoolError(
                f"{env} has {what} {space}, but this PPO needs flat Box observations and Discrete "
                "or flat Box actions: choose another environment."
            )


# 4. Advantages --------------------------------------------------------------------------------
def advantages_of(rollout: Rollout, gamma: float, gae_lambda: float) -> torch.Tensor:
    """Return how much better than predicted each step went: generalised advantage estimation.

    delta_t = r_t + gamma V_{t+1} - V_t  is the surprise of a step, and
    A_t = delta_t + gamma lambda A_{t+1}  adds the later ones, each with less weight. After the end
    of an episode nothing follows: V_{t+1} and A_{t+1} are 0. Shape (n_steps, n_envs).
    """
    advantages = torch.zeros_like(rollout.rewards)
    following_value, following = rollout.last_values, torch.zeros_like(rollout.last_values)
    for t in reversed(range(len(rollout.rewards))):
        goes_on = 1.0 - rollout.ended[t]
        delta = rollout.rewards[t] + gamma * goes_on * following_value - rollout.values[t]
        following = delta + gamma * gae_lambda * goes_on * following
        following_value = rollout.values[t]
        advantages[t] = following
    return advantages


# 5. Learning ----------------------------------------------------------------------------------
class Learner:
    """Changes an agent according to its experience."""

    def __init__(self, agent: Agent, h: Hyperparameters) -> None:
        self.agent, self.h = agent, h
        self.optimiser = torch.optim.Adam(agent.parameters(), lr=h.learning_rate, eps=1e-5)
        self.rng = np.random.default_rng(h.seed)

    def update(self, rollout: Rollout, progress: float) -> dict[str, float]:
        """Go n_epochs times through a rollout; return the means of the indicators.

        progress: share of the training that is done, from 0 to 1.
        """
        h = self.h
        left = 1.0 - progress if h.anneal else 1.0
        clip_range = h.clip_range * left
        self.optimiser.param_groups[0]["lr"] = h.learning_rate * left
        advantages = advantages_of(rollout, h.gamma, h.gae_lambda)
        returns = advantages + rollout.values
        columns = (rollout.observations, rollout.actions, rollout.log_probs, advantages, returns)
        data = [column.flatten(0, 1) for column in columns]
        seen: list[dict[str, float]] = []
        for _ in range(h.n_epochs):
            order = torch.as_tensor(self.rng.permutation(len(data[0])))
            for batch in order.split(h.batch_size):
                loss, found = self.loss(*(column[batch] for column in data), clip_range)
                seen.append(found)
                if h.target_kl and found["approx_kl"] > 1.5 * h.target_kl:
                    break
                self.optimiser.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(self.agent.parameters(), h.max_grad_norm)
                self.optimiser.step()
            else:
                continue
            break  # the policy is far enough from the one that collected the data
        means = {name: float(np.mean([each[name] for each in seen])) for name in seen[0]}
        left_over = torch.var(returns - rollout.values) / (torch.var(returns) + 1e-12)
        means["explained_variance"] = 1.0 - float(left_over)
        return means | {"learning_rate": h.learning_rate * left, "clip_range": clip_range}

    def loss(
        self,
        observations: torch.Tensor,
        actions: torch.Tensor,
        old_log_probs: torch.Tensor,
        advantages: torch.Tensor,
        returns: torch.Tensor,
        clip_range: float,
    ) -> tuple[torch.Tensor, dict[str, float]]:
        """Return the loss of a minibatch, and its indicators."""
        if len(advantages) > 1:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        policy = self.agent.policy(observations)
        log_ratio = policy.log_prob(actions) - old_log_probs
        ratio = log_ratio.exp()  # new probability of the action / old probability
        # The smaller of the two: no reward for leaving 1 +- clip_range, but a way back.
        clipped = ratio.clamp(1 - clip_range, 1 + clip_range)
        policy_loss = -torch.min(advantages * ratio, advantages * clipped).mean()
        value_loss = ((self.agent.value(observations) - returns) ** 2).mean()
        entropy = policy.entropy().mean()
        loss = policy_loss + self.h.vf_coef * value_loss - self.h.ent_coef * entropy
        with torch.no_grad():
            indicators = {
                "policy_gradient_loss": policy_loss,
                "value_loss": value_loss,
                "entropy_loss": -entropy,
                "approx_kl": (log_ratio.expm1() - log_ratio).mean(),  # ratio - 1 - log ratio >= 0
                "clip_fraction": ((ratio - 1).abs() > clip_range).float().mean(),
            }
        return loss, {name: value.item() for name, value in indicators.items()}


# 6. The loop ----------------------------------------------------------------------------------
@dataclass
class History:
    """The history of a training."""

    agent: Agent
    episodes: list[tuple[int, float, int]]
    """(steps so far, return, length) of every episode."""
    indicators: list[dict[str, float]] = field(default_factory=list)
    """Indicators of every update, including "steps"."""


def train(h: Hyperparameters, log=lambda name, value, steps: None, report=lambda text: None):
    """Train an agent from the seed; return its History.

    log(name, value, steps) is called for every indicator, report(line) about twenty times.
    """
    torch.manual_seed(h.seed)
    experience = Experience(h)
    envs = experience.envs
    agent = Agent(envs.single_observation_space, envs.single_action_space, h.nhiddens)
    learner = Learner(agent, h)
    history = History(agent, experience.episodes)
    reported = -1
    while experience.steps < h.total_timesteps:
        rollout = experience.collect(agent)
        progress = min(1.0, experience.steps / h.total_timesteps)
        found = {f"train/{k}": v for k, v in learner.update(rollout, progress).items()}
        if experience.episodes:
            _, returns, lengths = zip(*experience.episodes[-100:], strict=True)
            found["rollout/ep_rew_mean"] = float(np.mean(returns))
            found["rollout/ep_len_mean"] = float(np.mean(lengths))
        history.indicators.append({"steps": experience.steps, **found})
        for name, value in found.items():
            log(name, value, experience.steps)
        if int(20 * progress) > reported:
            reported = int(20 * progress)
            report(line_about(experience.steps, found))
    envs.close()
    return history


def line_about(steps: int, found: dict[str, float]) -> str:
    return (
        f"{steps:8d} steps   return {found.get('rollout/ep_rew_mean', np.nan):8.1f}"
        f"   KL {found['train/approx_kl']:6.4f}   clipped {found['train/clip_fraction']:4.0%}"
        f"   entropy {-found['train/entropy_loss']:6.3f}"
        f"   explained variance {found['train/explained_variance']:6.2f}"
    )


@torch.no_grad()
def evaluate(agent: Agent, env: str, episodes: int, seed: int) -> np.ndarray:
    """Return the return of each of some episodes with the most probable
    actions; shape (episodes,).
    """
    world: gymnasium.Env = make_env(env)
    returns = np.zeros(episodes)
    for episode in range(episodes):
        observation, _ = world.reset(seed=seed + episode)
        ended = False
        while not ended:
            action = agent.policy(tensor(observation)).mode.numpy()
            observation, reward, terminated, truncated, _ = world.step(
                fitted(action, world.action_space)
            )
            returns[episode] += float(reward)
            ended = terminated or truncated
    world.close()
    return returns


def main() -> None:
    from torch.utils.tensorboard import SummaryWriter

    h = read_hyperparameters(Hyperparameters, __doc__)
    torch.set_num_threads(1)  # these networks are too small for more threads
    make_env(h.env).close()
    folder = new_folder(f"ppo_{h.env.replace('/', '_').replace(':', '_')}")
    with SummaryWriter(folder) as writer:
        history = train(h, writer.add_scalar, print)
    returns = evaluate(history.agent, h.env, episodes=20, seed=10_000)
    print(f"20 new episodes without exploring: {returns.mean():.1f} +- {returns.std():.1f}")
    draw(
        history.episodes,
        history.indicators,
        f"PPO on {h.env}, seed {h.seed}",
        folder / "learning.png",
    )
    print(f"TensorBoard: tensorboard --logdir {folder}")


if __name__ == "__main__":
    run(main)
