"""The trained agents that come with botschool: weights alone, found, played, installed."""

import io
import pickle
import re
import shlex
import shutil
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.problems.making import make_env
from botschool.rl import shipped, weights
from botschool.rl.agent import Agent, play, save_weights
from botschool.rl.folder import RunFolder
from botschool.rl.parameters import parse
from botschool.rl.training import train
from botschool.rl.watch import Player

OURS = shipped.agents()
NAMES = [f"{each.algo}/{each.env}" for each in OURS]
LARGEST = 400_000
"""Bytes of an agent's file."""
pytest.importorskip("sb3_contrib")
pytestmark = [pytest.mark.slow, pytest.mark.usefixtures("by_sb3")]


def agent_of(algo, env):
    found = shipped.find(algo, env)
    assert found is not None
    return found


@pytest.mark.parametrize("ours", OURS, ids=NAMES)
def test_each_is_small_and_its_settings_are_told(ours):
    assert ours.path.stat().st_size < LARGEST
    assert all(array.dtype.kind == "f" for array in weights.numbers(ours.path).values())
    used = RunFolder(ours.path.parent).settings()
    assert (used.algo, used.env, used.steps) == (ours.algo, ours.env, ours.steps)
    assert ours.command.startswith(f"botschool rl train --algo {ours.algo} --env {ours.env}")
    _, _, given = ours.command.partition(" --params ")
    assert parse(shlex.split(given)) == used.given


@pytest.mark.parametrize("ours", OURS, ids=NAMES)
def test_each_does_as_well_as_measured(ours, capsys):
    """A few new episodes: their mean is within what so few of the hundred can differ."""
    try:
        make_env(ours.env).close()
    except BotschoolError as error:
        pytest.skip(str(error))
    player = Player(ours.path, seed=1)
    player.play(4)
    assert abs(np.mean(player.returns) - ours.mean) <= 3 * ours.deviation + 0.01 * abs(ours.mean)


# the command


@pytest.mark.parametrize(
    ("algo", "asked", "env"),
    [
        ("ppo2", "CartPole-v0", "CartPole-v1"),
        ("a2c", "Reacher-v2", "Reacher-v5"),
        ("ppo2", "HopperBulletEnv-v0", "botschool/PlanarHopper-v5"),
        ("td3", "Ant-v4", "botschool/SpatialAnt-v5"),
        ("ppo2", "HumanoidBulletEnv-v0", "HumanoidBulletEnv-v5"),
    ],
)
def test_the_chapters_spelling_finds_the_nearest(algo, asked, env):
    assert shipped.find(algo, asked) is None
    assert shipped.nearest(algo, asked).env == env
    assert shipped.nearest(algo, "BreakoutNoFrameskip-v4") is None


def test_one_is_taken_where_the_user_has_none(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    ours = agent_of("ppo", "CartPole-v1")
    watch = ("rl", "enjoy", "--algo", "ppo2", "--env", "CartPole-v1", "--render", "none")
    code, out, errors = command(*watch, "--episodes", 2)
    assert (code, errors) == (0, "")
    assert out.splitlines()[0] == (
        "agent: the one that comes with botschool, because results/rl has none: "
        f"ppo on CartPole-v1, {ours.steps} steps ({ours.told})"
    )
    assert "mean 500.0 " in out.splitlines()[-1]
    film = ("rl", "video", "--algo", "ppo", "--env", "CartPole-v1", "-f", "pole.gif", "-n", 3)
    code, out, _ = command(*film)
    assert code == 0 and "comes with botschool" in out and Path("pole.gif").stat().st_size > 100
    for target in (ours.path, ours.path.parent):  # as a file and a folder, too
        code, out, _ = command("rl", "enjoy", target, "--episodes", 1, "--render", "none")
        assert code == 0 and "return 500.0 " in out


def test_the_users_own_comes_first(command, tmp_path):
    small = {"params": {"n_steps": 32, "batch_size": 32, "n_epochs": 1}}
    small |= {"steps": 32, "envs": 1, "evaluations": 1, "episodes": 1}
    run = train("ppo", "CartPole-v1", tmp_path, **small)
    watch = ("rl", "enjoy", "--algo", "ppo", "--env", "CartPole-v1", "-o", tmp_path)
    code, out, _ = command(*watch, "--episodes", 1, "--render", "none")
    assert code == 0 and out.startswith(f"agent: {run.path}\n")


def test_without_the_packages_that_play_them(tmp_path, refused, monkeypatch):
    watch = ("rl", "enjoy", "-o", tmp_path, "--algo", "ppo", "--env", "CartPole-v1")
    for package in ("torch", "stable_baselines3"):
        with monkeypatch.context() as patch:
            patch.setitem(sys.modules, package, None)
            refused(*watch, says=[f"needs the package {package}", "botschool[rl]"])


def test_the_table_of_ours(command):
    code, out, _ = command("rl", "list", "--ours")
    rows = [line for line in out.splitlines() if "--algo" in line]
    assert code == 0 and len(rows) == len(OURS)
    assert any(re.search(r"--algo ppo --env CartPole-v1 +\d+ +500\.0 +0\.0 +100", r) for r in rows)


# weights alone


@pytest.fixture(scope="module")
def trainings(tmp_path_factory):
    """One training of each kind of policy, of a few steps."""
    folder = tmp_path_factory.mktemp("trainings")
    small = {"steps": 40, "envs": 1, "evaluations": 1, "episodes": 1}
    start = {"learning_starts": 10, "net_arch": [4], "buffer_size": 50, "batch_size": 8}
    collected = {"n_steps": 16, "batch_size": 16}
    return [
        train(algo, env, folder, policy=policy, params=params, **small)
        for algo, env, policy, params in (
            ("ppo", "Pendulum-v1", "mlp", collected | {"normalize": True}),
            ("ppo", "CartPole-v1", "lstm", collected | {"lstm_hidden_size": 4}),
            ("trpo", "CartPole-v1", "mlp", collected),
            ("ars", "Pendulum-v1", "mlp", {"n_delta": 1}),
            ("sac", "Pendulum-v1", "mlp", start),
            ("td3", "Pendulum-v1", "mlp", start),
            ("tqc", "Pendulum-v1", "mlp", start),
            ("dqn", "CartPole-v1", "mlp", start),
            ("qrdqn", "CartPole-v1", "mlp", start | {"n_quantiles": 5}),
        )
    ]


def test_weights_act_as_the_model_they_were_taken_from(trainings):
    for run in trainings:
        alone = run.path / weights.WEIGHTS
        save_weights(run.last, alone)
        seeds = [11, 12]
        one, other = (
            play(Agent.load(file), [run.make_env() for _ in seeds], seeds)
            for file in (run.last, alone)
        )
        np.testing.assert_array_equal(one, other, err_msg=str(run))
        names = weights.numbers(alone)
        assert not any(re.match("critic|value_net|q_net_target|actor_target", n) for n in names)


class Bomb:
    """Fails the test where it is unpickled."""

    def __reduce__(self):
        return (pytest.fail, ("it was unpickled",))


def arrays_of(path):
    return weights.numbers(path)


def test_nothing_that_could_run_is_loaded(tmp_path):
    ours = agent_of("ppo", "CartPole-v1")
    copy = Path(shutil.copytree(ours.path.parent, tmp_path / "copy")) / weights.WEIGHTS
    good = arrays_of(copy)
    name = next(iter(good))
    pickled = np.array([Bomb()], dtype=object)
    plain = io.BytesIO()
    pickle.dump(Bomb(), plain)

    def member(content):
        with zipfile.ZipFile(copy, "w") as archive:
            for each in good:
                array = io.BytesIO()
                np.save(array, good[each])
                archive.writestr(f"{each}.npy", content if each == name else array.getvalue())

    def object_array():
        array = io.BytesIO()
        np.save(array, pickled)
        member(array.getvalue())

    damages = (
        object_array,
        lambda: member(plain.getvalue()),
        lambda: copy.write_bytes(plain.getvalue()),
        lambda: np.savez(copy, **(good | {name: pickled})),
        lambda: np.savez(copy, **(good | {"more": pickled})),
        lambda: np.savez(copy, **(good | {"more": np.zeros(3)})),
        lambda: np.savez(copy, **{each: good[each] for each in list(good)[1:]}),
        lambda: np.savez(copy, **(good | {name: good[name][..., :-1]})),
        lambda: np.savez(copy, **(good | {name: good[name] * np.nan})),
        lambda: np.savez(copy, **(good | {name: good[name].astype(str)})),
        lambda: copy.write_bytes(b""),
        lambda: copy.write_bytes(ours.path.read_bytes()[:-40]),
    )
    for damage in damages:
        damage()
        with pytest.raises(
            BotschoolError, match="is damaged, or it is not a model of this training"
        ):
            Agent.load(copy)
    np.savez(copy, **good)
    Agent.load(copy)


# where they are
