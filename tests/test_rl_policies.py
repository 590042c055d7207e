"""`--policy module:Class`: a policy class of one's own is trained, watched and filmed."""

import re
from pathlib import Path

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.rl.agent import Agent
from botschool.rl.folder import RunFolder
from botschool.rl.training import train
from running import TESTS

pytest.importorskip("stable_baselines3")
pytestmark = pytest.mark.usefixtures("by_sb3")
TINY = {"steps": 64, "envs": 1, "evaluations": 1, "episodes": 2}
SMALL = {"n_steps": 32, "batch_size": 32, "n_epochs": 1}
OWN = "own_policies:Narrow"


@pytest.fixture(autouse=True)
def own_policies(monkeypatch):
    monkeypatch.syspath_prepend(TESTS)


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(TESTS)
        folder = tmp_path_factory.mktemp("own")
        return train("ppo", "CartPole-v1", folder, policy=OWN, params=SMALL, **TINY)


def test_it_is_trained_with_its_own_parts(trained):
    agent = Agent.load(trained.last, policy=OWN)
    assert type(agent.model.policy).__name__ == "Narrow"
    assert float(agent.model.policy.gain.detach()[0]) != 1.0  # it has learned
    assert agent.model.policy.mlp_extractor.policy_net[0].out_features == 1
    assert trained.settings().policy == OWN


def test_what_it_hands_on_is_a_hyperparameter(tmp_path):
    run = train(
        *("ppo", "CartPole-v1", tmp_path),
        policy=OWN,
        params=SMALL | {"net_arch": [3], "activation_fn": "relu"},
        **TINY,
    )
    policy = Agent.load(run.best, policy=OWN).model.policy
    assert policy.mlp_extractor.policy_net[0].out_features == 3


def test_other_algorithms_take_theirs(tmp_path):
    params = {"learning_starts": 10, "net_arch": [4], "batch_size": 8, "buffer_size": 100}
    run = train(
        "sac", "tiny_envs:Tiny-v0", tmp_path, policy="own_policies:Soft", params=params, **TINY
    )
    assert np.isfinite(run.evaluations().returns).all()
    with pytest.raises(BotschoolError, match=r"Soft cannot be trained with PPO: derive"):
        train("ppo", "tiny_envs:Tiny-v0", tmp_path, policy="own_policies:Soft", **TINY)


def test_the_command_watches_it_when_it_is_named_again(trained, command, refused, tmp_path):
    watch = ("rl", "enjoy", trained.path, "--episodes", 1, "--render", "none")
    code, out, errors = command(*watch, "--policy", OWN)
    assert (code, errors) == (0, "") and out.startswith("episode 1 ")
    film = ("rl", "video", trained.path, "-f", tmp_path / "a.gif", "--steps", 2)
    assert command(*film, "--policy", OWN)[0] == 0
    refused(*watch, says=["is own_policies:Narrow, a class that is", f"add --policy {OWN}."])
    refused(*film, says="add --policy")
    other = ("--policy", "own_policies:Soft")
    refused(*watch, *other, says=f"not own_policies:Soft: write --policy {OWN}")


def test_what_an_agent_names_is_not_imported(trained, tmp_path, refused, monkeypatch):
    """A foreign training whose settings name a module that would run at once."""
    import shutil

    copy = RunFolder(shutil.copytree(trained.path, tmp_path / "foreign"))
    (tmp_path / "bomb.py").write_text("raise SystemExit('it was imported')\n")
    monkeypatch.chdir(tmp_path)
    text = copy.config.read_text()
    assert OWN in text
    copy.config.write_text(text.replace(OWN, "bomb:Policy"))
    refused("rl", "enjoy", copy.path, says="bomb:Policy, a class that is no part of botschool")


@pytest.mark.parametrize(
    ("policy", "says"),
    [
        ("own_policis:Narrow", ["no module own_policis", "take the policy Narrow from"]),
        ("own_policies:Narow", ["has no policy 'Narow'", "did you mean Narrow?"]),
        ("own_policies:Thing", ["own_policies:Thing is no policy of Stable-Baselines3", "derive"]),
        ("own_policies:number", ["is no policy of Stable-Baselines3"]),
        ("own_policies:", ["names no class", "my_policy:MyPolicy"]),
        (":Narrow", ["names no class"]),
        ("os.system('x'):A", ["names no class"]),
        ("own_polices", ["no policy 'own_polices'", "or module:Class for one of your own"]),
    ],
)
def test_classes_that_are_none(policy, says, tmp_path, refused):
    flags = ("--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path)
    refused("rl", "train", *flags, "--policy", policy, says=says)
    assert not list(tmp_path.iterdir())


def test_a_module_that_breaks(tmp_path, refused, monkeypatch):
    (tmp_path / "code").mkdir()
    (tmp_path / "code" / "broken_policy.py").write_text("1 / 0\n")
    monkeypatch.syspath_prepend(str(tmp_path / "code"))
    flags = ("--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path)
    code_of = ["broken_policy", "ZeroDivisionError: division by zero", "mend it"]
    refused("rl", "train", *flags, "--policy", "broken_policy:A", says=code_of)


def test_the_example_of_the_readme(tmp_path, command, monkeypatch):
    readme = Path(TESTS).parent / "README.md"
    if not readme.exists() or "my_policy.py" not in readme.read_text():
        pytest.skip("a student's copy has another README.md")
    [code] = re.findall(r"```python\n# my_policy.py\n(.*?)```", readme.read_text(), re.DOTALL)
    (tmp_path / "my_policy.py").write_text(code)
    monkeypatch.chdir(tmp_path)
    own = ("--algo", "ppo", "--env", "CartPole-v1", "--policy", "my_policy:SquaresPolicy")
    small = ("--params", *(f"{name}={value}" for name, value in SMALL.items()))
    flags = ("-n", 64, "--envs", 1, "--evaluations", 1, "--episodes", 1)
    result, _, errors = command("rl", "train", *own, *flags, *small)
    assert result == 0, errors
    assert "my_policy is taken from the present folder" in errors
    result, out, _ = command("rl", "enjoy", *own, "--episodes", 1, "--render", "none")
    assert result == 0 and "return" in out
    policy = Agent.load(RunFolder("results/rl/ppo/CartPole-v1_1").best, policy=own[-1]).model.policy
    assert policy.mlp_extractor.policy_net[0].in_features == 8


def test_an_agent_of_a_usual_policy(tmp_path, refused):
    run = train("ppo", "CartPole-v1", tmp_path, params=SMALL, **TINY)
    refused("rl", "enjoy", run.path, "--policy", OWN, says="is mlp, not own_policies:Narrow: leave")
