"""`--policy module:Class`: a policy class of one's own is trained, watched and filmed."""

import itertools
import re
from pathlib import Path

import pytest
import yaml

from botschool.errors import BotschoolError
from botschool.rl import settings, tuning
from botschool.rl.agent import Agent
from botschool.rl.folder import RunFolder
from botschool.rl.study import Log, ended, open_study
from botschool.rl.training import train
from botschool.rl.tuning import Plan, tune
from running import TESTS

pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("by_sb3")]

pytest.importorskip("stable_baselines3")
TINY = {"steps": 64, "envs": 1, "evaluations": 1, "episodes": 2}
SMALL = {"n_steps": 32, "batch_size": 32, "n_epochs": 1}
OWN = "own_policies:Narrow"


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    folder = tmp_path_factory.mktemp("own")
    return train("ppo", "CartPole-v1", folder, policy=OWN, params=SMALL, **TINY)


def test_it_is_trained_with_its_own_parts(trained):
    agent = Agent.load(trained.last, policy=OWN)
    assert type(agent.model.policy).__name__ == "Narrow"
    assert float(agent.model.policy.gain.detach()[0]) != 1.0  # it has learned
    assert agent.model.policy.mlp_extractor.policy_net[0].out_features == 1
    assert trained.settings().policy == OWN


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
    refused("rl", "enjoy", copy.path, says="bomb:Policy, a class that is not part of botschool")


@pytest.mark.parametrize(
    ("policy", "says"),
    [
        ("own_policis:Narrow", ["no module own_policis", "take the policy Narrow from"]),
        ("own_policies:Narow", ["has no policy 'Narow'", "did you mean Narrow?"]),
        (
            "own_policies:Thing",
            ["own_policies:Thing is not a policy of Stable-Baselines3", "derive"],
        ),
        ("own_policies:number", ["is not a policy of Stable-Baselines3"]),
        ("own_policies:", ["does not name a class", "my_policy:MyPolicy"]),
        (":Narrow", ["does not name a class"]),
        ("os.system('x'):A", ["does not name a class"]),
        ("own_polices", ["no policy 'own_polices'", "or module:Class for one of your own"]),
    ],
)
def test_classes_that_are_none(policy, says, tmp_path, refused):
    flags = ("--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path)
    refused("rl", "train", *flags, "--policy", policy, says=says)
    assert not list(tmp_path.iterdir())


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


# --- `botschool rl tune`: tries hyperparameters, goes on where it stopped, writes what is best.


pytest.importorskip("stable_baselines3")
optuna = pytest.importorskip("optuna")

BRIEF = {"steps": 24, "envs": 1, "seed": 3, "evaluations": 2, "episodes": 2, "wrappers": ""}


@pytest.fixture(autouse=True)
def small_space(monkeypatch):
    space = {"n_steps": (8, 12), "learning_rate": Log(1e-4, 1.0), "net_arch": ("[4]", "[8, 8]")}
    monkeypatch.setattr(tuning, "SPACES", {"a2c": space})


def plan_of(folder, trials=3, **options):
    return Plan("a2c", "tiny_envs:Tiny-v0", folder, trials, BRIEF | options)


def study_of(plan, number):
    return open_study(plan.path, plan.options["seed"], number)


def results(plan):
    """(choices, value) of the trials that have one."""
    study = study_of(plan, 0)
    return [(t.user_attrs["given"], t.value) for t in ended(study)]


def test_the_start_and_some_others_are_tried(tmp_path):
    plan, said = plan_of(tmp_path), []
    assert tune(plan, said.append)
    tried = results(plan)
    assert len(tried) == len(said) == 3
    assert tried[0][0] == {} and said[0].endswith("(the start)")
    assert tried[1][0].keys() == {"n_steps", "learning_rate", "net_arch"}
    assert tried[1][0] != tried[2][0]
    best = max(tried, key=lambda each: each[1])[0]
    assert (yaml.safe_load(plan.best.read_text()) or {}) == best
    assert len(list((plan.path / "trials" / "a2c").iterdir())) == 3


def test_it_goes_on_as_if_it_had_not_been_stopped(tmp_path):
    whole = plan_of(tmp_path / "whole", 4)
    assert tune(whole)
    assert tune(plan_of(tmp_path / "parts", 2))
    calls = itertools.count()
    assert not tune(plan_of(tmp_path / "parts", 4), stopping=lambda: next(calls) > 5)
    parts = plan_of(tmp_path / "parts", 4)
    study_of(parts, 2).ask()  # as a process that was killed leaves it
    assert tune(parts)
    assert results(parts) == results(whole)
    states = optuna.trial.TrialState
    left = study_of(parts, 4).get_trials()
    assert {trial.state for trial in left} == {states.COMPLETE, states.FAIL}
    assert parts.best.read_text() == whole.best.read_text()


def test_the_command_and_what_it_writes(tmp_path, command):
    flags = ("--algo", "a2c", "--env", "tiny_envs:Tiny-v0", "-n", 24, "--envs", 1, "-o", tmp_path)
    small = ("--evaluations", 1, "--episodes", 2)
    code, out, errors = command("rl", "tune", *flags, *small, "--trials", 2)
    assert (code, errors) == (0, "")
    best = tmp_path / "tune" / "a2c" / "tiny_envs-Tiny-v0" / "best.yaml"
    assert str(best) in out.splitlines()[-1]
    best.write_text("n_steps: 4\nlearning_rate: 1e-3\nnet_arch: [4]\n")
    code, out, _ = command(
        "rl", "train", *flags, *small, "--settings", best, "--params", "n_steps=6"
    )
    assert code == 0
    used = settings.Settings.load(tmp_path / "a2c" / "tiny_envs-Tiny-v0_1" / "config.yaml")
    assert (used.parameters["n_steps"], used.parameters["learning_rate"]) == (6, 0.001)


def test_what_cannot_be_tuned(tmp_path, refused):
    assert tune(plan_of(tmp_path, 1))
    with pytest.raises(BotschoolError, match=r"a tuning with steps = 24, not 48: change it back"):
        tune(plan_of(tmp_path, 2, steps=48))
    own = ("rl", "tune", "-o", tmp_path / "new")
    refused(*own, "--algo", "sac", "--env", "CartPole-v1", says="sac cannot be trained on")
    refused(*own, "--algo", "ppo", "--env", "CartPol-v1", says="did you mean CartPole-v1?")
    train = ("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path / "new")
    refused(*train, "--settings", tmp_path / "no.yaml", says="no.yaml cannot be read")
    (tmp_path / "list.yaml").write_text("- 1\n")
    refused(*train, "--settings", tmp_path / "list.yaml", says="holds no hyperparameters")
    assert not (tmp_path / "new").exists()
