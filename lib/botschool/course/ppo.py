"""Train CartPole by PPO, with the student's functions between two rollouts.

The functions use NumPy, so torch cannot differentiate them. The module measures their derivatives
with respect to each step's log-probability, value and scores: it makes one of these numbers a
little larger and calls the function again. torch applies the chain rule from there back through
the network.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

ENVIRONMENT = "CartPole-v1"
STEPS, ENVS, EPOCHS, BATCH = 128, 4, 4, 128
"""Steps of a rollout in each environment; environments; epochs; steps of an update."""
GAMMA, LAMBDA, CLIP, TARGET_KL = 0.99, 0.95, 0.2, 0.02
ENTROPY, CRITIC, LEARNING_RATE = 0.01, 0.5, 0.002
SMALL = 1e-6
"""How much to add to a number to measure its effect on the loss."""


def train_own(functions: dict[str, Callable], seed: int, steps: int = 30_000) -> dict:
    """Train on CartPole-v1 with the functions of exercise 13, by their names.

    Return "steps" and "returns" of the episodes in the order of their ends, and "layers": the
    (weights, biases) of the trained policy, float64.
    """
    import torch

    torch.manual_seed(seed)
    policy, critic = _network(2), _network(1)
    parameters = [*policy.parameters(), *critic.parameters()]
    optimiser = torch.optim.Adam(parameters, lr=LEARNING_RATE, eps=1e-5)
    world = _World(seed)
    rng = np.random.default_rng(seed)
    for _ in range(steps // (STEPS * ENVS)):
        rollout = world.collect(policy, critic, rng, functions)
        for batch in _batches(rollout, rng):
            loss = _loss(functions, policy, critic, batch)
            if loss is None:  # the policy has moved far enough
                break
            optimiser.zero_grad()
            loss.backward()
            torch.nn.utils.clip_grad_norm_(parameters, 0.5)
            optimiser.step()
    layers = [
        (layer.weight.detach().numpy(), layer.bias.detach().numpy())
        for layer in policy
        if hasattr(layer, "weight")
    ]
    return {"steps": world.ends, "returns": world.returns, "layers": layers}


def _network(outputs: int):
    import torch

    layers = [torch.nn.Linear(4, 64), torch.nn.Linear(64, 64), torch.nn.Linear(64, outputs)]
    for layer, gain in zip(layers, (2**0.5, 2**0.5, 0.01 if outputs == 2 else 1.0), strict=True):
        torch.nn.init.orthogonal_(layer.weight, gain)
        torch.nn.init.zeros_(layer.bias)
    tanh = torch.nn.Tanh()
    return torch.nn.Sequential(layers[0], tanh, layers[1], tanh, layers[2]).double()


class _World:
    """Environments that step together, and the episodes that have ended in them."""

    def __init__(self, seed: int) -> None:
        import gymnasium

        self._envs = [gymnasium.make(ENVIRONMENT) for _ in range(ENVS)]
        self._seen = np.array([env.reset(seed=seed + i)[0] for i, env in enumerate(self._envs)])
        self._starts, self._running = np.ones(ENVS), np.zeros(ENVS)
        self._steps = 0
        self.ends: list[int] = []
        self.returns: list[float] = []

    def collect(self, policy, critic, rng: np.random.Generator, functions: dict) -> dict:
        """Return a rollout, flattened to (STEPS * ENVS, ...)."""
        import torch

        rows = []
        with torch.no_grad():
            for _ in range(STEPS):
                seen = torch.as_tensor(self._seen, dtype=torch.float64)
                logarithms = torch.log_softmax(policy(seen), dim=1).numpy()
                values = critic(seen)[:, 0].numpy()
                actions = (rng.random(ENVS) < np.exp(logarithms[:, 1])).astype(int)
                row = {"seen": seen.numpy(), "values": values, "actions": actions}
                row["log_prob"] = logarithms[np.arange(ENVS), actions]
                row["starts"] = self._starts.copy()
                row |= self._step(actions, critic)
                rows.append(row)
            last = critic(torch.as_tensor(self._seen, dtype=torch.float64))[:, 0].numpy()
        rollout = {key: np.array([row[key] for row in rows]) for key in rows[0]}
        ends = [rollout.pop(key) for key in ("terminated", "truncated", "final_values")]
        rewards = functions["bootstrapped"](rollout["rewards"], *ends, GAMMA)
        rollout["advantages"] = functions["advantages"](
            rewards, rollout["values"], rollout["starts"], last, self._starts.copy(),
            GAMMA, LAMBDA,
        )  # fmt: skip
        rollout["returns"] = rollout["advantages"] + rollout["values"]
        return {
            key: array.reshape(STEPS * ENVS, *array.shape[2:]) for key, array in rollout.items()
        }

    def _step(self, actions: np.ndarray, critic) -> dict[str, np.ndarray]:
        """Return rewards, ends, and the critic's values of the observations before resets."""
        import torch

        rewards, ended, cut = np.zeros((3, ENVS))
        final = np.zeros(self._seen.shape)
        for i, env in enumerate(self._envs):
            seen, rewards[i], terminated, truncated, _ = env.step(int(actions[i]))
            self._steps += 1
            self._running[i] += rewards[i]
            self._starts[i] = terminated or truncated
            ended[i], cut[i], final[i] = terminated, truncated, seen
            if self._starts[i]:
                self.ends.append(self._steps)
                self.returns.append(float(self._running[i]))
                self._running[i] = 0
                seen, _ = env.reset()
            self._seen[i] = seen
        values = critic(torch.as_tensor(final))[:, 0].numpy()
        return {"rewards": rewards, "terminated": ended, "truncated": cut, "final_values": values}


def _batches(rollout: dict, rng: np.random.Generator):
    for _ in range(EPOCHS):
        order = rng.permutation(len(rollout["seen"]))
        for at in range(0, len(order), BATCH):
            yield {key: array[order[at : at + BATCH]] for key, array in rollout.items()}


def _loss(functions: dict[str, Callable], policy, critic, batch: dict):
    """Return a value with the gradient of the student's loss; None if it is time to stop."""
    import torch

    seen = torch.as_tensor(batch["seen"])
    scores, values = policy(seen), critic(seen)[:, 0]
    taken = torch.as_tensor(batch["actions"])[:, None]
    log_prob = torch.log_softmax(scores, dim=1).gather(1, taken)[:, 0]
    now = {"log_prob": log_prob, "values": values, "scores": scores}
    said = {name: tensor.detach().numpy() for name, tensor in now.items()}
    divergence = functions["approx_kl"](said["log_prob"], batch["log_prob"])
    if functions["updates_made"]([[divergence]], TARGET_KL) == 0:
        return None

    def loss_of_policy(log_prob: np.ndarray) -> float:
        old, advantages = batch["log_prob"], batch["advantages"]
        return functions["policy_loss"](log_prob, old, advantages, CLIP)["loss"]

    def loss_of_critic(values: np.ndarray) -> float:
        return functions["value_loss"](values, batch["values"], batch["returns"])

    of_policy, of_critic = loss_of_policy(said["log_prob"]), loss_of_critic(said["values"])
    entropies = functions["entropy_of_choices"](said["scores"])

    def total(of_policy=of_policy, of_critic=of_critic, entropies=entropies) -> float:
        return functions["total_loss"](of_policy, of_critic, entropies, ENTROPY, CRITIC)

    here = total()
    slopes = {name: np.zeros_like(array) for name, array in said.items()}
    for place in np.ndindex(slopes["log_prob"].shape):
        loss = loss_of_policy(_larger(said["log_prob"], place))
        slopes["log_prob"][place] = (total(of_policy=loss) - here) / SMALL
        loss = loss_of_critic(_larger(said["values"], place))
        slopes["values"][place] = (total(of_critic=loss) - here) / SMALL
    for action in range(said["scores"].shape[1]):  # a step's entropy depends on that step only
        more = said["scores"].copy()
        more[:, action] += SMALL
        rise = (functions["entropy_of_choices"](more) - entropies) / SMALL
        weight = (total(entropies=entropies + 1) - here) / len(entropies)
        slopes["scores"][:, action] = weight * rise
    return sum((torch.as_tensor(slopes[name]) * now[name]).sum() for name in now)


def _larger(array: np.ndarray, place) -> np.ndarray:
    more = array.copy()
    more[place] += SMALL
    return more


def act_greedily(layers: list[tuple[np.ndarray, np.ndarray]]) -> Callable[[np.ndarray], int]:
    """Return a function that takes the action with the highest score; layers: from train_own."""

    def act(observation: np.ndarray) -> int:
        for weights, biases in layers[:-1]:
            observation = np.tanh(weights @ observation + biases)
        weights, biases = layers[-1]
        return int(np.argmax(weights @ observation + biases))

    return act


def draw_own_training(file: str | Path, runs: dict[int, dict]) -> None:
    """Draw every episode of some trainings as a dot, and their running means.

    runs: seed -> "steps" and "returns" of its episodes.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    for colour, (seed, run) in zip(("#0072b2", "#d55e00", "#009e73"), runs.items(), strict=False):
        steps, returns = np.array(run["steps"]), np.array(run["returns"])
        axes.plot(steps, returns, ".", color=colour, alpha=0.3, markersize=4)
        window = min(20, len(returns))
        mean = np.convolve(returns, np.full(window, 1 / window), "valid")
        axes.plot(steps[window - 1 :], mean, color=colour, linewidth=2, label=f"seed {seed}")
    axes.set(xlabel="steps", ylabel="return of an episode", title="Your own losses train CartPole")
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    axes.legend(frameon=False, title="mean of 20 episodes", loc="upper left")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")
