"""Record the results of a run, and write its files (docs/specification.md, "Run files")."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool.errors import ANEW, FOLDER, FORCE, RESUME, SEED, BotschoolError
from botschool.evolution.algorithm import Stateful
from botschool.lock import locked
from botschool.output import cannot_write, remove_leftovers, save_bytes, save_npy

STAT = (
    "steps",
    "best fitness",
    "best post-evaluated",
    "best of generation",
    "average",
    "average parameter",
)


@dataclass(frozen=True)
class RunFiles:
    """The files of a run with a seed, in a folder."""

    folder: Path
    seed: int

    @property
    def stat(self) -> Path:
        """Return the stat file: flat float64, six numbers per generation, see STAT."""
        return self.folder / f"statS{self.seed}.npy"

    @property
    def best(self) -> Path:
        """Return the file of the genotype with the best fitness."""
        return self.folder / f"bestS{self.seed}.npy"

    @property
    def bestg(self) -> Path:
        """Return the file of the genotype with the best post-evaluation."""
        return self.folder / f"bestgS{self.seed}.npy"

    @property
    def fit(self) -> Path:
        """Return the fit file: one line of `key value` pairs."""
        return self.folder / f"S{self.seed}.fit"

    @property
    def fresh(self) -> Path:
        """Return the file of the best robot's returns in fresh episodes (fresh.py)."""
        return self.folder / f"freshS{self.seed}.txt"

    @property
    def checkpoint(self) -> Path:
        """Return the checkpoint, which --resume reads."""
        return self.folder / f"checkpointS{self.seed}.npz"

    @property
    def robot(self) -> Path:
        """Return the file of the tables of a robot of one's own (problems.robot)."""
        return self.folder / f"robotS{self.seed}.npz"

    @property
    def events(self) -> Path:
        """Return the folder of the TensorBoard event file."""
        return self.folder / f"tensorboardS{self.seed}"

    def kept(self, generation: int | str) -> Path:
        """Return the file of --keep-every with the best robot so far; "*" matches all of them."""
        return self.folder / f"bestgS{self.seed}G{generation}.npy"

    def populations(self, generation: int | str) -> Path:
        """Return the file of the populations after a generation (co-evolution); "*" matches all."""
        return self.folder / f"S{self.seed}G{generation}.npy"

    def fitness(self, generation: int | str) -> Path:
        """Return the file of their fitness (co-evolution); "*" matches all generations."""
        return self.folder / f"S{self.seed}FitG{generation}.npy"

    def all(self) -> list[Path]:
        """Return all of these files; "*" stands for a generation in a name."""
        named = [self.stat, self.best, self.bestg, self.fit, self.fresh]
        return [
            *named,
            self.checkpoint,
            self.robot,
            self.events,
            self.kept("*"),
            self.populations("*"),
            self.fitness("*"),
        ]

    def existing(self) -> list[Path]:
        """Return the files that exist."""
        return [path for file in self.all() for path in sorted(self.folder.glob(file.name))]


@contextmanager
def claimed(folder: Path, seeds: list[int], resume: bool, force: bool) -> Iterator[None]:
    """Make the folder ready for runs with these seeds, and lock it for them (and any between).

    Existing results are kept when resuming, removed with `force`, and an error otherwise. Runs that
    another process writes are an error, too.
    """
    first, last = min(seeds), max(seeds)
    which = f"seed {first}" if first == last else f"a seed from {first} to {last}"
    with ExitStack() as stack:
        try:
            folder.mkdir(parents=True, exist_ok=True)
            stack.enter_context(locked(folder, f"the run with {which}", first, last - first + 1))
            _claim(folder, seeds, resume, force)
        except OSError as error:
            raise cannot_write(folder, error.strerror or str(error)) from error
        yield


def _claim(folder: Path, seeds: list[int], resume: bool, force: bool) -> None:
    for seed in seeds:
        files = RunFiles(folder, seed)
        existing = files.existing()
        if not existing or (resume and files.checkpoint.exists()):
            continue
        if resume:
            raise BotschoolError(
                f"{existing[0]} exists but {files.checkpoint} does not, so the run cannot be "
                "resumed: use another seed",
                SEED,
                " or folder",
                FOLDER,
                *ANEW,
            )
        if not force:
            raise BotschoolError(
                f"{existing[0]} exists: use ",
                RESUME,
                " to continue that run, another seed",
                SEED,
                " or folder",
                FOLDER,
                " to keep it, or ",
                FORCE,
                " to overwrite it.",
            )
    for files in [RunFiles(folder, seed) for seed in seeds]:
        for path in files.all():
            remove_leftovers(path)
        for path in files.existing() if force else []:
            shutil.rmtree(path) if path.is_dir() else path.unlink()


class Record(Stateful):
    """Steps, curves and best genotypes of a run."""

    evolves = ("steps", "best", "best_fitness", "bestg", "bestg_fitness")

    columns: tuple[str, ...] = STAT
    """Names of the values of each generation; the stat file holds the first six."""

    def __init__(self) -> None:
        self.steps = 0
        self.best, self.best_fitness = np.zeros(0), -np.inf
        self.bestg, self.bestg_fitness = np.zeros(0), -np.inf
        self._rows: list[tuple[float, ...]] = []

    @property
    def generation(self) -> int:
        """Return the number of generations done."""
        return len(self._rows)

    def offer(self, saved: np.ndarray, fitness: float, post_evaluated: float) -> None:
        """Take the best genotype of a generation, in the form of files."""
        if fitness > self.best_fitness:
            self.best, self.best_fitness = saved, fitness
        if post_evaluated > self.bestg_fitness:
            self.bestg, self.bestg_fitness = saved, post_evaluated

    def add(self, best: float, average: float, parameter: float) -> None:
        """End a generation."""
        self._rows.append(
            (self.steps, self.best_fitness, self.bestg_fitness, best, average, parameter)
        )

    @property
    def last(self) -> dict[str, float]:
        """Return the newest row, by the names of its columns."""
        return dict(zip(self.columns, self._rows[-1], strict=True))

    def rows(self, first: int = 0) -> np.ndarray:
        """Return rows from generation `first`, shape (generations, columns)."""
        return np.array(self._rows[first:], dtype=np.float64).reshape(-1, len(self.columns))

    def write(self, files: RunFiles) -> None:
        """Write all run files but the checkpoint, each atomically."""
        save_npy(files.stat, self.rows()[:, : len(STAT)].ravel())
        for path, genotype in ((files.best, self.best), (files.bestg, self.bestg)):
            if genotype.size:
                save_npy(path, genotype)
        values = {
            "seed": files.seed,
            "gen": self.generation,
            "steps": self.steps,
            "bestfit": self.best_fitness,
            "bestgfit": self.bestg_fitness,
        }
        line = " ".join(f"{key} {value}" for key, value in values.items())
        save_bytes(files.fit, f"{line}\n".encode())

    def state(self) -> dict[str, np.ndarray]:
        """Return the arrays that a checkpoint needs."""
        return super().state() | {"stat": self.rows()}

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Restore a state that state() returned. Raises ValueError."""
        steps = state["stat"][:, 0]
        if not ((steps >= 0) & (steps <= state["steps"])).all() or (np.diff(steps) < 0).any():
            raise ValueError("the first column is not the steps so far")
        super().restore(state)
        self._rows = [tuple(row) for row in state["stat"].tolist()]
