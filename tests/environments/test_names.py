"""A problem has the same names everywhere: in files, in `rl`, in Gymnasium."""

import gymnasium
import pytest

import botschool.envs  # noqa: F401
from botschool import config, problems
from botschool.paths import own_file
from botschool.problems.native import gym_id, own_name
from botschool.rl import watch
from botschool.rl.folder import run_of
from botschool.rl.model import choose
from botschool.rl.native.problem import native_problem
from botschool.rl.training import train

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


def test_a_file_with_wrappers_says_that_it_runs_in_python(tmp_path):
    file = tmp_path / "w.ini"
    file.write_text("[EXP]\nenvironment = CartPole-v1\nwrappers = FlattenObservation\n")
    [note] = config.load(file).notes
    assert note == "CartPole-v1 runs in Python: the native engine takes no wrappers."


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
