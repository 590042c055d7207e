"""Compute what Stable-Baselines3's PPO computes, to compare it with your own functions.

Stable-Baselines3's own code (RolloutBuffer, PPO.train, distributions) computes everything, in
float64, so that rounding does not spoil comparisons to 1e-6.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from stable_baselines3 import PPO

KEPT = ("observations", "actions", "rewards", "values", "log_probs", "episode_starts")


class Rollout:
    """A rollout of Stable-Baselines3's PPO, with the values that its code derives.

    Arrays have the shape (steps, envs), with one more axis for `observations` and `actions`.
    `last_values` (the values of the observations after the last step) and `dones` (1.0 if the last
    step ended an episode, else 0.0) have the shape (envs,). `advantages` and `returns` come from
    RolloutBuffer.compute_returns_and_advantage.
    """

    def __init__(self, model: PPO) -> None:
        """Run the model's policy for n_steps steps in each of its environments."""
        import torch

        buffer = model.rollout_buffer
        _, callback = model._setup_learn(1, None)
        model.collect_rollouts(model.env, callback, buffer, n_rollout_steps=model.n_steps)
        with torch.no_grad():
            observed = torch.as_tensor(model._last_obs)
            last_values = model.policy.predict_values(observed).double().flatten()
        self._model = model
        self.gamma, self.gae_lambda = model.gamma, model.gae_lambda
        self.last_values = last_values.numpy()
        self.dones = model._last_episode_starts.astype(np.float64)
        kept = {name: getattr(buffer, name).astype(np.float64) for name in KEPT}
        buffer.reset()
        for name, array in kept.items():
            setattr(buffer, name, array)
            setattr(self, name, array.copy())
        buffer.advantages = np.zeros_like(kept["rewards"])
        buffer.compute_returns_and_advantage(last_values, self.dones)
        buffer.full = True
        self.advantages, self.returns = buffer.advantages.copy(), buffer.returns.copy()

    def train(self, epochs: int) -> None:
        """Train the model on the rollout, so that its policy is no longer the one that acted."""
        self._model.n_epochs = epochs
        self._model.train()

    def losses(
        self,
        clip_range: float = 0.2,
        clip_range_vf: float | None = None,
        ent_coef: float = 0.0,
        vf_coef: float = 0.5,
    ) -> tuple[dict[str, np.ndarray], dict[str, float]]:
        """Run one update of PPO.train on all steps as one batch; return its inputs and its log.

        Inputs, each of shape (steps * envs,), in the order in which PPO shuffled the steps:
        `values`, `log_prob` and `entropy` of the present policy; `old_values`, `old_log_prob`,
        `advantages` and `returns` of the rollout. Log: policy_gradient_loss, clip_fraction,
        value_loss, entropy_loss, approx_kl, loss, explained_variance (of the whole rollout).
        """
        model = self._model
        model.n_epochs = 1
        model.batch_size = model.n_steps * model.n_envs
        model.clip_range = lambda _: clip_range
        model.clip_range_vf = None if clip_range_vf is None else lambda _: clip_range_vf
        model.ent_coef, model.vf_coef = ent_coef, vf_coef
        batch = next(model.rollout_buffer.get(None))
        found: dict[str, Any] = {name: getattr(batch, name) for name in batch._fields}
        original = model.policy.evaluate_actions

        def evaluate_actions(observations, actions):
            answer = original(observations, actions)
            found["values"], found["log_prob"], found["entropy"] = (
                each.double() for each in answer
            )
            return found["values"], found["log_prob"], found["entropy"]

        model.rollout_buffer.get = lambda batch_size: iter([batch])
        model.policy.evaluate_actions = evaluate_actions
        try:
            model.train()
        finally:
            del model.rollout_buffer.get, model.policy.evaluate_actions
        given = {
            name: found[name].detach().numpy().reshape(-1)
            for name in ("values", "log_prob", "entropy", "old_values", "old_log_prob",
                         "advantages", "returns")
        }  # fmt: skip
        logged = {
            name.removeprefix("train/"): float(value)
            for name, value in model.logger.name_to_value.items()
        }
        return given, logged


def make_ppo(environment: str, seed: int, n_steps: int = 128, n_envs: int = 2, **options: Any):
    """Return a PPO of Stable-Baselines3 with an MLP policy, on the CPU, without a log."""
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.logger import Logger

    envs = make_vec_env(environment, n_envs, seed=seed)
    model = PPO("MlpPolicy", envs, n_steps=n_steps, seed=seed, device="cpu", **options)
    model.set_logger(Logger(None, []))
    return model


def updates_made(log_ratios: list[list[float]], target_kl: float) -> int:
    """Return how many updates PPO.train makes before it stops early.

    log_ratios: for each epoch and batch, the logarithm of the ratio of new to old probability, the
    same for all steps of the batch.
    """
    import torch

    model = make_ppo("CartPole-v1", seed=0, n_steps=2 * len(log_ratios[0]), n_envs=1, batch_size=2)
    Rollout(model)  # fills the buffer
    model.n_epochs, model.target_kl = len(log_ratios), target_kl
    waiting = iter([each for epoch in log_ratios for each in epoch])
    batch = next(model.rollout_buffer.get(2))
    made = 0

    def evaluate_actions(observations, actions):
        new = batch.old_log_prob + next(waiting)
        return torch.zeros(2, requires_grad=True), new, None

    def count(*_):
        nonlocal made
        made += 1

    model.rollout_buffer.get = lambda size: iter([batch] * len(log_ratios[0]))
    model.policy.evaluate_actions = evaluate_actions
    model.policy.optimizer.step = count
    model.train()
    return made


def policy_layers(model: PPO) -> list[tuple[np.ndarray, np.ndarray]]:
    """Return (weights, biases) of the policy's hidden layers, float64; activations are tanh."""
    layers = [each for each in model.policy.mlp_extractor.policy_net if hasattr(each, "weight")]
    return [
        (layer.weight.detach().double().numpy(), layer.bias.detach().double().numpy())
        for layer in layers
    ]
