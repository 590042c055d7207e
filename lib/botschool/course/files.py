"""Where the files lie that come with the course."""

from __future__ import annotations

from pathlib import Path

from botschool.paths import course_root


def experiment_file(name: str) -> Path:
    """An experiment file of the course, as "acrobot.ini". Raises BotschoolError."""
    return course_root() / "data" / "experiments" / name


def genotype_file(name: str) -> Path:
    """A pre-evolved robot of the course, as "bodybrainS1.npy". Raises BotschoolError."""
    return course_root() / "data" / "genotypes" / name


def robot_file(name: str) -> Path:
    """A robot's description, as "balance_bot.urdf". Raises BotschoolError."""
    return course_root() / "data" / "robots" / name


def episode_file(name: str) -> Path:
    """Recorded episodes of the course, as "locomotors.npz". Raises BotschoolError."""
    return course_root() / "data" / "episodes" / name
