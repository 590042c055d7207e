"""What a run has achieved, and the files that say so (FACTS.md section 2)."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool.output import save_bytes, save_npy

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
        """Flat float64, six numbers a generation, see STAT."""
        return self.folder / f"statS{self.seed}.npy"

    @property
    def best(self) -> Path:
        """The genotype with the best fitness."""
        return self.folder / f"bestS{self.seed}.npy"

    @property
    def bestg(self) -> Path:
        """The genotype with the best post-evaluation."""
        return self.folder / f"bestgS{self.seed}.npy"

    @property
    def fit(self) -> Path:
        """One line of `key value` pairs."""
        return self.folder / f"S{self.seed}.fit"

    @property
    def checkpoint(self) -> Path:
        """What --resume reads."""
        return self.folder / f"checkpointS{self.seed}.npz"

    @property
    def events(self) -> Path:
        """Folder of the TensorBoard event file."""
        return self.folder / f"tensorboardS{self.seed}"

    def all(self) -> list[Path]:
        """Every one of them."""
        return [self.stat, self.best, self.bestg, self.fit, self.checkpoint, self.events]

    def existing(self) -> list[Path]:
        """Those that exist."""
        return [file for file in self.all() if file.exists()]


class Record:
    """Steps, curves and best genotypes of a run."""

    def __init__(self) -> None:
        self.steps = 0
        self.best, self.best_fitness = np.zeros(0), -np.inf
        self.bestg, self.bestg_fitness = np.zeros(0), -np.inf
        self._rows: list[tuple[float, ...]] = []

    @property
    def generation(self) -> int:
        """Generations done."""
        return len(self._rows)

    def offer(self, saved: np.ndarray, fitness: float, post_evaluated: float) -> None:
        """The best genotype of a generation, as it would be saved."""
        if fitness > self.best_fitness:
            self.best, self.best_fitness = saved, fitness
        if post_evaluated > self.bestg_fitness:
            self.bestg, self.bestg_fitness = saved, post_evaluated

    def add(self, best: float, average: float, parameter: float) -> None:
        """Ends a generation."""
        self._rows.append(
            (self.steps, self.best_fitness, self.bestg_fitness, best, average, parameter)
        )

    @property
    def last(self) -> dict[str, float]:
        """The newest row of the stat file, by the names in STAT."""
        return dict(zip(STAT, self._rows[-1], strict=True))

    def rows(self, first: int = 0) -> np.ndarray:
        """Rows of the stat file from generation `first`, shape (generations, 6)."""
        return np.array(self._rows[first:], dtype=np.float64).reshape(-1, len(STAT))

    def write(self, files: RunFiles) -> None:
        """Writes all run files but the checkpoint, each atomically."""
        save_npy(files.stat, self.rows().ravel())
        if self.generation:
            save_npy(files.best, self.best)
            save_npy(files.bestg, self.bestg)
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
        """What a checkpoint needs."""
        return {
            "steps": np.array(self.steps),
            "stat": self.rows(),
            "best": self.best,
            "best_fitness": np.array(self.best_fitness),
            "bestg": self.bestg,
            "bestg_fitness": np.array(self.bestg_fitness),
        }

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """The reverse of state()."""
        self.steps = int(state["steps"])
        self._rows = [tuple(row) for row in state["stat"].tolist()]
        self.best, self.best_fitness = state["best"], float(state["best_fitness"])
        self.bestg, self.bestg_fitness = state["bestg"], float(state["bestg_fitness"])
