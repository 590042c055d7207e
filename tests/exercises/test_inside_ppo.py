"""Our solution of exercise 13 computes what Stable-Baselines3's own code computes."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("stable_baselines3")

from botschool.rl import reference

pytestmark = pytest.mark.slow

FILE = Path(__file__).parents[2] / "solutions/ex13_inside_ppo/inside_ppo.py"
UPDATES = {
    "CartPole-v1": [
        {"clip_range": 0.2},
        {"clip_range": 0.05, "clip_range_vf": 0.5},
        {"clip_range": 0.2, "clip_range_vf": 2.0, "ent_coef": 0.05},
    ],
    "Pendulum-v1": [
        {"clip_range": 0.1, "ent_coef": 0.3, "vf_coef": 0.1},
        {"clip_range": 0.2, "clip_range_vf": 0.3},
    ],
}


@pytest.fixture(scope="module")
def ours():
    spec = importlib.util.spec_from_file_location("inside_ppo", FILE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module", params=UPDATES)
def rollout(request):
    model = reference.make_ppo(request.param, seed=1, n_steps=64, batch_size=32, learning_rate=3e-3)
    found = reference.Rollout(model)
    found.train(8)
    found.environment, found.model = request.param, model
    return found


def test_advantages(ours, rollout):
    start = rollout.rewards, rollout.values, rollout.episode_starts, rollout.last_values
    found = ours.advantages(*start, rollout.dones, rollout.gamma, rollout.gae_lambda)
    np.testing.assert_allclose(found, rollout.advantages, 1e-6, 1e-6)


def test_losses(ours, rollout):
    for chosen in UPDATES[rollout.environment]:
        given, logged = rollout.losses(**chosen)
        ratios = given["log_prob"], given["old_log_prob"]
        policy = ours.policy_loss(*ratios, given["advantages"], chosen["clip_range"])
        values = given["values"], given["old_values"], given["returns"]
        critic = ours.value_loss(*values, chosen.get("clip_range_vf"))
        factors = chosen.get("ent_coef", 0.0), chosen.get("vf_coef", 0.5)
        found = {
            "policy_gradient_loss": policy["loss"],
            "clip_fraction": policy["clip_fraction"],
            "value_loss": critic,
            "approx_kl": ours.approx_kl(*ratios),
            "loss": ours.total_loss(policy["loss"], critic, given["entropy"], *factors),
            "explained_variance": ours.explained_variance(rollout.values, rollout.returns),
        }
        for name, value in found.items():
            assert value == pytest.approx(logged[name], rel=1e-6, abs=1e-6), name


def test_entropies(ours):
    import torch
    from stable_baselines3.common import distributions

    rng = np.random.default_rng(1)
    scores, log_deviation = 600 * rng.normal(size=(20, 4)), rng.normal(size=3)
    choices = distributions.CategoricalDistribution(4)
    choices.proba_distribution(torch.from_numpy(scores))
    wanted = choices.entropy().numpy()
    np.testing.assert_allclose(ours.entropy_of_choices(scores), wanted, 1e-6, 1e-6)
    gaussian = distributions.DiagGaussianDistribution(3)
    zeros = torch.zeros(1, 3, dtype=torch.float64)
    gaussian.proba_distribution(zeros, torch.from_numpy(log_deviation))
    assert ours.entropy_of_gaussians(log_deviation) == pytest.approx(gaussian.entropy().item())


@pytest.mark.parametrize("target", [0.02, None])
def test_early_stop(ours, target):
    log_ratios = np.random.default_rng(2).uniform(0.01, 0.1, (3, 4))
    log_ratios[1, 2] = 0.4
    divergences = (np.exp(log_ratios) - 1 - log_ratios).tolist()
    wanted = reference.updates_made(log_ratios.tolist(), target)
    assert ours.updates_made(divergences, target) == wanted


def test_hidden_layers(ours, rollout):
    import torch

    observed = rollout.observations.reshape(-1, rollout.observations.shape[-1])
    layers = reference.policy_layers(rollout.model)
    with torch.no_grad():
        network = rollout.model.policy.mlp_extractor.policy_net
        wanted = network(torch.from_numpy(observed).float()).numpy()
    found = ours.hidden_activations(layers, observed)[-1]
    np.testing.assert_allclose(found, wanted, 1e-4, 1e-5)


def test_the_loop_is_the_engines(ours):
    from botschool.course.ppo import ENVIRONMENT, SETTINGS, Pieces
    from botschool.rl.native import PPO

    settings = SETTINGS | {"n_epochs": 3, "batch_size": 512}
    own, engine = Pieces(ENVIRONMENT, 5, **settings), PPO(ENVIRONMENT, 5, **settings)
    ours.learn(own, 1024, 700)
    while engine.steps < 1024:
        engine.collect()
        engine.update()
    assert own.steps == engine.steps
    np.testing.assert_allclose(own.parameters, engine.parameters, 1e-4, 5e-5)
