"""A problem has the same names everywhere: in files, in `rl`, in Gymnasium."""

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401
from botschool import config, problems
from botschool.paths import own_file
from botschool.problems.native import gym_id, own_name
from botschool.rl import watch
from botschool.rl.folder import run_of
from botschool.rl.model import choose
from botschool.rl.native import PPO
from botschool.rl.native.discounted import DiscountedReturns
from botschool.rl.native.problem import native_problem
from botschool.rl.training import train, train_command

SAME = [
    ("CartPole-v1", "CartPole-v1", "botschool/CartPole-v1"),
    ("PlanarHopper-v5", "botschool/PlanarHopper-v5", "botschool.envs:botschool/PlanarHopper-v5"),
    ("ErDiscrim", "botschool/Discrim-v0", "Discrim-v0"),
    ("envSwingupCustom", "botschool/SwingUp-v0", "botschool/envSwingupCustom"),
    ("SpatialAnt-v5", "botschool/SpatialAnt-v5", "SpatialAnt-v5"),
]


@pytest.mark.parametrize(("own", "gym", "other"), SAME)
def test_every_name_takes_the_native_engine(own, gym, other):
    data = {"policy": {}, "algo": {"maxmsteps": 1}}
    for name in (own, gym, other):
        experiment = config.from_dict({"exp": {"environment": name}} | data)
        assert experiment.exp.environment == own
        assert problems.of(experiment).native
        assert (own_name(name), gym_id(name)) == (own, gym)
        assert native_problem(name)
        settings = choose("ppo", name)
        assert (settings.env, settings.engine) == (gym, "native")
        assert settings == choose("ppo", own)
    spaces = [gymnasium.make(name).observation_space for name in (own, gym)]
    assert spaces[0] == spaces[1]


def test_other_names_stay():
    for name in ("LunarLander-v3", "module:Own-v0", "HopperBulletEnv-v5", "ErPredprey"):
        assert own_name(name) == name == gym_id(name)


def test_a_training_is_found_by_every_name(tmp_path):
    run = train("ppo", "ErDiscrim", tmp_path, steps=500, evaluations=1, episodes=1)
    for name in SAME[2]:
        assert run_of(tmp_path, "ppo", name).path == run.path
        watch.Asked(None, tmp_path, name, "ppo").player(1)


@pytest.mark.parametrize(
    ("algo", "options", "why"),
    [
        ("a2c", {}, "it has no a2c"),
        ("ppo", {"wrappers": "FlattenObservation"}, "it takes no wrappers"),
        ("ppo", {"vec_env": "subproc"}, "it runs all environments in one process"),
        ("ppo", {"policy": "lstm"}, "it has no lstm policy"),
        ("ppo", {"params": ["use_sde=true"]}, "it has no use_sde"),
    ],
)
def test_a_sentence_says_why_the_native_engine_does_not_train(
    algo, options, why, tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr("botschool.rl.training.learn", None)
    options = {"params": [], "policy": None} | options
    with pytest.raises(TypeError):
        train_command(algo, "Pendulum-v1", folder=tmp_path, terminal=False, **options)
    error = capsys.readouterr().err
    assert f"the native engine cannot train this ({why}), so Stable-Baselines3 does." in error


def test_a_file_with_wrappers_says_that_it_runs_in_python(tmp_path):
    file = tmp_path / "w.ini"
    file.write_text("[EXP]\nenvironment = CartPole-v1\nwrappers = FlattenObservation\n")
    [note] = config.load(file).notes
    assert note == "CartPole-v1 runs in Python: the native engine takes no wrappers."


@pytest.mark.parametrize(("normalize", "error"), [(False, 1e-12), (True, 0.05)])
def test_discounted_returns_are_those_of_the_episodes(normalize, error):
    """In CartPole each step pays 1, so that an episode's length says its discounted return."""
    gamma = 0.98
    options = {"gamma": gamma, "learning_rate": 1e-3, "batch_size": 32}
    ppo = PPO("CartPole-v1", seed=3, n_envs=1, n_steps=300, normalize=normalize, **options)
    sums, truncated = DiscountedReturns(ppo), 0
    for update in range(60):
        ppo.collect()
        _, returns, lengths = ppo.episodes
        found = sums.add(returns)
        lengths = lengths[len(lengths) - len(found) :]
        if update > 5:
            assert np.allclose(found, (1 - gamma**lengths) / (1 - gamma), rtol=error)
        truncated += (lengths == 500).sum()
        ppo.update()
    assert truncated


def test_tensorboard_shows_distributions_of_the_native_engine(tmp_path):
    accumulator = pytest.importorskip("tensorboard.backend.event_processing.event_accumulator")
    run = train("ppo", "Pendulum-v1", tmp_path, steps=10_000, evaluations=1, episodes=1)
    log = accumulator.EventAccumulator(str(run.path), size_guidance={"histograms": 0})
    log.Reload()
    assert np.isfinite(log.Scalars("rollout/discounted_return")[-1].value)
    for tag in ("actions/0", "rollout/advantage"):
        shown = log.Histograms(tag)[-1].histogram_value
        assert sum(shown.bucket) == shown.num > 100
        assert shown.min < shown.max == shown.bucket_limit[-1]


@pytest.mark.parametrize(
    ("name", "ours"),
    [
        ("ErPredprey.ini", "predprey.ini"),
        ("data/experiments/ErDiscrim.ini", "discrim.ini"),
        ("envSwingupCustom.ini", "swingup.ini"),
        ("HopperBulletEnv-v5.ini", "hopper.ini"),
        ("Acrobot.ini", "acrobot.ini"),
    ],
)
def test_files_of_ours_are_found_by_names_of_the_chapter(name, ours, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert own_file(name, "experiments").name == ours
    (tmp_path / "ErPredprey.ini").touch()
    assert own_file("ErPredprey.ini", "experiments").parent.name == ""


def test_what_is_no_name_of_ours_stays():
    assert own_file("Hopper-v5.ini", "experiments").name == "Hopper-v5.ini"
    assert own_file("../ErPredprey.ini", "experiments").name == "ErPredprey.ini"


def test_enter_blames_what_is_missing(refused, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.ini").write_text("[EXP]\nenvironment = CartPole-v1\n")
    assert "There is no genotype file missing.npy" in refused("enter", "missing.npy")
    assert "There is no genotype file missing.npy" in refused("enter", "missing.npy", "-f", "n.ini")
    assert "x.ini is not a genotype" in refused("enter", "x.ini")


def test_showrobot_without_a_name_lists_the_robots(capsys):
    from botschool.envs.showrobot import PYBULLETS, list_robots

    list_robots()
    told = capsys.readouterr().out
    assert "Hopper" in told and all(name in told for name in PYBULLETS)
