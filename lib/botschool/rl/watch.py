"""Watch trained agents: episodes with numbers, in a window or as a film; and list trainings."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

from botschool.errors import BotschoolError
from botschool.rl import shipped
from botschool.rl.beside import Beside, Evolved
from botschool.rl.folder import RunFolder, find_runs, run_of, runs_of
from botschool.rl.player import Player
from botschool.rl.settings import check_algorithm
from botschool.rl.weights import WEIGHTS
from botschool.terminal import has_display, readable

if TYPE_CHECKING:
    from rich.table import Table

OURS = ", or watch one that comes with botschool (`botschool rl list --ours`)"


@dataclass(frozen=True)
class Asked:
    """The options of enjoy and video that name an agent."""

    run: Path | None
    """Folder of a training, or a model file in it."""
    folder: Path
    """Folder of trainings; without `run` and `algo` the training that started last."""
    env: str | None = None
    """Another environment for the agent; with `algo` the environment of its training."""
    algo: str | None = None
    number: int = 0
    """Number of the training, with `algo`; 0 is the newest."""
    last: bool = False
    """Use the last model instead of the best one."""
    policy: str | None = None
    """The agent's policy as module:Class, if it is the user's own."""
    beside: Path | None = None
    """Experiment file of an evolved robot to show beside it."""
    genotype: Path | None = None
    """With `beside`: the robot."""

    def shown(self, seed: int) -> Player | Beside:
        """Return the agent, or both that are to be shown. Raises BotschoolError."""
        if (self.beside is None) != (self.genotype is None):
            raise BotschoolError(
                "--beside FILE.ini and -g ROBOT.npy show an evolved robot together: give both."
            )
        player = self.player(seed)
        if self.beside is None:
            return player
        return Beside(player, Evolved(self.beside, self.genotype, player))

    def player(self, seed: int) -> Player:
        """Return the player of this agent. Raises BotschoolError."""
        if self.algo is None:
            model = model_of(self.run, self.folder, self.last)
            return Player(model, seed, self.env, self.policy)
        if self.env is None or self.run is not None:
            raise BotschoolError(
                "--algo needs --env to name a training, as in --algo ppo --env CartPole-v1; "
                "leave it out if you name the training's folder."
            )
        return Player(self._trained(), seed, policy=self.policy)

    def _trained(self) -> Path:
        """Return the model of that algorithm on that environment: the user's own, else ours."""
        algo = check_algorithm(self.algo)
        if not self.number and not runs_of(self.folder, algo, self.env):
            ours, which = shipped.find(algo, self.env), "the one that comes with botschool"
            if ours is None:
                ours = shipped.nearest(algo, self.env)
                which = f"the nearest to {algo} on {self.env} that comes with botschool"
            if ours is not None:
                print(
                    f"agent: {which}, because {self.folder} has none: "
                    f"{ours.algo} on {ours.env}, {ours.steps} steps ({ours.told})"
                )
                return ours.path
        chosen = run_of(self.folder, algo, self.env, self.number, OURS)
        print(f"agent: {chosen.path}")
        return chosen.last if self.last else chosen.best


def model_of(run: Path | None, folder: Path, last: bool) -> Path:
    """Return the model file that a user means: a file, or the best or last model of a folder.

    Without `run`, choose the training in `folder` that started last. Raises BotschoolError.
    """
    if run is not None and run.suffix in (".zip", ".npz"):
        return run
    if run is None:
        runs = find_runs(folder)
        if not runs:
            raise BotschoolError(
                f"There are no trainings in {folder}: train an agent with `botschool rl train "
                f"--algo ppo --env CartPole-v1`, name the folder of one{OURS}."
            )
        chosen = max(runs, key=lambda run: run.config.stat().st_mtime)
        print(f"agent: {chosen.path}")
        return chosen.last if last else chosen.best
    if (run / WEIGHTS).is_file():
        return run / WEIGHTS
    return RunFolder(run).last if last else RunFolder(run).best


def enjoy_command(asked: Asked, episodes: int, seed: int, render: str | None) -> None:
    """Run `botschool rl enjoy`."""
    if render == "human" and not has_display():
        raise BotschoolError(
            "There is no display for a window: add --render none, or make a film with "
            "`botschool rl video`."
        )
    if render not in (None, "human", "none"):
        raise BotschoolError(f"--render is '{render}', but must be human or none.")
    player = asked.shown(seed)
    if render == "human" or (render is None and has_display()):
        from botschool.render.window import show

        show(player.frames(episodes), player.fps, f"botschool: {player.env}")
    else:
        player.play(episodes)
    player.print_summary()


def video_command(
    asked: Asked, episodes: int, seed: int, output: Path, steps: int | None = None
) -> None:
    """Run `botschool rl video`; steps: maximum number of pictures."""
    from botschool.output import check_output
    from botschool.render.video import VIDEO_SUFFIXES, write_video

    check_output(output, VIDEO_SUFFIXES)
    player = asked.shown(seed)
    write_video(output, islice(player.frames(episodes), steps), player.fps)
    print(f"video: {output}")
    player.print_summary()


def list_command(folder: Path) -> None:
    """Run `botschool rl list`: print a table of the trainings in a folder."""
    runs = find_runs(folder)
    if not runs:
        raise BotschoolError(
            f"There are no trainings in {folder}: start one with `botschool rl train --algo ppo "
            "--env CartPole-v1`, or name another folder."
        )
    table = _table(f"trainings in {folder}", "run", ("seed", "steps", "best", "last"))
    table.add_column("changed", overflow="fold")
    for run in runs:
        name = run.path.relative_to(folder) if run.path != folder else run.path
        table.add_row(str(name), *_row(run))
    _show(table)


def list_ours() -> None:
    """Run `botschool rl list --ours`: print the trained agents that come with botschool."""
    table = _table(
        "trained agents that come with botschool", "agent", ("steps", "return", "sd", "episodes")
    )
    for each in shipped.agents():
        row = (str(each.steps), f"{each.mean:.1f}", f"{each.deviation:.1f}", str(each.episodes))
        table.add_row(f"--algo {each.algo} --env {each.env}", *row)
    _show(table)


def _table(title: str, first: str, numbers: Sequence[str]) -> Table:
    from rich import box
    from rich.table import Table

    table = Table(title=title, box=box.SIMPLE, title_justify="left")
    table.add_column(first, no_wrap=True)
    for column in numbers:
        table.add_column(column, justify="right", no_wrap=True)
    return table


def _show(table: Table) -> None:
    from botschool.console import Console

    Console(highlight=False, width=None if sys.stdout.isatty() else 120).print(table)


def _row(run: RunFolder) -> list[str]:
    try:
        settings = run.settings()
    except BotschoolError:
        return ["damaged"]
    row = [str(settings.seed)]
    try:
        found = run.evaluations()
        steps, best, last = str(found.steps[-1]), readable(found.best), readable(found.last)
    except BotschoolError:
        steps = best = last = "-"
    return [*row, steps, best, last, settings.variant]
