"""The Gymnasium and PettingZoo faces of our own problems; importing this registers their ids."""

from botschool.problems import faces  # noqa: F401
