"""`botschool.train`: the trainings of `botschool rl train`, from a program."""

from __future__ import annotations

import io
import sys
from contextlib import redirect_stdout
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from botschool.evolution import fresh
from botschool.interface.showing import Folder, bars, interruptible
from botschool.interface.sources import check_words, in_python_words, seeded, whole
from botschool.rl.folder import RunFolder

HISTORY = np.dtype([("steps", np.int64), ("mean", float), ("sd", float), ("length", float)])
"""Columns of `Agent.history`, one row a post-evaluation: steps of training before it, mean and
standard deviation of the returns, mean length of an episode.
"""


def train(
    env: str,
    *,
    seed: int = 1,
    algo: str = "ppo",
    steps: int | None = None,
    folder: str | PathLike[str] | None = None,
    workers: int = 1,
    engine: str = "auto",
    policy: str | None = None,
    envs: int | None = None,
    wrappers: str = "",
    reward: str = "",
    ends: str = "",
    physics: str = "",
    progress: bool | None = None,
    **hyperparameters: Any,
) -> Agent:
    """Train an agent by reinforcement learning and return it.

    env: a problem's name. algo: ppo, a2c, trpo, ars, sac, td3, ddpg, tqc, her, dqn or qrdqn. PPO on
    a native problem runs in C++; Stable-Baselines3 does the others, which a line on stderr says.
    steps: of training; None for the problem's default, as for all hyperparameters (learning_rate,
    gamma ...). folder: of trainings, each of which gets a new folder in it; without one the files
    go when the agent goes. workers: threads of the native engine. policy, envs, wrappers: as in
    `botschool rl train`. reward, ends, physics: of a native problem, as in experiment
    files. Ctrl-C keeps what was trained and raises KeyboardInterrupt. Raises BotschoolError.
    """
    from botschool.rl.model import choose
    from botschool.rl.native.problem import native_problem
    from botschool.rl.training import learn, reached

    if native_problem(f"botschool/{env}"):
        env = f"botschool/{env}"
    with in_python_words(), interruptible() as stopping:
        check_words(hyperparameters)
        seed, workers = whole("seed", seed, 0), whole("workers", workers)
        settings = choose(
            algo,
            env,
            policy,
            hyperparameters,
            envs,
            steps,
            seed,
            wrappers=wrappers,
            engine=engine,
            own={"reward": reward, "ends": ends, "physics": physics},
        )
        if settings.engine != "native" and engine != "sb3":
            print(
                f"note: Stable-Baselines3 trains {settings.env} by {settings.algo}; the native "
                "engine has only ppo, for native problems.",
                file=sys.stderr,
            )
        place = Folder(folder)
        with bars(progress) as shown:

            def report(done: int, found: Any) -> None:
                if shown:
                    shown.show(seed, done / settings.steps, done, 3, reached(found))

            run, found = learn(settings, place.path, report, stopping=stopping, threads=workers)
        if found.steps[-1] < settings.steps:
            where = f"is saved in {run.path}" if folder else "is dropped"
            raise KeyboardInterrupt(f"The training was stopped and {where}.")
    return Agent(run, place.owner)


class Agent:
    """A trained agent with its files."""

    def __init__(self, run: RunFolder, owner: Any = None) -> None:
        self.folder = run.path
        """Where the training's files are. A temporary folder goes with its agent."""
        self.settings = run.settings()
        self._run, self._owner = run, owner

    @cached_property
    def history(self) -> np.ndarray:
        """The post-evaluations: a structured array with the columns of HISTORY."""
        found = self._run.evaluations()
        history = np.empty(len(found.steps), HISTORY)
        history["steps"], history["length"] = found.steps, found.lengths.mean(axis=1)
        history["mean"], history["sd"] = found.returns.mean(axis=1), found.returns.std(axis=1)
        return history

    @cached_property
    def returns(self) -> np.ndarray:
        """The best model's returns in 20 fresh episodes, which had no part in choosing it."""
        return self.play(fresh.EPISODES)

    @property
    def fitness(self) -> float:
        """Return the number to report: the mean of `returns`."""
        return float(self.returns.mean())

    def play(self, episodes: int = 20, seed: int | None = None) -> np.ndarray:
        """Return the best model's return in each of these episodes, float64, (episodes,).

        Without exploration. seed: of the first episode; by default they are fresh ones. Raises
        BotschoolError.
        """
        player, episodes = self._player(seed), whole("episodes", episodes)
        with in_python_words(), redirect_stdout(io.StringIO()):
            player.play(episodes)
        return np.array(player.returns)

    def film(self, path: str | PathLike[str], episodes: int = 1, seed: int | None = None) -> Path:
        """Write a film (.mp4, .webm, .gif) of the episodes that `play` plays; return its path."""
        from botschool.render.video import write_video

        player, episodes = self._player(seed), whole("episodes", episodes)
        with in_python_words(), redirect_stdout(io.StringIO()):
            write_video(Path(path), player.frames(episodes), player.fps)
        return Path(path)

    def act(self, observations: Any) -> np.ndarray:
        """Return the most likely action for each observation, shape (n, ...)."""
        return self._player(None).agent.act(np.asarray(observations))[0]

    def _player(self, seed: int | None) -> Any:
        from botschool.rl.player import NEW_EPISODES_SEED, Player

        start = self.settings.seed if seed is None else seeded(seed) - NEW_EPISODES_SEED
        with in_python_words():
            return Player(self._run.best, start)

    def __repr__(self) -> str:
        last = self.history[-1]
        return (
            f"Agent({self.settings.algo} on {self.settings.env}, seed {self.settings.seed}: "
            f"{fresh.told(self.returns)} in {len(self.returns)} fresh episodes, after "
            f"{last['steps']:,} steps)"
        )
