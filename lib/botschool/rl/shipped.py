"""Find the trained agents that come with botschool: data/agents, installed with the package.

ppo/CartPole-v1/config.yaml     how the agent was trained
ppo/CartPole-v1/weights.npz     its weights, nothing else (weights.py)
agents.json                     its returns in new episodes, and the command that trained it

The README.md there shows the same table.
"""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from pathlib import Path

from botschool.paths import material
from botschool.problems.native import gym_id
from botschool.rl.folder import name_of
from botschool.rl.weights import WEIGHTS

TABLE = "agents.json"


@dataclass(frozen=True)
class Trained:
    """A trained agent with its measured returns."""

    algo: str
    env: str
    steps: int
    """Steps of the training."""
    mean: float
    """Mean of the returns in new episodes."""
    deviation: float
    episodes: int
    command: str
    """The command that trained the agent."""
    seconds: int
    """Seconds of one processor core that the training took."""
    path: Path
    """File of the weights."""

    @property
    def told(self) -> str:
        """Return the agent's measured return as text."""
        return f"{self.mean:.1f} +- {self.deviation:.1f} in {self.episodes} new episodes"


def folder() -> Path:
    """Return the folder of the agents."""
    return material() / "data" / "agents"


def agents() -> list[Trained]:
    """Return all agents in the order of the table; none if they are not installed."""
    path = folder() / TABLE
    if not path.is_file():
        return []
    rows = json.loads(path.read_text(encoding="utf-8"))
    return [Trained(**row, path=place(folder(), row["algo"], row["env"])) for row in rows]


def place(base: Path, algo: str, env: str) -> Path:
    """Return the path of an agent's weights in the folder `base`."""
    return base / algo / name_of(env) / WEIGHTS


def find(algo: str, env: str) -> Trained | None:
    """Return the agent of an algorithm on an environment, None if there is none."""
    wanted = algo, gym_id(env)
    return next((each for each in agents() if (each.algo, gym_id(each.env)) == wanted), None)


def nearest(algo: str, env: str) -> Trained | None:
    """Return an agent of the same environment, by any algorithm and version, else of the same body.

    Several: the one of the same algorithm. None if there is none.
    """
    alike = [each for each in agents() if _body(each.env) == _body(env)]
    same = [each for each in alike if _without_version(each.env) == _without_version(env)]
    return max(same or alike, key=lambda each: each.algo == algo, default=None)


def _without_version(env: str) -> str:
    return re.sub(r"^.*[/:]|-v\d+$", "", env)


def _body(env: str) -> str:
    """Return "ant" for botschool/SpatialAnt-v5, AntBulletEnv-v0 and Ant-v5."""
    return re.sub("Spatial|Planar|(Bullet)?Env$", "", _without_version(env)).lower()
