"""Register our own problems with Gymnasium and PettingZoo."""

from botschool.problems import faces  # noqa: F401
