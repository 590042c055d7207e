"""`botschool rl tune`: tries hyperparameters, goes on where it stopped, writes what is best."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
import yaml

from botschool.errors import BotschoolError
from botschool.rl import settings, tuning
from botschool.rl.folder import Evaluations
from botschool.rl.model import choose
from botschool.rl.tuning import SPACES, Log, Plan, tune
from running import TESTS

pytest.importorskip("stable_baselines3")
pytestmark = pytest.mark.usefixtures("by_sb3")
optuna = pytest.importorskip("optuna")

SMALL = {"steps": 24, "envs": 1, "seed": 3, "evaluations": 2, "episodes": 2, "wrappers": ""}


@pytest.fixture(autouse=True)
def small_space(monkeypatch):
    monkeypatch.syspath_prepend(TESTS)
    space = {"n_steps": (8, 12), "learning_rate": Log(1e-4, 1.0), "net_arch": ("[4]", "[8, 8]")}
    monkeypatch.setattr(tuning, "SPACES", {"a2c": space})


def plan_of(folder, trials=3, **options):
    return Plan("a2c", "tiny_envs:Tiny-v0", folder, trials, SMALL | options)


def results(plan):
    """(choices, value) of the trials that have one."""
    study = tuning._study(plan, 0)
    return [(t.user_attrs["given"], t.value) for t in tuning._ended(study)]


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
    tuning._study(parts, 2).ask()  # as a process that was killed leaves it
    assert tune(parts)
    assert results(parts) == results(whole)
    ended = optuna.trial.TrialState
    left = tuning._study(parts, 4).get_trials()
    assert {trial.state for trial in left} == {ended.COMPLETE, ended.FAIL}
    assert parts.best.read_text() == whole.best.read_text()


def test_a_trial_is_worth_the_mean_of_its_trainings(tmp_path, monkeypatch):
    trained = []

    def learn(settings, folder, report, stopping):
        trained.append(settings.seed)
        value = float(settings.seed)
        ends = Evaluations(np.array([12, 24]), np.full((2, 2), value), np.full((2, 2), 5))
        return None, ends

    monkeypatch.setattr(tuning, "learn", learn)
    several = replace(plan_of(tmp_path, 2), seeds=3)
    lines = []
    assert tune(several, lines.append)
    assert trained == [3, 4, 5] * 2 and lines[0].startswith("trial 0: 4.00 ")
    with pytest.raises(BotschoolError, match="with seeds = 3, not 1"):
        tune(plan_of(tmp_path, 3))


def test_trials_without_hope_are_broken_off(tmp_path, monkeypatch):
    monkeypatch.setattr(optuna.Trial, "should_prune", lambda self: self.number > 0)
    plan, said = plan_of(tmp_path, 2), []
    assert tune(plan, said.append)
    assert "broken off" not in said[0] and ", broken off" in said[1]
    assert yaml.safe_load(plan.best.read_text()) == {}  # the start is the best


def test_a_training_that_breaks_down_is_no_good(tmp_path, monkeypatch):
    learn, calls = tuning.learn, itertools.count()

    def breaking(*arguments, **options):
        if next(calls) == 1:
            raise BotschoolError("The training broke down after 8 steps.")
        return learn(*arguments, **options)

    monkeypatch.setattr(tuning, "learn", breaking)
    plan, said = plan_of(tmp_path, 3), []
    assert tune(plan, said.append)
    assert ", broken off" in said[1] and ", broken off" not in said[0] + said[2]
    best = max((results(plan)[i] for i in (0, 2)), key=lambda each: each[1])[0]
    assert (yaml.safe_load(plan.best.read_text()) or {}) == best


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


ENVIRONMENTS = {"her": "tiny_envs:Goal-v0", **dict.fromkeys(("dqn", "qrdqn"), "CartPole-v1")}


@pytest.mark.parametrize("algo", settings.ALGORITHMS)
def test_what_is_tried_are_hyperparameters_of_the_algorithm(algo):
    env = ENVIRONMENTS.get(algo, "tiny_envs:Tiny-v0")
    for pick in (0, -1):
        given = {
            name: values.low if isinstance(values, Log) else yaml.safe_load(str(values[pick]))
            for name, values in SPACES[algo].items()
        }
        chosen = choose(algo, env, params=given)
        assert chosen.parameters.items() >= given.items()
