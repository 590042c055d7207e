"""`botschool rl`: tiny trainings, their files, and agents that are what was measured."""

import os
import signal
import sys

import numpy as np
import pytest
import yaml

from botschool.errors import BotschoolError
from botschool.rl import settings
from botschool.rl.agent import Agent, play
from botschool.rl.folder import RunFolder
from botschool.rl.training import train
from botschool.seeds import POST_EVALUATION_SEED
from running import finish, one_sentence, start

pytest.importorskip("stable_baselines3")
pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("by_sb3")]
SMALL = {"n_steps": 32, "batch_size": 32, "n_epochs": 2}
FILES = {"best_model.zip", "last_model.zip", "config.yaml", "evaluations.npz", "progress.csv"}
SHOWN_BY_TENSORBOARD = {
    "rollout/ep_rew_mean",
    "rollout/ep_len_mean",
    "rollout/discounted_return",
    "rollout/advantage_mean",
    "actions/frequency_0",
    "train/policy_gradient_loss",
    "train/value_loss",
    "train/entropy_loss",
    "train/approx_kl",
    "train/clip_fraction",
    "train/explained_variance",
    "eval/mean_reward",
}


def tiny(folder, algo="ppo", env="CartPole-v1", **options):
    """A training of some hundred steps."""
    small = {"params": SMALL, "steps": 256, "envs": 2, "evaluations": 4, "episodes": 3}
    return train(algo, env, folder, **(small | options))


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    """One training for the tests that only look at it."""
    return tiny(tmp_path_factory.mktemp("rl"))


def again(run, model):
    """Mean returns of a saved model on the seeds of the post-evaluation."""
    used = run.settings()
    seeds = [used.seed + POST_EVALUATION_SEED + t for t in range(used.episodes)]
    returns, _ = play(Agent.load(model), [run.make_env() for _ in seeds], seeds)
    return returns


def test_a_training_leaves_its_files(trained):
    assert trained.path.parts[-2:] == ("ppo", "CartPole-v1_1")
    names = {path.name for path in trained.path.iterdir()}
    assert names > FILES
    assert [name.startswith("events.out.tfevents") for name in names - FILES] == [True]
    found = trained.evaluations()
    assert found.steps.tolist() == [0, 64, 128, 192, 256]
    assert found.returns.shape == found.lengths.shape == (5, 3)
    np.testing.assert_array_equal(found.returns, found.lengths)  # CartPole pays 1 a step


def test_the_config_says_all(trained):
    used = trained.settings()
    assert (used.algo, used.env, used.policy, used.seed) == ("ppo", "CartPole-v1", "mlp", 1)
    assert (used.steps, used.envs, used.normalize) == (256, 2, False)
    assert used.given == SMALL and used.parameters.items() > SMALL.items()
    assert used.parameters["gae_lambda"] == 0.8  # of defaults.yaml
    assert used.parameters["vf_coef"] == 0.5  # of the library


def test_the_saved_models_are_those_that_were_measured(trained):
    found = trained.evaluations()
    assert again(trained, trained.best).mean() == found.best
    np.testing.assert_array_equal(again(trained, trained.last), found.returns[-1])


@pytest.mark.parametrize("policy", ["mlp", "lstm"])
def test_so_they_are_with_normalisation_and_memory(tmp_path, policy):
    params = SMALL | {"normalize": True}
    run = tiny(tmp_path, env="tiny_envs:Tiny-v0", policy=policy, params=params)
    found = run.evaluations()
    assert run.settings().normalize
    assert again(run, run.best).mean() == pytest.approx(found.best, rel=1e-5)
    np.testing.assert_allclose(again(run, run.last), found.returns[-1], rtol=1e-5)


@pytest.mark.parametrize(
    ("algo", "env", "params"),
    [
        ("a2c", "tiny_envs:Tinydiscrete-v0", {"n_steps": 8}),
        ("dqn", "CartPole-v1", {"learning_starts": 10, "buffer_size": 100}),
        ("sac", "tiny_envs:Tiny-v0", {"learning_starts": 10, "net_arch": [8]}),
        ("td3", "tiny_envs:Tiny-v0", {"learning_starts": 10, "net_arch": [8], "action_noise": 0.2}),
    ],
)
def test_every_algorithm_trains(tmp_path, algo, env, params):
    run = tiny(tmp_path, algo, env, params=params, steps=240)
    np.testing.assert_allclose(again(run, run.last), run.evaluations().returns[-1], rtol=1e-5)
    log = run.log()
    assert np.isfinite(log["rollout/discounted_return"]).any()


def test_the_seed_decides(trained, tmp_path):
    same, other = tiny(tmp_path), tiny(tmp_path, seed=2)
    np.testing.assert_array_equal(same.evaluations().returns, trained.evaluations().returns)
    assert not np.array_equal(other.evaluations().returns, trained.evaluations().returns)


# logs


def test_tensorboard_shows_the_indicators(trained):
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    events = EventAccumulator(str(trained.path)).Reload()
    assert set(events.Tags()["scalars"]) >= SHOWN_BY_TENSORBOARD
    assert {"rollout/advantage", "actions/chosen"} <= set(events.Tags()["histograms"])
    for tag in SHOWN_BY_TENSORBOARD:
        assert all(np.isfinite(event.value) for event in events.Scalars(tag)), tag
    shares = [events.Scalars(f"actions/frequency_{action}")[-1].value for action in (0, 1)]
    assert sum(shares) == pytest.approx(1.0)
    final = events.Scalars("eval/mean_reward")[-1]
    assert final.step == 256
    assert final.value == pytest.approx(trained.evaluations().last)


# defaults.yaml


# the command

FLAGS = ("--steps", 256, "--envs", 2, "--episodes", 3, "--evaluations", 4)


def test_the_command_trains_and_enjoys(tmp_path, command):
    small = [f"{name}={value}" for name, value in SMALL.items()]
    code, out, errors = command(
        *("rl", "train", "--algo", "PPO", "--env", "CartPole-v1", "-o", tmp_path, *FLAGS),
        *("--params", *small, "learning_rate=1e-3", "net_arch=[8, 8]"),
    )
    assert (code, errors) == (0, "")
    lines = out.splitlines()
    assert lines[0] == f"training ppo on CartPole-v1 in {tmp_path}/ppo/CartPole-v1_1"
    assert len(lines) == 7 and "steps 128 (50%)  post-evaluated " in lines[3]
    run = RunFolder(tmp_path / "ppo" / "CartPole-v1_1")
    assert f"best post-evaluated {run.evaluations().best:.2f}" in lines[-1]
    assert run.settings().parameters["net_arch"] == [8, 8]
    assert run.settings().parameters["learning_rate"] == 0.001

    for target in ([run.path], [run.best], ["-o", tmp_path]):
        code, out, errors = command("rl", "enjoy", *target, "--episodes", 4, "--render", "none")
        assert (code, errors) == (0, "")
    returns = [float(line.split()[3]) for line in out.splitlines() if line.startswith("episode")]
    mean, sd = np.mean(returns), np.std(returns)
    assert f"mean {mean:.2f}  standard deviation {sd:.2f}" in out and len(returns) == 4


# interruptions


def long_training(folder):
    """A training that does not end by itself, as a process, after its second post-evaluation."""
    process = start(
        *("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", folder, "--envs", 2),
        *("--engine", "sb3"),
        *("--steps", 10**8, "--evaluations", 10**5, "--episodes", 2),
        *("--params", "n_steps=32", "batch_size=32", "n_epochs=1"),
    )
    for _ in range(4):
        assert process.stdout.readline()
    return process


def playable(run):
    """Asserts that both models of a training can be watched, and nothing else lies about."""
    for model in (run.best, run.last):
        assert np.isfinite(again(run, model)).all()
    assert len(run.evaluations().steps) >= 2
    assert run.log()["steps"].size


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGKILL")
def test_a_killed_training_leaves_its_models(tmp_path):
    process = long_training(tmp_path)
    process.kill()
    finish(process)
    playable(RunFolder(tmp_path / "ppo" / "CartPole-v1_1"))


@pytest.mark.skipif(sys.platform == "win32", reason="no SIGINT to another process")
def test_ctrl_c_saves_and_ends(tmp_path):
    process = long_training(tmp_path)
    os.kill(process.pid, signal.SIGINT)
    code, out, errors = finish(process)
    assert (code, errors) == (130, "")
    assert out.splitlines()[-1].startswith("stopped after ")
    run = RunFolder(tmp_path / "ppo" / "CartPole-v1_1")
    playable(run)
    assert again(run, run.last).mean() == run.evaluations().last


def test_an_environment_that_breaks_leaves_the_models(tmp_path):
    with pytest.raises(BotschoolError, match=r"does not work \(its reward was nan\).*environment"):
        tiny(tmp_path, env="tiny_envs:Tinynan-v0", seed=3)
    run = RunFolder(tmp_path / "ppo" / "tiny_envs-Tinynan-v0_1")
    assert run.best.exists() and run.last.exists() and len(run.evaluations().steps) == 1


def test_a_full_disk(tmp_path):
    """A limit on the size of files, below that of a model."""
    if sys.platform == "win32":
        pytest.skip("Windows has no such limit")
    import resource

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))

    process = start(
        *("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path, *FLAGS),
        *("--params", "n_steps=32", "batch_size=32", "--engine", "sb3"),
        preexec_fn=limited,
    )
    code, _, errors = finish(process)
    folder = tmp_path / "ppo" / "CartPole-v1_1"
    one_sentence(code, errors, [folder, "cannot be written", "free some space"])
    assert not list(folder.glob(".*")) and not list(folder.glob("*.zip"))


def test_settings_survive_the_file(trained, tmp_path):
    used = trained.settings()
    used.save(tmp_path / "config.yaml")
    assert settings.Settings.load(tmp_path / "config.yaml") == used
    assert yaml.safe_load((tmp_path / "config.yaml").read_text())["algo"] == "ppo"


@pytest.mark.parametrize(
    "text",
    ["a: &a [1]\nb: [*a, *a]", "a: &a {b: 1}\nc: {<<: [*a, *a]}", "[" * 100_000, "[",
     "a: " + "9" * 5000, "!!timestamp x", "!!int x", "? [a]\n: 1", "[]", "a: 1", "\0"],
    ids=["aliases", "merged aliases", "deep", "unclosed", "a long number", "no date", "no number",
         "a list as key", "a list", "other keys", "a zero byte"],
)  # fmt: skip
def test_damaged_settings_are_refused_in_a_sentence(tmp_path, text):
    (tmp_path / "config.yaml").write_text(text)
    with pytest.raises(BotschoolError, match=r"config\.yaml (cannot be read|does not describe)"):
        settings.Settings.load(tmp_path / "config.yaml")


def test_images_are_seen_by_a_convolutional_network(tmp_path):
    run = tiny(tmp_path, env="tiny_envs:Picture-v0", steps=64)
    assert run.settings().policy == "cnn" and not run.settings().normalize
    np.testing.assert_allclose(again(run, run.last), run.evaluations().returns[-1], rtol=1e-5)


def test_robots_of_mujoco_have_entries_of_their_own(tmp_path):
    usual = settings.defaults("ppo", "default")
    for robot in ("Ant", "HalfCheetah", "Hopper", "Humanoid", "Pusher", "Swimmer", "Walker2d"):
        found = settings.defaults("ppo", f"{robot}-v5")
        assert found != usual and found["n_steps"] == 2048, robot
        assert found == settings.defaults("ppo", f"{robot}-v4")
    assert settings.defaults("sac", "Hopper-v5")["buffer_size"] == 1_000_000
    pytest.importorskip("mujoco")
    small = {"n_steps": 64, "batch_size": 32, "n_epochs": 1}
    run = train("ppo", "Reacher-v5", tmp_path, params=small, steps=128, evaluations=1, episodes=1)
    used = run.settings()
    assert used.normalize and used.envs == 1 and used.parameters["learning_rate"] == 0.0003
