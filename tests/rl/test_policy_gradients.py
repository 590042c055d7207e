"""The native learner's numbers: gradients beside torch's, losses beside Stable-Baselines3's."""

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.rl.native import PPO, Minibatch

torch = pytest.importorskip("torch")

pytestmark = pytest.mark.slow

NETWORKS = [
    ("CartPole-v1", {}),
    ("Acrobot-v1", {"net_arch": [32, 16, 24], "activation_fn": "relu"}),
    ("Acrobot-v1", {"net_arch": [48], "share_layers": True}),
    ("Pendulum-v1", {"net_arch": {"pi": [7], "vf": [33, 5]}}),
    ("botschool/PlanarHopper-v5", {"net_arch": [64, 40], "share_layers": True}),
    ("botschool/PlanarWalker2D-v5", {"net_arch": [], "activation_fn": "relu"}),
]


def random_agent(env, seed=1, size=0.1, **options):
    """First parameters, moved by Gaussian numbers of this size."""
    ppo = PPO(env, seed=seed, n_envs=3, n_steps=4, **options)
    rng = np.random.default_rng(seed)
    ppo.parameters[:] += size * rng.standard_normal(len(ppo.parameters)).astype(np.float32)
    return ppo


def random_batch(ppo, n, seed=2):
    rng = np.random.default_rng(seed)
    rollout = ppo.core.rollout
    observations = rng.standard_normal((n, rollout["observations"].shape[2])).astype(np.float32)
    outputs, values = ppo.core.forward(observations)
    if "log_std" in ppo.weights:
        actions = outputs + rng.standard_normal(outputs.shape)
    else:
        actions = rng.integers(0, outputs.shape[1], (n, 1))
    empty = np.zeros(n, dtype=np.float32)
    batch = Minibatch(observations, actions.astype(np.float32), empty, values, empty, empty)
    return Minibatch(
        batch.observations,
        batch.actions,
        (ppo.loss(batch).log_probs + 0.3 * rng.standard_normal(n)).astype(np.float32),
        (values + 0.4 * rng.standard_normal(n)).astype(np.float32),
        (2 + rng.standard_normal(n)).astype(np.float32),
        (values + rng.standard_normal(n)).astype(np.float32),
    )


class Reference:
    """The same agent and loss in torch."""

    def __init__(self, ppo, precision=np.float64):
        self.ppo, self.h, self.precision = ppo, ppo.hyperparameters, precision
        self.parameters = torch.tensor(ppo.parameters.astype(precision), requires_grad=True)
        self.parts = {
            name: self.parameters[place : place + int(np.prod(shape))].reshape(shape)
            for name, shape, place in ppo.core.parts
        }

    def net(self, name, x, ends_linear=True):
        layers = sum(key.startswith(f"{name}.") for key in self.parts) // 2
        for layer in range(layers):
            x = x @ self.parts[f"{name}.{layer}.weight"].T + self.parts[f"{name}.{layer}.bias"]
            if layer + 1 < layers or not ends_linear:
                x = torch.tanh(x) if self.h.activation_fn == "tanh" else torch.relu(x)
        return x

    def outputs(self, observations):
        features = self.net("shared", observations, ends_linear=False)
        return self.net("actor", features), self.net("critic", features)[:, 0]

    def distribution(self, outputs):
        if "log_std" not in self.parts:
            return torch.distributions.Categorical(logits=outputs)
        gaussian = torch.distributions.Normal(outputs, self.parts["log_std"].exp())
        return torch.distributions.Independent(gaussian, 1)

    def loss(self, batch, clip_range, clip_range_vf):
        observations, actions, log_probs, old_values, advantages, returns = (
            torch.tensor(np.asarray(column, dtype=self.precision))
            for column in vars(batch).values()
        )
        outputs, values = self.outputs(observations)
        distribution = self.distribution(outputs)
        found = distribution.log_prob(actions if "log_std" in self.parts else actions[:, 0])
        if self.h.normalize_advantage:
            advantages = (advantages - advantages.mean()) / (advantages.std() + 1e-8)
        ratio = (found - log_probs).exp()
        surrogate = advantages * ratio
        if clip_range is not None:
            clipped = advantages * ratio.clamp(1 - clip_range, 1 + clip_range)
            surrogate = torch.min(surrogate, clipped)
        if clip_range_vf is not None:
            values = old_values + (values - old_values).clamp(-clip_range_vf, clip_range_vf)
        policy_loss, value_loss = -surrogate.mean(), ((values - returns) ** 2).mean()
        entropy = distribution.entropy().mean()
        loss = policy_loss + self.h.vf_coef * value_loss - self.h.ent_coef * entropy
        loss.backward()
        numbers = {"policy_loss": policy_loss, "value_loss": value_loss, "entropy": entropy}
        return {name: value.item() for name, value in (numbers | {"loss": loss}).items()}


@pytest.mark.parametrize(("env", "network"), NETWORKS)
@pytest.mark.parametrize("n", [1, 64, 200])
@pytest.mark.parametrize("clips", [(0.2, None), (0.1, 0.3), (None, None)])
def test_gradients_are_torchs(env, network, n, clips):
    clip_range, clip_range_vf = clips
    ppo = random_agent(
        env, clip_range=clip_range, clip_range_vf=clip_range_vf, ent_coef=0.02, **network
    )
    ppo.hyperparameters.normalize_advantage = n > 1
    batch = random_batch(ppo, n)
    found = ppo.loss(batch)
    reference = Reference(ppo)
    expected = reference.loss(batch, clip_range, clip_range_vf)
    for name, value in expected.items():
        assert getattr(found, name) == pytest.approx(value, rel=1e-5, abs=1e-6), name
    gradient = reference.parameters.grad.numpy()
    apart = np.linalg.norm(found.gradient - gradient) / np.linalg.norm(gradient)
    assert apart < 1e-6
    for name, part in ppo.named(gradient).items():  # and no part is hidden by a larger one
        assert np.abs(found.gradients[name] - part).max() <= 1e-5 * np.abs(part).max() + 1e-7, name
    if n == 200 and clip_range:
        assert 0.1 < found.clip_fraction < 0.95


def test_adam_is_torchs():
    ppo = random_agent("Pendulum-v1", max_grad_norm=0.5)
    mine = torch.nn.Parameter(torch.tensor(ppo.parameters.copy()))
    adam = torch.optim.Adam([mine], lr=0.003, eps=1e-5)
    rng = np.random.default_rng(3)
    for size in (0.001, 1.0, 0.1):
        gradient = (size * rng.standard_normal(len(ppo.parameters))).astype(np.float32)
        mine.grad = torch.tensor(gradient)
        torch.nn.utils.clip_grad_norm_([mine], 0.5)
        adam.step()
        ppo.step(gradient, 0.003)
        np.testing.assert_allclose(ppo.parameters, mine.detach().numpy(), rtol=0, atol=2e-7)


@pytest.mark.parametrize("env", ["CartPole-v1", "Pendulum-v1"])
def test_a_rollout_means_to_stable_baselines3_what_it_means_here(env):
    """Advantages, log probabilities, values and ratios, by its own buffer and policy."""
    pytest.importorskip("stable_baselines3")
    from stable_baselines3.common.buffers import RolloutBuffer

    from botschool.rl.native.sb3 import to_sb3

    ppo = PPO(env, n_envs=5, n_steps=300, gamma=0.97, gae_lambda=0.9, normalize=True)
    rollout = ppo.collect()
    model = to_sb3(ppo)
    space = model.action_space
    buffer = RolloutBuffer(
        300, model.observation_space, space, gamma=0.97, gae_lambda=0.9, n_envs=5
    )
    starts = np.vstack([np.ones(5), rollout.ended[:-1] > 0])
    for t in range(300):
        buffer.add(
            rollout.observations[t], rollout.actions[t], rollout.rewards[t], starts[t],
            torch.tensor(rollout.values[t]), torch.tensor(rollout.log_probs[t]),
        )  # fmt: skip
    assert rollout.ended.any()
    buffer.compute_returns_and_advantage(torch.tensor(rollout.last_values), rollout.ended[-1] > 0)
    np.testing.assert_allclose(rollout.advantages, buffer.advantages, rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(rollout.returns, buffer.returns, rtol=1e-4, atol=1e-5)
    ppo.update()
    model = to_sb3(ppo)
    batch = ppo.minibatch(np.arange(0, 1500, 7))
    actions = batch.actions[:, 0] if env == "CartPole-v1" else batch.actions
    with torch.no_grad():
        values, log_probs, entropy = model.policy.evaluate_actions(
            torch.tensor(batch.observations), torch.tensor(actions)
        )
    found = ppo.loss(batch)
    np.testing.assert_allclose(found.values, values.numpy()[:, 0], rtol=1e-5, atol=1e-5)
    ratios = (log_probs - torch.tensor(batch.log_probs)).exp().numpy()
    np.testing.assert_allclose(found.ratios, ratios, rtol=2e-5)
    assert np.abs(ratios - 1).max() > 0.01
    assert found.entropy == pytest.approx(entropy.mean().item(), rel=1e-5)


def test_the_actions_drawn_are_the_policys():
    """Frequencies of a choice and moments of a Gaussian, over many environments."""
    ppo = random_agent("Acrobot-v1", seed=4)
    ppo = PPO("Acrobot-v1", seed=4, n_envs=2000, n_steps=20)
    ppo.parameters[:] *= 3
    ppo.weights["actor.2.bias"][:] = [0.5, -0.4, 0.1]
    rollout = ppo.collect()
    outputs = ppo.core.forward(rollout.observations.reshape(-1, 6))[0].astype(float)
    chances = np.exp(outputs) / np.exp(outputs).sum(axis=1, keepdims=True)
    drawn = rollout.actions.ravel()
    for action in range(3):
        share, expected = (drawn == action).mean(), chances[:, action].mean()
        assert abs(share - expected) < 4 * np.sqrt(0.25 / len(drawn))
    ppo = PPO("botschool/PlanarWalker2D-v5", seed=5, n_envs=1000, n_steps=10, log_std_init=-0.7)
    rollout = ppo.collect()
    outputs = ppo.core.forward(rollout.observations.reshape(-1, 17))[0]
    z = (rollout.actions.reshape(-1, 6) - outputs) / np.exp(-0.7)
    assert np.abs(z.mean(axis=0)).max() < 0.04
    assert np.abs(np.cov(z.T) - np.eye(6)).max() < 0.06
    assert abs((z**4).mean() - 3) < 0.15


def test_running_moments_are_numpys():
    ppo = PPO("botschool/PlanarHopper-v5", seed=2, n_envs=40, n_steps=30, normalize=True)
    plain = PPO("botschool/PlanarHopper-v5", seed=2, n_envs=40, n_steps=30)
    # agents that normalise act otherwise, so that only the first look compares
    mean, variance = ppo.core.observed
    first = plain.collect().observations[0].astype(np.float64)
    np.testing.assert_allclose(mean, first.mean(axis=0), rtol=1e-4, atol=1e-5)
    np.testing.assert_allclose(variance, first.var(axis=0), rtol=1e-3, atol=1e-5)
    rollout = ppo.collect()
    assert np.abs(rollout.observations).max() <= 10
    assert 0.2 < rollout.observations.std(axis=(0, 1)).mean() < 2


def test_bad_hyperparameters_are_sentences():
    for options, word in (
        ({"n_epoch": 3}, "n_epochs"),
        ({"n_epochs": 10**20}, "whole number"),
        ({"gamma": 1.2}, "gamma"),
        ({"net_arch": [0]}, "net_arch"),
        ({"net_arch": [8] * 9}, "net_arch"),
        ({"net_arch": {"pi": [2**31]}}, "at most 4096 neurons"),
        ({"clip_range": "linaer 3"}, "clip_range"),
        ({"activation_fn": "sine"}, "activation_fn"),
    ):
        with pytest.raises(BotschoolError, match=word):
            PPO("CartPole-v1", **options)
    with pytest.raises(BotschoolError, match="CartPole-v1"):
        PPO("CartPole-v7")
    with pytest.raises(BotschoolError, match="broke down"):
        PPO("Pendulum-v1").step(np.full(8963, np.nan, dtype=np.float32))
