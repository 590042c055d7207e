"""Settings for MuJoCo's robots and Atari's games: who gets which entry, and that it trains."""

import pytest

from botschool.rl import settings
from botschool.rl.model import build, choose
from botschool.rl.training import _training_env, train
from botschool.wrappers import parse
from running import TESTS

pytest.importorskip("sb3_contrib")
pytestmark = pytest.mark.usefixtures("by_sb3")
MUJOCO = (
    "Ant", "HalfCheetah", "Hopper", "Humanoid", "HumanoidStandup", "InvertedDoublePendulum",
    "InvertedPendulum", "Pusher", "Reacher", "Swimmer", "Walker2d",
)  # fmt: skip


def test_every_robot_of_mujoco_has_an_entry():
    usual = settings.defaults("ppo", "default")
    for robot in MUJOCO:
        found = settings.defaults("ppo", f"{robot}-v5")
        assert found != usual and found["n_steps"] == 2048, robot
        assert found == settings.defaults("ppo", f"{robot}-v4")
    assert settings.defaults("sac", "Hopper-v5")["buffer_size"] == 1_000_000
    assert settings.defaults("ars", "Walker2d-v5")["n_top"] == 30
    assert settings.defaults("a2c", "Hopper-v5") == settings.defaults("a2c", "default")


def test_bullets_robots_keep_theirs():
    assert settings.defaults("ppo", "HopperBulletEnv-v0")["n_epochs"] == 20


@pytest.mark.parametrize("algo", ["ppo", "a2c", "dqn", "qrdqn"])
def test_names_of_atari(algo):
    skipping = settings.defaults(algo, "ALE/Breakout-v5")
    assert "frame_skip=1" in skipping["wrappers"]
    assert settings.defaults(algo, "BreakoutDeterministic-v4") == skipping
    plain = settings.defaults(algo, "BreakoutNoFrameskip-v4")
    assert "frame_skip" not in plain["wrappers"] and plain["steps"] == 10_000_000
    for entry in (skipping, plain):
        names = [wrapper.name for wrapper in parse(entry["wrappers"])]
        assert names == ["AtariPreprocessing", "FrameStackObservation"]
        assert [each.name for each in parse(entry["training_wrappers"])] == ["ClipReward"]


def test_a_robot_of_mujoco_trains(tmp_path):
    pytest.importorskip("mujoco")
    small = {"n_steps": 64, "batch_size": 32, "n_epochs": 1}
    run = train("ppo", "Reacher-v5", tmp_path, params=small, steps=128, evaluations=1, episodes=1)
    used = run.settings()
    assert used.normalize and used.envs == 1 and used.parameters["learning_rate"] == 0.0003
    assert len(run.evaluations().steps) == 2


@pytest.mark.parametrize("env", ["ALE/Pong-v5", "PongNoFrameskip-v4"])
@pytest.mark.parametrize("algo", ["ppo", "dqn"])
def test_a_game_of_atari_trains(algo, env, tmp_path):
    """Without the post-evaluations, which play whole games."""
    pytest.importorskip("ale_py")
    pytest.importorskip("cv2")
    small = {"ppo": {"n_steps": 8, "batch_size": 8, "n_epochs": 1}}
    small["dqn"] = {"learning_starts": 8, "buffer_size": 16, "batch_size": 4}
    used = choose(algo, env, params=small[algo], envs=1, steps=16)
    assert used.policy == "cnn" and "ClipReward" in used.training_wrappers
    with _training_env(used) as games:
        assert games.observation_space.shape == (4, 84, 84)
        model = build(used, games)
        before = model.policy.state_dict()
        before = {name: value.clone() for name, value in before.items()}
        model.learn(used.steps)
        after = model.policy.state_dict()
    assert any((before[name] != after[name]).any() for name in before)


def test_rewards_are_cut_in_training_alone(monkeypatch):
    monkeypatch.syspath_prepend(TESTS)
    entry = {"steps": 10, "envs": 1, "wrappers": "tiny_envs:Doubled(times=9)"}
    entry["training_wrappers"] = "ClipReward(min_reward=-1, max_reward=1)"
    monkeypatch.setattr(settings, "_defaults", lambda: {"ppo": {"default": entry}})
    used = choose("ppo", "tiny_envs:Tiny-v0")
    assert used.wrappers.startswith("tiny_envs:Doubled") and used.training_wrappers
    with _training_env(used) as envs:
        envs.reset()
        _, rewards, _, _ = envs.step(envs.action_space.sample()[None])
        assert rewards[0] == 1.0  # of 9 (1 - |x|)
    own = choose("ppo", "tiny_envs:Tiny-v0", wrappers="TimeAwareObservation")
    assert (own.wrappers, own.training_wrappers) == ("TimeAwareObservation", "")
    bare = choose("ppo", "tiny_envs:Tiny-v0", wrappers="none")
    assert (bare.wrappers, bare.training_wrappers) == ("", "")
    assert used.variant == "" and own.variant == "TimeAwareObservation"
