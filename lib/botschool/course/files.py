"""Find the files of the course."""

from __future__ import annotations

from pathlib import Path

from botschool.paths import course_root


def experiment_file(name: str) -> Path:
    """Return the path of an experiment file, such as "acrobot.ini". Raises BotschoolError."""
    return course_root() / "data" / "experiments" / name


def genotype_file(name: str) -> Path:
    """Return the path of a pre-evolved robot, such as "bodybrainS1.npy". Raises BotschoolError."""
    return course_root() / "data" / "genotypes" / name


def robot_file(name: str) -> Path:
    """Return the path of a robot's body, such as "balance_bot.urdf". Raises BotschoolError."""
    return course_root() / "data" / "robots" / name


def episode_file(name: str) -> Path:
    """Return the path of recorded episodes, such as "locomotors.npz". Raises BotschoolError."""
    return course_root() / "data" / "episodes" / name
