"""The trained agents that come with botschool: data/agents, installed with the package.

    ppo/CartPole-v1/config.yaml     how it was trained
    ppo/CartPole-v1/weights.npz     its weights, no more (weights.py)
    agents.json                     what each has reached in new episodes, and how it was made

Their README.md is the same table for readers.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from botschool.paths import material
from botschool.rl.folder import name_of
from botschool.rl.weights import WEIGHTS

TABLE = "agents.json"


@dataclass(frozen=True)
class Trained:
    """An agent and what was measured of it."""

    algo: str
    env: str
    steps: int
    """Of its training."""
    mean: float
    """Of the returns in new episodes."""
    deviation: float
    episodes: int
    command: str
    """That trained it."""
    seconds: int
    """That its training took, of one processor core."""
    path: Path
    """Of its weights."""

    @property
    def told(self) -> str:
        """What it has reached."""
        return f"{self.mean:.1f} +- {self.deviation:.1f} in {self.episodes} new episodes"


def folder() -> Path:
    """Where they are."""
    return material() / "data" / "agents"


def agents() -> list[Trained]:
    """All of them, in the order of the table; none where they are not installed."""
    path = folder() / TABLE
    if not path.is_file():
        return []
    rows = json.loads(path.read_text(encoding="utf-8"))
    return [Trained(**row, path=place(folder(), row["algo"], row["env"])) for row in rows]


def place(base: Path, algo: str, env: str) -> Path:
    """Where the weights of an agent are in the folder of all."""
    return base / algo / name_of(env) / WEIGHTS


def find(algo: str, env: str) -> Trained | None:
    """The agent of an algorithm on an environment, if one comes along."""
    return next((each for each in agents() if (each.algo, each.env) == (algo, env)), None)
