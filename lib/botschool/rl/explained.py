"""Say what each hyperparameter of reinforcement learning does, and where it matters."""

from __future__ import annotations

from importlib.resources import files

import yaml

TRAINING, ROLLOUTS, REPLAY = "all", "PPO", "SAC"
"""Groups: every algorithm; those that learn from rollouts; those that keep old steps."""
_GROUPS = yaml.safe_load(files("botschool.rl").joinpath("explained.yaml").read_text("utf-8"))
OF: dict[str, str] = {name: group["of"] for name, group in _GROUPS.items()}
"""Group -> the algorithms in it."""
EXPLAINED: list[tuple[str, ...]] = [
    (name, *row) for name, group in _GROUPS.items() for row in group["rows"]
]
"""Group, hyperparameter, default, what it does, where it matters."""
