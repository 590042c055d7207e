"""`botschool rl` refuses in one sentence, before it leaves anything behind."""

import re
import shutil
import sys
from zipfile import ZipFile

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.rl.agent import Agent, save_weights
from botschool.rl.folder import RunFolder
from botschool.rl.training import train
from botschool.rl.weights import WEIGHTS

pytest.importorskip("stable_baselines3")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.usefixtures("by_sb3"),
]


@pytest.fixture(scope="module")
def trained(tmp_path_factory):
    params = {"n_steps": 32, "batch_size": 32, "n_epochs": 1}
    folder = tmp_path_factory.mktemp("rl")
    return train(
        "ppo", "CartPole-v1", folder, params=params, steps=32, envs=1, evaluations=1, episodes=1
    )


@pytest.fixture
def copy(trained, tmp_path):
    """A copy of a training, to be damaged."""
    return RunFolder(shutil.copytree(trained.path, tmp_path / "CartPole-v1_1"))


@pytest.mark.parametrize(
    ("flags", "says"),
    [
        ("--algo pp --env CartPole-v1", "no algorithm 'pp'; did you mean ppo?"),
        ("--algo x --env CartPole-v1", "no algorithm 'x'; known are ppo, a2c, trpo, ars, sac, td3"),
        ("--algo ppo --env CartPol-v1", "did you mean CartPole-v1?"),
        ("--algo ppo --env CartPole-v1 --policy lstn", "did you mean lstm?"),
        ("--algo a2c --env CartPole-v1 --policy lstm", "use --algo ppo"),
        ("--algo ppo --env CartPole-v1 --policy cnn", "shows no images"),
        ("--algo sac --env CartPole-v1", "whose actions are Discrete(2): use --algo ppo or a2c"),
        ("--algo dqn --env Pendulum-v1", "use --algo ppo or a2c or trpo or sac or td3"),
        ("--algo ppo --env CartPole-v1 --steps 0", "'--steps'"),
        ("--algo ppo", "Missing option '--env'"),
    ],
)
def test_unknown_words(flags, says, refused, tmp_path):
    refused("rl", "train", "-o", tmp_path, *flags.split(), says=says)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("param", "says"),
    [
        ("learning_rat=0.1", "did you mean learning_rate?"),
        ("normalise=true", "did you mean normalize?"),
        ("gamma=2", "gamma is 2, but must be from 0 to 1"),
        ("gamma=abc", "must be a number"),
        ("gamma=null", "must be a number"),
        ("gamma=.inf", "must be a number"),
        ("n_steps=1.5", "n_steps is 1.5, but must be a whole number"),
        ("n_steps=0", "must be at least 1"),
        ("learning_rate=true", "must be a number or 'linear X'"),
        ("learning_rate=-1", "must be at least 0"),
        ("learning_rate=linear -1", "must be at least 0"),
        ("learning_rate=linear x", "'linear X'"),
        ("net_arch=64", "as [64, 64]"),
        ("net_arch=[0]", "as [64, 64]"),
        ("activation_fn=rely", "tanh, relu, elu or gelu"),
        ("use_sde=1", "true or false"),
        ("use_sde=true", "only be used with continuous actions"),
        ("normalize=maybe", "true or false"),
        ("n_lstm_layers=2", "add --policy lstm"),
        ("steps=5", "use --steps"),
        ("policy_kwargs=5", "net_arch=[32,32]"),
        ("learning_rate", "write --params name=value"),
        ("=3", "write --params name=value"),
        ("net_arch=[3", "cannot be read"),
    ],
)
def test_wrong_hyperparameters(param, says, refused, tmp_path):
    sentence = refused(
        *("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path),
        *("--params", "n_epochs=3", param),
        says=says,
    )
    assert param.partition("=")[0] in sentence or "gSDE" in sentence
    assert not list(tmp_path.iterdir())


def test_learning_that_explodes(tmp_path):
    params = {"learning_rate": 1e30, "max_grad_norm": 1e30, "n_steps": 32, "batch_size": 32}
    with pytest.raises(BotschoolError, match=r"broke down after \d+ steps.*lower learning_rate"):
        train("ppo", "Pendulum-v1", tmp_path, params=params, steps=500, envs=1, evaluations=1)


def test_packages_that_are_missing(refused, tmp_path, monkeypatch):
    for package in ("torch", "stable_baselines3"):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, package, None)
            refused(
                *("rl", "train", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path),
                says=[f"needs the package {package}", "pip install"],
            )


# models


def test_a_model_of_another_environment(trained, refused):
    refused(
        *("rl", "enjoy", trained.path, "--env", "Acrobot-v1"),
        says=["model of CartPole-v1", "shape (4,)", "cannot act in Acrobot-v1", "shape (6,)"],
    )
    refused("rl", "enjoy", trained.path, "--env", "Acrobo-v1", says="did you mean Acrobot-v1?")


def test_damaged_models(copy, refused):
    whole = copy.best.read_bytes()
    for content in (b"", b"words", whole[: len(whole) // 2], whole[:-10]):
        copy.best.write_bytes(content)
        refused("rl", "enjoy", copy.path, says=[copy.best, "damaged"])
    flipped = bytearray(whole)
    flipped[len(whole) // 2] ^= 0xFF
    copy.best.write_bytes(flipped)
    refused("rl", "enjoy", copy.path, says=[copy.best, "damaged"])
    copy.best.unlink()
    refused("rl", "enjoy", copy.path, says=["no model", "botschool rl train"])


def test_a_model_whose_numbers_are_not_finite_is_refused(copy, refused):
    agent = Agent.load(copy.best)
    for weight in agent.model.policy.parameters():
        weight.data.fill_(float("nan"))
    agent.model.save(copy.best)
    refused("rl", "enjoy", copy.path, says="not finite")


def test_no_object_in_a_model_is_ever_loaded(copy):
    """A zip with an object that would run code, where Stable-Baselines3 keeps its own ones."""
    import base64
    import json
    import pickle
    from zipfile import ZipFile

    class Bomb:
        def __reduce__(self):
            return (pytest.fail, ("the model was unpickled",))

    bomb = {":serialized:": base64.b64encode(pickle.dumps(Bomb())).decode()}
    with ZipFile(copy.best) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    with ZipFile(copy.best, "w") as archive:
        for name, part in parts.items():
            archive.writestr(name, json.dumps({"gamma": bomb}) if name == "data" else part)
    Agent.load(copy.best)


@pytest.mark.parametrize("content", ["", "algo: ppo", "- 1", "a: [", "\x00"])
def test_damaged_settings(copy, content, refused, command):
    copy.config.write_text(content)
    refused("rl", "enjoy", copy.path, says=[copy.config])
    code, out, _ = command("rl", "list", copy.path.parent)
    assert code == 0 and "damaged" in out


def renamed_array(copy):
    path = copy.path / "evaluations.npz"
    with open(path, "wb") as file:
        np.save(file, np.arange(5.0))


def words(copy):
    text = np.array([["a", "b"]])
    np.savez(copy.path / "evaluations.npz", timesteps=[1], results=text, ep_lengths=text)


def no_columns(copy):
    np.savez(copy.path / "evaluations.npz", timesteps=[[1]], results=[[1.0]], ep_lengths=[1])


def damaged_header(copy):
    path = copy.path / "evaluations.npz"
    with ZipFile(path) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    members["results.npy"] = members["results.npy"].replace(b"'shape': (", b"'shape': ((")
    with ZipFile(path, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)


@pytest.mark.parametrize("damage", [renamed_array, words, no_columns, damaged_header])
def test_evaluations_that_are_none(damage, copy, command):
    damage(copy)
    code, out, errors = command("rl", "list", copy.path)
    assert (code, errors) == (0, "")
    assert re.search(r"\s1\s+-\s+-\s+-", out), out
    with pytest.raises(BotschoolError, match="evaluations"):
        copy.evaluations()


@pytest.mark.parametrize("name", ["mean", "clip", "epsilon"])
def test_a_scaling_of_other_observations_is_refused(name, tmp_path):
    params = {"n_steps": 32, "batch_size": 32, "n_epochs": 1, "normalize": True}
    run = train(
        *("ppo", "CartPole-v1", tmp_path),
        params=params,
        steps=32,
        envs=1,
        evaluations=1,
        episodes=1,
    )
    save_weights(run.best, run.path / WEIGHTS)
    with np.load(run.path / WEIGHTS) as file:
        arrays = dict(file)
    arrays[f"normalisation.{name}"] = np.full(16, -1.0)
    np.savez(run.path / WEIGHTS, **arrays)
    with pytest.raises(BotschoolError, match="is damaged"):
        Agent.load(run.path / WEIGHTS)
