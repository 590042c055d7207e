"""What exercises import: its names stay, whatever moves behind them."""

import importlib

import pytest

OLD = {
    "course_coevolution": "play",
    "course_foraging": "draw_trajectories",
    "course_locomotion": "Runner",
    "course_rl": "draw_learning",
    "course_robots": "robot_file",
}


@pytest.mark.parametrize(("module", "name"), OLD.items())
def test_modules_that_moved_keep_their_old_names(module, name):
    """Files that students wrote earlier import these."""
    old = importlib.import_module(f"botschool.{module}")
    new = importlib.import_module("botschool.course." + module.removeprefix("course_"))
    assert getattr(old, name) is getattr(new, name)
    public = {name for name in vars(new) if not name.startswith("_")}
    assert public <= vars(old).keys()
