"""Runs as programs see them: curves with named columns, the best robot, films, pages, plots."""

from __future__ import annotations

import shutil
from collections.abc import Sequence
from functools import cached_property
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from botschool import problems
from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution import fresh
from botschool.evolution.record import RunFiles
from botschool.interface.problem import Problem
from botschool.interface.sources import in_python_words, seeded
from botschool.output import check_output
from botschool.seeds import NEW_EPISODES_SEED

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HISTORY = np.dtype(
    [
        ("generation", np.int64),
        ("steps", np.int64),
        ("best", float),
        ("post_evaluated", float),
        ("generation_best", float),
        ("generation_mean", float),
        ("parameter", float),
    ]
)
"""Columns of `Run.history`: the generation, the steps of the run so far, the best fitness and the
best post-evaluated fitness so far, best and mean fitness of the generation, and the mean absolute
parameter.
"""


class Run:
    """An evolutionary run with its files: of `evolve`, or of a folder that was loaded."""

    def __init__(
        self, experiment: Experiment | None, seed: int, folder: Path, owner: Any = None
    ) -> None:
        """Make the run of a folder; owner: keeps a temporary folder until the run goes."""
        self.seed = seed
        self.folder = folder
        """Where the run's files are. A temporary folder goes with its runs."""
        self._experiment, self._owner = experiment, owner
        self._files = RunFiles(folder, seed)

    @property
    def experiment(self) -> Experiment:
        """Return the experiment. Raises BotschoolError if the folder does not tell it."""
        if self._experiment is None:
            raise BotschoolError(
                f"{self.folder} has no checkpoint of seed {self.seed}, so its experiment is "
                "unknown: name it, as in load(FOLDER, 'FILE.ini')."
            )
        return self._experiment

    @cached_property
    def problem(self) -> Problem:
        """The problem that the run evolved on. Raises BotschoolError."""
        problem = Problem(self.experiment)
        with in_python_words():
            problem.check(self._files.bestg)
        return problem

    @cached_property
    def history(self) -> np.ndarray:
        """The curves: a structured array, one row a generation, with the columns of HISTORY.

        `run.history["steps"]` is a column. Raises BotschoolError if no generation is saved.
        """
        from botschool.analysis.runs import read_stat

        rows = read_stat(self._files.stat)
        history = np.empty(len(rows), HISTORY)
        history["generation"] = np.arange(1, len(rows) + 1)
        for name, column in zip(HISTORY.names[1:], rows.T, strict=True):
            history[name] = column
        return history

    @cached_property
    def best(self) -> np.ndarray:
        """The genotype with the best post-evaluation, float64. With normalize = 1 the means and
        deviations of the observations follow the parameters. Of two sides: both, the first first.
        """
        from botschool.render.watch import read_genotype

        return read_genotype(self._files.bestg)

    @cached_property
    def returns(self) -> np.ndarray:
        """The best robot's returns in fresh episodes, which had no part in choosing it: float64,
        (episodes,), at least 20.
        """
        measured = fresh.read(self._files.fresh)
        return self.play(fresh.EPISODES) if measured is None else measured

    @property
    def fitness(self) -> float:
        """Return the number to report: the mean of `returns`. A run of two sides has none; its
        number is the newest mean against all opponents.
        """
        if self._experiment is not None and self.experiment.competitive:
            return float(self.history["generation_best"][-1])
        return float(self.returns.mean())

    def play(self, episodes: int = 20, seed: int | None = None) -> np.ndarray:
        """Return the best robot's return in each of these episodes, float64, (episodes,).

        seed: of the episodes; by default they are fresh ones, and the first 20 are `returns`.
        Raises BotschoolError.
        """
        if self.experiment.competitive:
            raise BotschoolError("Two sides evolved here, so a robot alone cannot play.")
        place = self.seed + NEW_EPISODES_SEED if seed is None else seeded(seed)
        return self.problem.returns(self.best, place, episodes)

    def film(self, path: str | PathLike[str], episodes: int = 1, seed: int | None = None) -> Path:
        """Write a film (.mp4, .webm, .gif) of the best robot in the episodes that `play` plays.

        Return its path. Raises BotschoolError.
        """
        place = self.seed + NEW_EPISODES_SEED if seed is None else seeded(seed)
        return self.problem.film(self.best, path, place, episodes)

    def page(self, path: str | PathLike[str] | None = None) -> Path:
        """Write a page (curves, settings, the best robot of a native problem); return its path.

        By default it is pageSS.html in the run's folder, or in the current one if that is a
        temporary one. Raises BotschoolError.
        """
        from botschool.analysis.run_page import write_page

        with in_python_words():
            if path is not None:
                check_output(Path(path), (".html",))
            made = write_page(self.experiment, self.seed, self.folder, self.problem.native)
        if path is None and self._owner is None:
            return made
        return Path(shutil.move(made, Path(made.name if path is None else path)))

    def act(self, observation: Any) -> np.ndarray | int:
        """Return the best robot's action for an observation: an index, or float32, (actuators,).

        A network with a memory remembers what it saw: `reset()` begins an episode.
        """
        return self._policy.act(np.asarray(observation))

    def reset(self) -> None:
        """Let the best robot forget what it saw: an episode begins."""
        self._policy.reset(self.seed, 0)

    @cached_property
    def _policy(self) -> Any:
        policy = problems.of(self.experiment).policy(self.experiment.policy)
        policy.load(*policy.split(self.best))
        policy.reset(self.seed, 0)
        return policy

    def export(self, path: str | PathLike[str]) -> Path:
        """Write the best robot's controller for other tools; return the path.

        The ending says what: .py needs NumPy alone, .h is C without libraries, .onnx and .pt
        (TorchScript) take the memory as further inputs and give it as further outputs. None has
        action noise. Raises BotschoolError.
        """
        from botschool.interface.controller import Controller
        from botschool.interface.export import export

        controller = Controller(self._policy, *self._policy.split(self.best))
        return export(
            controller, Path(path), f"{self.experiment.exp.environment}, seed {self.seed}"
        )

    def plot(self, path: str | PathLike[str] | None = None) -> Figure | Path:
        """Draw the curves; see `Runs.plot`."""
        return Runs([self]).plot(path)

    def frame(self) -> Any:
        """Return the history as a pandas.DataFrame, indexed by generation; needs pandas."""
        return Runs([self]).frame().drop(columns="seed").set_index("generation")

    def __repr__(self) -> str:
        name = f"{self._experiment.exp.environment}, " if self._experiment else ""
        try:
            steps = f"{self.history['steps'][-1]:,} steps"
            if self._experiment is None or self._experiment.competitive:
                return f"Run({name}seed {self.seed}, {steps})"
            told = f"{fresh.told(self.returns)} in {len(self.returns)} fresh episodes"
        except BotschoolError:  # no generation yet
            return f"Run({name}seed {self.seed})"
        return f"Run({name}seed {self.seed}: {told}, after {steps})"


class Runs(Sequence[Run]):
    """Several runs of one experiment, by the order of their seeds: a sequence."""

    def __init__(self, runs: Sequence[Run]) -> None:
        self._runs = list(runs)

    def __len__(self) -> int:
        return len(self._runs)

    def __getitem__(self, index):
        """Return a run, or several for a slice."""
        return Runs(self._runs[index]) if isinstance(index, slice) else self._runs[index]

    @property
    def seeds(self) -> list[int]:
        """Return the seeds."""
        return [run.seed for run in self]

    @property
    def fitness(self) -> np.ndarray:
        """Return the number to report of each run, float64, (runs,): see `Run.fitness`."""
        return np.array([run.fitness for run in self])

    @property
    def history(self) -> np.ndarray:
        """Return the histories of all runs, one after another, with a column `seed` before them."""
        dtype = np.dtype([("seed", np.int64), *HISTORY.descr])
        parts = [np.empty(len(run.history), dtype) for run in self]
        for part, run in zip(parts, self, strict=True):
            part["seed"] = run.seed
            for name in HISTORY.names:
                part[name] = run.history[name]
        return np.concatenate(parts)

    def frame(self) -> Any:
        """Return `history` as a pandas.DataFrame. Raises BotschoolError without pandas."""
        try:
            import pandas
        except ImportError:
            raise BotschoolError("This needs pandas: pip install pandas.") from None
        return pandas.DataFrame(self.history)

    def summary(self) -> dict[str, float]:
        """Return n, mean, low and high (ends of the mean's 95 % interval, by Student's t), sd
        (n - 1), median, min and max of `fitness`.
        """
        values = self.fitness
        mean, half = float(values.mean()), fresh.half_width(values)
        return {
            "n": len(values),
            "mean": mean,
            "low": mean - half,
            "high": mean + half,
            "sd": float(values.std(ddof=1)) if len(values) > 1 else np.nan,
            "median": float(np.median(values)),
            "min": float(values.min()),
            "max": float(values.max()),
        }

    def plot(self, path: str | PathLike[str] | None = None) -> Figure | Path:
        """Draw fitness against steps: curves of one run, mean and band of several.

        Return a matplotlib Figure, which notebooks show; with a path (.png, .svg, .pdf) write it
        and return the path. Raises BotschoolError.
        """
        from botschool.analysis.figure import new_figure
        from botschool.analysis.plots import Curves, draw_stat

        curves = Curves(
            {run.seed: np.stack([run.history[n].astype(float) for n in HISTORY.names[1:]], axis=1)
             for run in self}
        )  # fmt: skip
        known = self[0]._experiment
        if known is not None and not known.competitive:
            curves.fresh = {run.seed: run.returns for run in self}
        name = known.exp.environment if known else self[0].folder.name
        output = None if path is None else Path(path)
        with in_python_words(), new_figure(output, shown=False) as figure:
            draw_stat(figure, {name: curves}, {})
        return output or figure

    def __repr__(self) -> str:
        lines = [f"{len(self)} run{'s' * (len(self) > 1)}:", *map(repr, self)]
        if len(self) > 1 and self[0]._experiment is not None:
            lines.append(f"mean of the runs: {fresh.told(self.fitness)} (95 % interval)")
        return "\n  ".join(lines)
