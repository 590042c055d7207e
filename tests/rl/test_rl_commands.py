"""Every algorithm of `botschool rl` trains; environments in processes; wrappers."""

import numpy as np
import pytest
from matplotlib.image import imread

from botschool.analysis import plots
from botschool.analysis.runs import BEST_POST
from botschool.errors import BotschoolError
from botschool.rl.agent import Agent, play
from botschool.rl.folder import Evaluations, RunFolder
from botschool.rl.parameters import parse
from botschool.rl.settings import Settings
from botschool.rl.spellings import translated
from botschool.rl.training import train
from botschool.seeds import POST_EVALUATION_SEED
from test_analysis import drawn, lines_of, save_run, stat_of  # noqa: F401  (drawn is a fixture)

pytest.importorskip("sb3_contrib")


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


@pytest.mark.usefixtures("by_sb3")
@pytest.mark.parametrize(("algo", "env", "params"), TRAINED)
def test_the_newer_algorithms_train(algo, env, params, tmp_path):
    run = tiny(tmp_path, algo, env, params=params)
    found = run.evaluations()
    assert found.steps[0] == 0 and found.steps[-1] >= 120
    np.testing.assert_allclose(again(run), found.returns[-1], rtol=1e-4)
    assert any("loss" in name or name.startswith("train/") for name in run.log())


# processes


@pytest.mark.usefixtures("by_sb3")
def test_environments_in_processes_give_the_same(tmp_path):
    params = {"n_steps": 32, "batch_size": 32, "n_epochs": 1, "normalize": True}
    one, other = (
        tiny(tmp_path, "ppo", "tiny_envs:Tiny-v0", params=params, vec_env=kind)
        for kind in ("dummy", "subproc")
    )
    np.testing.assert_array_equal(one.evaluations().returns, other.evaluations().returns)
    assert other.settings().vec_env == "subproc"


# wrappers


@pytest.mark.usefixtures("by_sb3")
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


# --- `botschool rl` understands the spellings of Stable Baselines 2 and its Zoo, as in the chapter.


pytest.importorskip("stable_baselines3")

pytestmark = pytest.mark.slow

TINY = ("--steps", 64, "--envs", 2, "--episodes", 2, "--evaluations", 1)
SMALL = ("n_steps:32", "batch_size:32", "noptepochs:1")


def trained(command, folder, *flags):
    """The training that the command has made."""
    code, out, errors = command("rl", "train", *flags)
    assert (code, errors) == (0, ""), errors
    return RunFolder(out.splitlines()[0].rpartition(" in ")[2])


@pytest.mark.usefixtures("by_sb3")
def test_the_chapters_way_to_train_watch_and_film(tmp_path, command, monkeypatch):
    monkeypatch.chdir(tmp_path)
    flags = ("--algo", "ppo2", "--env", "CartPole-v1", "-f", "logs", "-tb", "logs/ppo2/cartpole1")
    run = trained(command, tmp_path, *flags, *TINY, "-params", *SMALL, "learning_rate:0.001")
    assert str(run.path) == "logs/ppo/CartPole-v1_1"
    assert run.settings().parameters["learning_rate"] == 0.001
    [events] = (tmp_path / "logs/ppo2/cartpole1/CartPole-v1_1").iterdir()
    [own] = run.path.glob("events.out*")
    assert events.stat().st_size == own.stat().st_size
    second = trained(command, tmp_path, *flags, *TINY, "-params", *SMALL, "n_timesteps:128")
    assert str(second.path) == "logs/ppo/CartPole-v1_2"

    watch = ("--algo", "ppo2", "--env", "CartPole-v1", "-f", "logs")
    for number, path in ((1, run.path), (0, second.path)):
        code, out, _ = command(
            *("rl", "enjoy", *watch, "--exp-id", number, "--load-best", "--episodes", 1),
            *("--render", "none"),
        )
        assert code == 0 and out.startswith(f"agent: {path}\n")
    code, out, _ = command("rl", "video", *watch, "--exp-id", 2, "-n", 5)
    assert code == 0 and "video: agent.mp4" in out
    import imageio.v3

    assert len(imageio.v3.imread("agent.mp4")) == 5


@pytest.mark.usefixtures("by_sb3")
def test_the_chapters_policy_kwargs(tmp_path, command):
    run = trained(
        *(command, tmp_path, "--algo", "ppo2", "--env", "CartPole-v1", "-o", tmp_path, *TINY),
        *(
            "-params",
            "n_steps:32",
            "noptepochs:1",
            "policy_kwargs:dict(net_arch=[32, 32])",
            "policy:MlpPolicy",
        ),
        *("nminibatches:4", "lam:0.9", "cliprange:0.3", "cliprange_vf:0.4"),
    )
    used = run.settings().parameters
    expected = {"net_arch": [32, 32], "n_epochs": 1, "gae_lambda": 0.9, "clip_range": 0.3}
    assert used.items() >= (expected | {"clip_range_vf": 0.4, "batch_size": 16}).items()
    np.testing.assert_array_equal(run.evaluations().steps, [0, 64])


@pytest.mark.usefixtures("by_sb3")
@pytest.mark.parametrize(
    ("items", "parameters", "options"),
    [
        (["learning_rate:0.001", "n_timesteps:30000"], {"learning_rate": 0.001}, {"steps": 30000}),
        (["policy_kwargs:dict(net_arch=[32, 32])"], {"net_arch": [32, 32]}, {}),
        (["policy_kwargs:dict(activation_fn=nn.ReLU, net_arch=[dict(pi=[8], vf=[4])])"],
         {"activation_fn": "relu", "net_arch": {"pi": [8], "vf": [4]}}, {}),
        (["policy_kwargs={net_arch: [3]}"], {"net_arch": [3]}, {}),
        (["policy:'CustomMlpPolicy'", "n_envs:1e1"], {"net_arch": [16]},
         {"policy": "mlp", "envs": 10}),
        (["policy:CnnPolicy", "target_kl:None"], {"target_kl": None}, {"policy": "cnn"}),
        (["policy:CnnLstmPolicy"], {}, {"policy": "cnnlstm"}),
        (["learning_rate:lin_0.00025", "normalize:True"],
         {"learning_rate": "linear 0.00025", "normalize": True}, {}),
        (["net_arch={pi: [8]}"], {"net_arch": {"pi": [8]}}, {}),
    ],
)  # fmt: skip
def test_translations(items, parameters, options):
    assert translated(parse(items)) == (parameters, options)


@pytest.mark.usefixtures("by_sb3")
@pytest.mark.parametrize(
    ("flags", "says"),
    [
        ("--algo acer", "no acer any more: use --algo a2c or ppo instead"),
        ("--algo actkr", "no actkr any more"),
        ("--algo acktr", "no acktr any more: use --algo trpo or ppo instead"),
        ("--algo gail", "no gail any more: it imitates an expert, as the package imitation does"),
        ("--algo ppo -params lam:0.9 gae_lambda:0.8", "lam means gae_lambda: give one of them"),
        ("--algo ppo -params nminibatches:3 n_steps:32", "must divide n_steps times envs, 32 x 8"),
        ("--algo a2c -params nminibatches:4", "nminibatches is for ppo, not for A2C"),
        ("--algo ppo -params policy_kwargs:5", "must be written as dict(net_arch=[32, 32])"),
        ("--algo ppo -params policy_kwargs:exec('x')", "must be written as dict"),
        (
            "--algo ppo -params policy_kwargs:dict(gamma=1) gamma:1",
            "both inside policy_kwargs and outside",
        ),
        ("--algo ppo -params policy_kwargs:dict(net_ar=[3])", "did you mean net_arch?"),
        ("--algo ppo -params n_timesteps:many", "n_timesteps is many, but must be a whole number"),
        ("--algo ppo -params policy:Mpl", "no policy 'Mpl'; did you mean mlp?"),
    ],
)
def test_what_cannot_be_translated(flags, says, tmp_path, refused):
    refused("rl", "train", "--env", "CartPole-v1", "-o", tmp_path, *flags.split(), says=says)
    assert not list(tmp_path.iterdir())


# --- plotstat reads trainings, alone and beside evolution.


MEANS = [0.0, 50.0, 20.0, 90.0]


def save_training(folder, number, means=MEANS, **given):
    """A training with these post-evaluations after 0, 1000, ... steps, of 2 episodes each."""
    run = RunFolder(folder / "ppo" / f"Acrobot-v1_{number}")
    run.path.mkdir(parents=True)
    used = Settings("ppo", "Acrobot-v1", "mlp", number, 3000, 1, False, 3, 2, given, given)
    used.save(run.config)
    means = np.array(means)
    run.save_evaluations(
        Evaluations(
            1000 * np.arange(len(means)),
            np.stack([means - 1, means + 1], axis=1),
            np.full((len(means), 2), 50),
        )
    )
    rows = ["rollout/ep_rew_mean,time/total_timesteps", "10,500", "30,1500", ",2000", "70,3000"]
    (run.path / "progress.csv").write_text("\n".join(rows) + "\n")
    return run


def test_one_training_is_drawn(tmp_path, drawn):  # noqa: F811
    run = save_training(tmp_path, 3)
    plots.plot_stat([run.path], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    np.testing.assert_array_equal(lines["post-evaluated"][:, 1], MEANS)
    assert set(lines) == {
        "post-evaluated",
        "best post-evaluated so far",
        "episodes of the training",
    }
    axes = drawn[0].axes[0]
    assert axes.get_title() == "ppo Acrobot-v1, run 3"
    assert axes.get_xlabel() == "steps of training"
    assert imread(tmp_path / "a.png").shape[:2] == (500, 800)


def test_trainings_that_differ_in_the_seed_alone_are_averaged(tmp_path, drawn):  # noqa: F811
    for number, last in ((1, 80.0), (2, 100.0)):
        save_training(tmp_path, number, [*MEANS[:-1], last])
    save_training(tmp_path, 3, gamma=0.9)
    plots.plot_stat([tmp_path], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    mean = lines["ppo Acrobot-v1, mean ± sd of 2 runs"]
    np.testing.assert_allclose(mean[-1], [3000, 90.0])
    np.testing.assert_allclose(mean[:, 1].max(), 90.0)
    assert lines["ppo Acrobot-v1 gamma=0.9, 1 run"][-1, 1] == 90.0
    assert drawn[0].axes[0].get_title() == "post-evaluated"


def test_evolution_and_a_training_share_a_figure(tmp_path, drawn):  # noqa: F811
    """Both as evolution measures them: the best so far, every step counted."""
    save_run(tmp_path / "acrobot", 1, stat_of(5))
    save_training(tmp_path / "rl", 1)
    plots.plot_stat([tmp_path / "acrobot", tmp_path / "rl"], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    np.testing.assert_array_equal(lines["acrobot, 1 run"][:, 1], stat_of(5)[:, BEST_POST])
    np.testing.assert_array_equal(
        lines["ppo Acrobot-v1, 1 run"],
        [[100, 0], [1200, 50], [2300, 50], [3400, 90]],
    )
    axes = drawn[0].axes[0]
    assert axes.get_title() == "best post-evaluated so far"
    assert axes.get_xlabel() == "steps, including post-evaluations"
    assert axes.get_ylabel() == "mean return of an episode"


def test_a_damaged_training_is_skipped_unless_it_was_named(tmp_path, drawn):  # noqa: F811
    save_training(tmp_path, 1)
    bad = save_training(tmp_path, 2)
    (bad.path / "evaluations.npz").write_bytes(b"PK junk")
    notices = []
    plots.plot_stat([tmp_path], tmp_path / "a.png", notices.append)
    assert len(notices) == 1 and "evaluations.npz is damaged" in notices[0]
    with pytest.raises(BotschoolError, match="damaged"):
        plots.plot_stat([bad.path], tmp_path / "a.png")
    (bad.path.parent / "Acrobot-v1_1" / "evaluations.npz").unlink()
    with pytest.raises(BotschoolError, match="no training in"):
        plots.plot_stat([tmp_path], tmp_path / "a.png", notices.append)
