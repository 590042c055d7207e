"""The pages are what their data give, and all that are compared play the same networks."""

import importlib
import re
import runpy

import numpy as np
import pytest

from botschool.rl import settings
from botschool.rl.model import build, choose
from botschool.rl.training import _training_env, train
from botschool.wrappers import parse
from running import TESTS

PAGES = (
    "agents", "algorithms_page", "coevolution_page", "evolution_and_ppo_page", "optimisers",
    "results_page", "spatial_page", "tuned",
)  # fmt: skip


@pytest.mark.usefixtures("studies")
@pytest.mark.parametrize("name", PAGES)
def test_pages_are_made_from_their_data(name):
    for page in importlib.import_module(name).pages():
        text = page.path.read_text(encoding="utf-8")
        assert page.filled(text) == text, f"run tools/studies pages {name.removesuffix('_page')}"
        found = re.findall(r"<!-- (?!end|BEGIN|END)(\w+) -->", text)
        assert sorted(page.sections) == sorted(found)


@pytest.mark.usefixtures("studies")
def test_the_command_knows_every_page():
    folder = TESTS.parent / "tools" / "studies"
    command = runpy.run_path(str(folder / "__main__.py"))
    assert tuple(command["studies"]("pages")) == PAGES


@pytest.mark.usefixtures("studies")
def test_a_section_that_is_missing_or_twice_is_named(tmp_path):
    from study import Page

    page = Page(tmp_path / "page.md", {"times": "new"})
    mark = "<!-- times -->\nold\n<!-- end -->\n"
    assert page.filled(f"a\n{mark}b\n") == "a\n<!-- times -->\nnew\n<!-- end -->\nb\n"
    for text, count in (("a\n", 0), (mark + mark, 2)):
        with pytest.raises(SystemExit, match=f"page.md has the section <!-- times --> {count} t"):
            page.filled(text)


@pytest.mark.usefixtures("studies")
def test_a_run_that_is_kept_is_not_done_again(tmp_path):
    from study import Results

    def run():
        done.append(1)
        return {"new": len(done)}

    done: list[int] = []
    for _ in range(2):
        results = Results(tmp_path / "runs.jsonl")
        for seed in (2, 1):
            results.do({"seed": seed, "params": {}}, run)
    assert len(done) == 2
    assert [run["new"] for run in results.of(params={})] == [2, 1]


@pytest.mark.usefixtures("studies")
def test_runs_of_the_comparisons_are_all_there():
    import algorithms
    import evolution_and_ppo as study

    _, done, _ = algorithms.load()
    for problem in algorithms.PROBLEMS:
        for method in algorithms.METHODS:
            runs = algorithms.runs_of(done, problem, method.name)
            assert [run["seed"] for run in runs] == list(algorithms.SEEDS)
    results = study.Results(study.FILE)
    for problem in study.PROBLEMS:
        for method in study.METHODS:
            for unit in ("steps", "seconds"):
                runs = study.best(results, problem, method, unit)
                assert [run["seed"] for run in runs] == list(study.SEEDS)


@pytest.mark.slow
@pytest.mark.usefixtures("studies")
def test_an_interval_of_differences():
    import tuned

    low, high = tuned.interval(np.full(20, 5.0))
    assert low == high == 5.0
    values = np.random.default_rng(3).normal(1.0, 2.0, 400)
    low, high = tuned.interval(values)
    assert abs((high - low) / 2 - 1.96 * values.std() / 20) < 0.02
    assert low < values.mean() < high


@pytest.mark.usefixtures("studies")
@pytest.mark.parametrize("problem", ["Acrobot-v1", "Pendulum-v1"])
def test_the_batched_network_is_the_policy(problem):
    import contestants
    from speed import DATA

    weights = contestants.Weights.of(problem, DATA)
    b1, b2, w1, w2 = weights.layers()
    rng = np.random.default_rng(1)
    for i in (0, 7):
        observation = rng.standard_normal(w1.shape[2]).astype(np.float32)
        weights.policy.load(weights.genotypes[i], None)
        weights.policy.reset(1, 0)
        expected = weights.policy.act(observation)
        output = w2[i] @ np.tanh(w1[i] @ observation + b1[i]) + b2[i]
        assert (output.argmax() if isinstance(expected, int) else output) == pytest.approx(
            expected, 1e-5
        )


@pytest.mark.usefixtures("studies")
def test_missing_packages_are_named_and_left_out(monkeypatch):
    import comparison

    monkeypatch.setattr(comparison.importlib.util, "find_spec", lambda name: None)
    assert "gymnax, envpool" in comparison.notice()
    assert "botschool[bench]" in comparison.notice()
    assert list(comparison._present(comparison.CONTESTANTS)) == ["botschool", "Gymnasium's loop"]


# --- Settings for MuJoCo's robots and Atari's games: who gets which entry, and that it trains.


pytest.importorskip("sb3_contrib")
MUJOCO = (
    "Ant", "HalfCheetah", "Hopper", "Humanoid", "HumanoidStandup", "InvertedDoublePendulum",
    "InvertedPendulum", "Pusher", "Reacher", "Swimmer", "Walker2d",
)  # fmt: skip


@pytest.mark.usefixtures("by_sb3")
def test_every_robot_of_mujoco_has_an_entry():
    usual = settings.defaults("ppo", "default")
    for robot in MUJOCO:
        found = settings.defaults("ppo", f"{robot}-v5")
        assert found != usual and found["n_steps"] == 2048, robot
        assert found == settings.defaults("ppo", f"{robot}-v4")
    assert settings.defaults("sac", "Hopper-v5")["buffer_size"] == 1_000_000
    assert settings.defaults("ars", "Walker2d-v5")["n_top"] == 30
    assert settings.defaults("a2c", "Hopper-v5") == settings.defaults("a2c", "default")


@pytest.mark.usefixtures("by_sb3")
def test_bullets_robots_keep_theirs():
    assert settings.defaults("ppo", "HopperBulletEnv-v0")["n_epochs"] == 20


@pytest.mark.usefixtures("by_sb3")
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


@pytest.mark.slow
@pytest.mark.usefixtures("by_sb3")
def test_a_robot_of_mujoco_trains(tmp_path):
    pytest.importorskip("mujoco")
    small = {"n_steps": 64, "batch_size": 32, "n_epochs": 1}
    run = train("ppo", "Reacher-v5", tmp_path, params=small, steps=128, evaluations=1, episodes=1)
    used = run.settings()
    assert used.normalize and used.envs == 1 and used.parameters["learning_rate"] == 0.0003
    assert len(run.evaluations().steps) == 2


@pytest.mark.slow
@pytest.mark.usefixtures("by_sb3")
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


@pytest.mark.usefixtures("by_sb3")
def test_rewards_are_cut_in_training_alone(monkeypatch):
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
