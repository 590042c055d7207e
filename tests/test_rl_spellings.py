"""`botschool rl` understands the spellings of Stable Baselines 2 and its Zoo, as in the chapter."""

import numpy as np
import pytest

from botschool.rl.folder import RunFolder
from botschool.rl.parameters import parse
from botschool.rl.spellings import translated

pytest.importorskip("stable_baselines3")
pytestmark = pytest.mark.usefixtures("by_sb3")

TINY = ("--steps", 64, "--envs", 2, "--episodes", 2, "--evaluations", 1)
SMALL = ("n_steps:32", "batch_size:32", "noptepochs:1")


def trained(command, folder, *flags):
    """The training that the command has made."""
    code, out, errors = command("rl", "train", *flags)
    assert (code, errors) == (0, ""), errors
    return RunFolder(out.splitlines()[0].rpartition(" in ")[2])


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
        ("--algo ppo -params policy_kwargs:dict(gamma=1) gamma:1", "beside policy_kwargs and in"),
        ("--algo ppo -params policy_kwargs:dict(net_ar=[3])", "did you mean net_arch?"),
        ("--algo ppo -params n_timesteps:many", "n_timesteps is many, but must be a whole number"),
        ("--algo ppo -params policy:Mpl", "no policy 'Mpl'; did you mean mlp?"),
    ],
)
def test_what_cannot_be_translated(flags, says, tmp_path, refused):
    refused("rl", "train", "--env", "CartPole-v1", "-o", tmp_path, *flags.split(), says=says)
    assert not list(tmp_path.iterdir())


def test_trainings_that_are_not_there(tmp_path, refused):
    own = ("rl", "enjoy", "-f", tmp_path, "--algo", "ppo2")
    refused(*own, "--env", "Taxi-v3", says=["no training of ppo on Taxi-v3", "rl train"])
    refused(*own, says="--algo ppo --env CartPole-v1")
