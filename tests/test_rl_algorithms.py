"""Every algorithm of `botschool rl` trains; environments in processes; wrappers."""

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.rl.agent import Agent, play
from botschool.rl.model import choose
from botschool.rl.training import learn, train
from botschool.seeds import POST_EVALUATION_SEED
from running import TESTS

pytest.importorskip("sb3_contrib")
pytestmark = pytest.mark.usefixtures("by_sb3")
callbacks = pytest.importorskip("botschool.rl.callbacks")


@pytest.fixture(autouse=True)
def own_environments(monkeypatch):
    monkeypatch.syspath_prepend(TESTS)


def tiny(folder, algo, env, **options):
    small = {"steps": 120, "envs": 2, "evaluations": 2, "episodes": 2}
    return train(algo, env, folder, **(small | options))


def again(run):
    """Returns of the last model on the seeds of the post-evaluation."""
    used = run.settings()
    seeds = [used.seed + POST_EVALUATION_SEED + t for t in range(used.episodes)]
    returns, _ = play(Agent.load(run.last), [run.make_env() for _ in seeds], seeds)
    return returns


STARTS = {"learning_starts": 10, "net_arch": [8], "batch_size": 16, "buffer_size": 200}
GOALS = STARTS | {"learning_starts": 40}
TRAINED = [
    ("ddpg", "tiny_envs:Tiny-v0", STARTS | {"action_noise": 0.2}),
    ("tqc", "tiny_envs:Tiny-v0", STARTS | {"n_quantiles": 5}),
    ("qrdqn", "tiny_envs:Tinydiscrete-v0", STARTS | {"n_quantiles": 5}),
    ("trpo", "tiny_envs:Tiny-v0", {"n_steps": 32, "batch_size": 16, "normalize": True}),
    ("trpo", "tiny_envs:Tinydiscrete-v0", {"n_steps": 32, "batch_size": 16}),
    ("ars", "tiny_envs:Tiny-v0", {"n_delta": 2, "normalize": True}),
    ("ars", "tiny_envs:Tinydiscrete-v0", {"n_delta": 2, "learning_rate": "linear 0.1"}),
    ("her", "tiny_envs:Goal-v0", GOALS | {"n_sampled_goal": 2}),
    ("her", "tiny_envs:Goaldiscrete-v0", GOALS | {"goal_selection_strategy": "final"}),
]


@pytest.mark.parametrize(("algo", "env", "params"), TRAINED)
def test_the_newer_algorithms_train(algo, env, params, tmp_path):
    run = tiny(tmp_path, algo, env, params=params)
    found = run.evaluations()
    assert found.steps[0] == 0 and found.steps[-1] >= 120
    np.testing.assert_allclose(again(run), found.returns[-1], rtol=1e-4)
    assert any("loss" in name or name.startswith("train/") for name in run.log())


def test_images_with_memory(tmp_path):
    params = {"n_steps": 8, "batch_size": 8, "n_epochs": 1, "lstm_hidden_size": 4}
    options = {
        "steps": 8,
        "envs": 1,
        "evaluations": 1,
        "episodes": 1,
        "policy": "cnnlstm",
        "params": params,
    }
    run = tiny(tmp_path, "ppo", "tiny_envs:Picture-v0", **options)
    assert run.settings().policy == "cnnlstm"
    np.testing.assert_allclose(again(run), run.evaluations().returns[-1], rtol=1e-4)
    with pytest.raises(BotschoolError, match=r"shows no images.*a cnnlstm policy"):
        tiny(tmp_path, "ppo", "CartPole-v1", policy="cnnlstm")
    with pytest.raises(BotschoolError, match="sac has no cnnlstm policy: use --algo ppo with"):
        tiny(tmp_path, "sac", "tiny_envs:Tiny-v0", policy="cnnlstm")


def test_learning_moves_the_policy_of_ars(tmp_path):
    run = tiny(tmp_path, "ars", "tiny_envs:Tiny-v0", params={"n_delta": 4, "learning_rate": 0.5})
    assert len(set(run.evaluations().returns.mean(axis=1))) > 1
    assert run.settings().parameters["net_arch"] == []


def test_hindsight_needs_goals(tmp_path):
    with pytest.raises(BotschoolError, match=r"her cannot be trained on CartPole-v1.*no goals"):
        tiny(tmp_path, "her", "CartPole-v1")
    with pytest.raises(BotschoolError, match="must be future or final or episode"):
        tiny(tmp_path, "her", "tiny_envs:Goal-v0", params={"goal_selection_strategy": "past"})
    with pytest.raises(BotschoolError, match="SAC has no hyperparameter n_sampled_goal"):
        tiny(tmp_path, "sac", "tiny_envs:Goal-v0", params={"n_sampled_goal": 2})


def test_ars_reads_vectors(tmp_path):
    with pytest.raises(BotschoolError, match=r"ars reads vectors only.*FlattenObservation"):
        tiny(tmp_path, "ars", "tiny_envs:Goal-v0")
    tiny(tmp_path, "ars", "tiny_envs:Goal-v0", wrappers="FlattenObservation", steps=10)


def test_ars_stops_when_it_is_asked(tmp_path):
    settings = choose("ars", "tiny_envs:Tiny-v0", steps=100_000, evaluations=1, episodes=1)
    asked = iter(range(100))
    run, found = learn(settings, tmp_path, lambda *_: None, stopping=lambda: next(asked) > 20)
    assert 10 < found.steps[-1] < 100 and run.last.exists()


# processes


def test_environments_in_processes_give_the_same(tmp_path):
    params = {"n_steps": 32, "batch_size": 32, "n_epochs": 1, "normalize": True}
    one, other = (
        tiny(tmp_path, "ppo", "tiny_envs:Tiny-v0", params=params, vec_env=kind)
        for kind in ("dummy", "subproc")
    )
    np.testing.assert_array_equal(one.evaluations().returns, other.evaluations().returns)
    assert other.settings().vec_env == "subproc"


@pytest.mark.parametrize(
    ("fault", "says"), [("nan", "its reward was nan"), ("dies", "ended unexpectedly.*vec-env dumm")]
)
def test_an_environment_that_breaks_in_a_process(fault, says, tmp_path, monkeypatch):
    monkeypatch.setattr(
        callbacks.PostEvaluation, "_evaluate", lambda self: None
    )  # it would die, too
    monkeypatch.setattr(callbacks.PostEvaluation, "_on_step", lambda self: True)
    with pytest.raises(BotschoolError, match=says):
        tiny(
            *(tmp_path, "ppo", f"tiny_envs:Tiny{fault}-v0"),
            params={"n_steps": 32, "batch_size": 32},
            vec_env="subproc",
            envs=1,
            seed=4,
        )


def test_other_words_for_processes(tmp_path, refused):
    refused(
        *("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path),
        *("--vec-env", "subprocess"),
        says="--vec-env is 'subprocess', but must be dummy or subproc",
    )


# wrappers


def test_agents_are_trained_and_watched_in_wrappers(tmp_path, command):
    code, out, errors = command(
        *("rl", "train", "--algo", "ppo", "--env", "tiny_envs:Tiny-v0", "-o", tmp_path),
        *("--wrapper", "TimeAwareObservation", "--wrapper", "tiny_envs:Doubled(times=100)"),
        *("--steps", 64, "--envs", 1, "--episodes", 2, "--evaluations", 1),
        *("--params", "n_steps=32", "batch_size=32", "n_epochs=1"),
    )
    assert (code, errors) == (0, "")
    run = out.splitlines()[0].rpartition(" in ")[2]
    code, out, _ = command("rl", "enjoy", run, "--episodes", 2, "--render", "none")
    assert code == 0 and float(out.split()[3]) > 100
    code, out, _ = command("rl", "list", tmp_path)
    assert "Doubled" in out.replace("\n", "").replace(" ", "")
    assert command("rl", "video", run, "-f", tmp_path / "a.gif", "--episodes", 1)[0] == 0


def test_wrappers_that_do_not_exist(tmp_path, refused):
    own = ("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path, "--wrapper")
    refused(*own, "FlatenObservation", says="did you mean FlattenObservation?")
    refused(*own, "NormalizeObservation", says="--params normalize=true")
    refused(*own, "not_there:X", says="no module not_there")
