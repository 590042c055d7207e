"""The evolved runners of data/genotypes: they run, and still do where physics are finer."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
pytestmark = pytest.mark.usefixtures("studies")
FILES = ["planarhopper", "planarwalker2d", "planarhalfcheetah"]


def evolved(file):
    """The robot that comes with botschool."""
    from planar_runs import Robot

    return Robot(file, np.load(ROOT / "data" / "genotypes" / f"{file}.npy"))


@pytest.mark.parametrize("file", FILES)
def test_they_run_ten_lengths_without_falling(file):
    robot = evolved(file)
    returns, upright = robot.ways(2_000_000, 50)
    assert (returns * robot.seconds > robot.runner.lengths).mean() >= 0.9
    assert upright.mean() >= 0.9


@pytest.mark.parametrize("file", FILES)
def test_the_gait_stays_with_half_the_substep(file):
    robot = evolved(file)
    coarse, fine = (robot.way(1, 0, finer, 300) for finer in (1, 2))
    assert fine == pytest.approx(coarse, rel=0.1)


@pytest.mark.parametrize("file", FILES)
def test_feet_leave_the_ground_and_come_back(file):
    for steps in evolved(file).gait(1).values():
        assert "01" in steps and "10" in steps
