"""The walkthroughs: scripts that students read and run."""

import importlib
import re
import sys
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
import pytest

torch = pytest.importorskip("torch")

pytestmark = pytest.mark.slow

WALKTHROUGHS = Path(__file__).parents[2] / "lib" / "walkthroughs"
NAMES = ("regression", "crossentropy", "ppo")
TINY_PPO = {"total_timesteps": 256, "n_envs": 2, "n_steps": 32, "batch_size": 16, "n_epochs": 2}


@pytest.fixture(autouse=True)
def importable(monkeypatch):
    monkeypatch.syspath_prepend(str(WALKTHROUGHS))
    torch.set_num_threads(1)


@dataclass
class Done:
    """How a script ended, and what it printed."""

    returncode: int
    stdout: str
    stderr: str


@pytest.fixture
def ran(monkeypatch, tmp_path, capsys):
    """Runs a walkthrough as a script does, in this process and in tmp_path."""
    monkeypatch.chdir(tmp_path)

    def run(name, *arguments) -> Done:
        import shared

        monkeypatch.setattr(sys, "argv", [f"{name}.py", *map(str, arguments)])
        code = 0
        try:
            shared.run(importlib.import_module(name).main)
        except SystemExit as end:
            code = end.code or 0
        return Done(code, *capsys.readouterr())

    return run


def picture_of(done, folder):
    """The picture that a run names on the screen."""
    assert done.returncode == 0, done.stderr
    named = [line for line in done.stdout.splitlines() if line.startswith("picture: ")]
    assert len(named) == 1
    place = folder / named[0].removeprefix("picture: ")
    assert place.read_bytes().startswith(b"\x89PNG")
    return place


# ------------------------------------------------------------------- as scripts
@pytest.mark.parametrize("name", NAMES)
def test_help_explains_every_hyperparameter(name, ran, tmp_path):
    done = ran(name, "--help")
    assert done.returncode == 0
    assert "--seed" in done.stdout and "default: 1" in done.stdout
    assert not list(tmp_path.iterdir())


def test_tiny_runs_end_in_pictures(ran, tmp_path):
    picture_of(ran("regression", "--epochs", 20), tmp_path)
    picture_of(ran("regression", "--epochs", 3, "--training_set", "wave"), tmp_path)
    picture_of(ran("crossentropy", "--iterations", 2), tmp_path)


# ------------------------------------------------------------------- regression
def test_xor_is_learnt_and_repeats():
    import regression as walk

    inputs, targets = walk.training_set("xor", 1)
    h = walk.Hyperparameters()
    network, losses = walk.train(h, inputs, targets)
    assert losses[-1] < h.enough
    assert torch.all((network(inputs) - targets).abs() < 0.05)
    assert walk.train(h, inputs, targets)[1] == losses
    assert walk.train(walk.Hyperparameters(epochs=3, seed=2), inputs, targets)[1] != losses[:4]


# ------------------------------------------------------------------- cross-entropy
# ------------------------------------------------------------------- PPO
def rollout(ppo, rewards, values, ended, last_value):
    """A rollout of one environment."""
    column = [torch.tensor(each, dtype=torch.float32)[:, None] for each in (values, rewards, ended)]
    unused = torch.zeros(len(rewards), 1)
    return ppo.Rollout(unused, unused, unused, *column, torch.tensor([float(last_value)]))


def test_advantages_by_hand():
    """gamma 0.5, lambda 0.5; the episode ends with the second of four steps."""
    import ppo

    data = rollout(ppo, [1, 2, 3, 4], [0.5, 1, 2, 1], [0, 1, 0, 0], 6)
    # deltas: 1 + 0.5*1 - 0.5 = 1;  2 - 1 = 1;  3 + 0.5*1 - 2 = 1.5;  4 + 0.5*6 - 1 = 6
    expected = [1 + 0.25 * 1, 1, 1.5 + 0.25 * 6, 6]
    advantages = ppo.advantages_of(data, gamma=0.5, gae_lambda=0.5)
    assert advantages[:, 0].tolist() == expected


@pytest.mark.parametrize("env", ["CartPole-v1", "Pendulum-v1"])
def test_ppo_repeats_from_its_seed(env):
    import ppo

    one, same, other = (
        ppo.train(ppo.Hyperparameters(env=env, seed=seed, **TINY_PPO)) for seed in (1, 1, 2)
    )
    assert one.indicators == same.indicators and one.episodes == same.episodes
    assert one.indicators != other.indicators


@pytest.mark.parametrize("env", ["CartPole-v1", "Pendulum-v1"])
def test_with_the_same_random_numbers_a_training_is_that_of_stable_baselines3(env):
    """Collecting, time limits, annealing and learning, until rounding errors grow."""
    pytest.importorskip("stable_baselines3")
    import ppo
    from stable_baselines3 import PPO
    from stable_baselines3.common.env_util import make_vec_env
    from stable_baselines3.common.utils import LinearSchedule

    settings = {"n_steps": 64, "batch_size": 64, "n_epochs": 3, "gamma": 0.9, "gae_lambda": 0.8}
    total = 1792  # 7 updates of 4 environments; episodes of Pendulum end after 200 steps of each
    falling = {"learning_rate": LinearSchedule(1e-3, 0, 1), "clip_range": LinearSchedule(0.2, 0, 1)}
    model = PPO(
        "MlpPolicy", make_vec_env(env, 4, seed=1), seed=1, device="cpu", **settings, **falling
    )
    h = ppo.Hyperparameters(env=env, n_envs=4, total_timesteps=total, **settings)
    experience = ppo.Experience(h)
    agent = ppo.Agent(
        experience.envs.single_observation_space, experience.envs.single_action_space, 64
    )
    pairs = list(zip([*agent.actor[::2], *agent.critic[::2]], layers_of(model.policy), strict=True))
    for ours, theirs in pairs:
        assert ours.weight.norm().item() == pytest.approx(theirs.weight.norm().item())
        ours.load_state_dict(theirs.state_dict())

    class Shuffled:
        """numpy's global generator, for data whose first axis is time and not environments."""

        def permutation(self, n):
            envs, times = np.divmod(np.random.permutation(n), h.n_steps)  # noqa: NPY002
            return times * h.n_envs + envs

    def seed():
        torch.manual_seed(7)
        np.random.seed(7)  # noqa: NPY002

    seed()
    model.learn(total)
    seed()
    learner = ppo.Learner(agent, h)
    learner.rng = Shuffled()
    while experience.steps < total:
        data = experience.collect(agent)
        learner.update(data, experience.steps / total)
    buffer = model.rollout_buffer
    for name in ("observations", "values", "log_probs"):
        theirs = torch.as_tensor(getattr(buffer, name))
        theirs = theirs.reshape(4, 64, -1).transpose(0, 1).reshape(getattr(data, name).shape)
        assert torch.allclose(getattr(data, name), theirs, atol=0.01), name
    for ours, theirs in pairs:
        assert torch.allclose(ours.weight, theirs.weight, atol=1e-3)


def layers_of(policy):
    """The linear layers of Stable-Baselines3's policy and of its critic."""
    networks = policy.mlp_extractor
    return [
        *networks.policy_net[::2], policy.action_net, *networks.value_net[::2], policy.value_net
    ]  # fmt: skip


# ------------------------------------------------------------------- PPO and its twin in C++
TWIN = Path(__file__).parents[2] / "lib" / "policy_gradient"
BOTH_HAVE = {
    1: ["Hyperparameters"],
    2: ["Agent"],
    3: ["Rollout", "Experience", "collect"],
    4: ["advantages_of"],
    5: ["Learner", "update", "loss"],
    6: ["Training"],
}
"""Section -> names that both sides define in it, in this order."""


def sections_of_the_walkthrough():
    """Number -> text of each section."""
    text = (WALKTHROUGHS / "ppo.py").read_text(encoding="utf-8")
    _, *parts = re.split(r"^# (\d)\. .*$", text, flags=re.MULTILINE)
    return {int(n): part for n, part in zip(parts[::2], parts[1::2], strict=True)}


def sections_of_the_twin():
    """Number -> text of the headers that name the section in their first lines."""
    found: dict[int, str] = {}
    for path in sorted(TWIN.glob("*.hpp"), key=lambda path: (path.stem != "rollout", path.stem)):
        text = path.read_text(encoding="utf-8")
        head = " ".join(text.split("#pragma once")[0].replace("//", " ").split())
        named = re.search(r"sections? (\d)(?: and (\d))? of walkthroughs/ppo\.py", head)
        for number in filter(None, named.groups() if named else ()):
            found[int(number)] = found.get(int(number), "") + text
    return found


def test_the_twin_has_the_same_sections_and_names():
    ours, twins = sections_of_the_walkthrough(), sections_of_the_twin()
    assert sorted(ours) == sorted(twins) == sorted(BOTH_HAVE)
    for number, names in BOTH_HAVE.items():
        patterns = r"^ *(?:class|def) (\w+)", r"(?:class|struct|\w[&>]*) (\w+)(?: \{|\()"
        for pattern, text in zip(patterns, (ours[number], twins[number]), strict=True):
            defined = re.findall(pattern, text, flags=re.MULTILINE)
            wanted = [{"Training": "train"}.get(n, n) if "def" in pattern else n for n in names]
            assert [name for name in defined if name in wanted] == wanted, (number, pattern)


@pytest.mark.parametrize("env", ["CartPole-v1", "Pendulum-v1"])
def test_the_twin_computes_the_same(env):
    """The same weights and minibatches: advantages, losses, gradients, steps of Adam."""
    import ppo

    from botschool.rl.native import PPO

    shared = {"n_steps": 250, "batch_size": 125, "gamma": 0.95, "gae_lambda": 0.8}
    shared |= {"learning_rate": 0.003, "clip_range": 0.01, "ent_coef": 0.01}
    native = PPO(env, seed=3, n_envs=4, net_arch=[16, 16], **shared)
    h = ppo.Hyperparameters(env=env, n_envs=4, nhiddens=16, anneal=0, **shared)
    envs = ppo.Experience(h).envs
    agent = ppo.Agent(envs.single_observation_space, envs.single_action_space, h.nhiddens)
    ours = native.weights
    parts = {name: each for name, each in ours.items() if name == "log_std"}
    for net, layer, kind in product(("actor", "critic"), range(3), ("weight", "bias")):
        parts[f"{net}.{2 * layer}.{kind}"] = ours[f"{net}.{layer}.{kind}"]
    agent.load_state_dict({name: torch.tensor(each) for name, each in parts.items()})
    found = native.collect()
    columns = {name: torch.tensor(each) for name, each in vars(found).items()}
    advantages, returns = columns.pop("advantages"), columns.pop("returns")
    assert {0, 2} <= set(columns["ended"].unique().tolist()) or env == "CartPole-v1"
    columns["ended"] = (columns["ended"] > 0).float()
    if env == "CartPole-v1":
        columns["actions"] = columns["actions"][..., 0]
    data = ppo.Rollout(**columns)
    torch.testing.assert_close(
        ppo.advantages_of(data, h.gamma, h.gae_lambda), advantages, atol=1e-5, rtol=1e-5
    )
    policy = agent.policy(data.observations)
    torch.testing.assert_close(policy.log_prob(data.actions), data.log_probs, atol=2e-6, rtol=2e-6)
    torch.testing.assert_close(agent.value(data.observations), data.values, atol=2e-6, rtol=2e-6)
    learner = ppo.Learner(agent, h)
    samples = (data.observations, data.actions, data.log_probs, advantages, returns)
    order = np.random.default_rng(1).permutation(1000).reshape(8, 125)
    for step, rows in enumerate(order):
        batch = [column.flatten(0, 1)[torch.tensor(rows)] for column in samples]
        loss, indicators = learner.loss(*batch, h.clip_range)
        learner.optimiser.zero_grad()
        loss.backward()
        mine = native.loss(native.minibatch(rows))
        assert mine.loss == pytest.approx(loss.item(), abs=1e-4, rel=1e-5)
        same = {"policy_loss": "policy_gradient_loss", "entropy": "entropy_loss"}
        for name in ("policy_loss", "value_loss", "entropy", "approx_kl", "clip_fraction"):
            sign = -1 if name == "entropy" else 1
            theirs = sign * indicators[same.get(name, name)]
            assert getattr(mine, name) == pytest.approx(theirs, abs=1e-4, rel=1e-5), (step, name)
        for name, weight in agent.named_parameters():
            net, layer, kind = (*name.split("."), "", "")[:3]
            own = f"{net}.{int(layer) // 2}.{kind}" if layer else name
            gradient = torch.tensor(mine.gradients[own])
            torch.testing.assert_close(weight.grad, gradient, atol=1e-4, rtol=1e-3, msg=own)
        torch.nn.utils.clip_grad_norm_(agent.parameters(), h.max_grad_norm)
        learner.optimiser.step()
        native.step(mine.gradient)
    assert indicators["clip_fraction"] > 0  # the policy has left the one that collected
    for name, each in parts.items():
        torch.testing.assert_close(agent.state_dict()[name], torch.tensor(each), atol=1e-4, rtol=0)
