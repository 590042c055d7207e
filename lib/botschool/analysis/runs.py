"""Read the files of runs in a folder."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from botschool.errors import BotschoolError, listed
from botschool.evolution import checkpoint, fresh
from botschool.evolution.record import RunFiles
from botschool.npy import NotNumbers, opened, read_numbers

STEPS, BEST, BEST_POST, GENERATION_BEST, GENERATION_AVERAGE, PARAMETER_SIZE = range(6)
"""Columns of a stat file."""

_RUN_FILE = re.compile(
    r"(?:(?P<kind>bestg|best|stat)S?(?P<seed>\d+)\.npy|S?(?P<fit>\d+)\.fit|freshS(?P<fresh>\d+)\.txt)"
)

Warn = Callable[[str], None]


def warn(sentence: str) -> None:
    """Print a notice on stderr."""
    print(sentence, file=sys.stderr)


@dataclass
class Run:
    """The files of one run; a path is None if there is no such file."""

    seed: int
    folder: Path
    stat: Path | None = None
    best: Path | None = None
    """Best evaluated genotype."""
    bestg: Path | None = None
    """Best post-evaluated genotype."""
    fit: dict[str, float | str] = field(default_factory=dict)
    """Contents of the .fit file; empty without one."""
    fresh: np.ndarray | None = None
    """Returns of the best robot in fresh episodes; None if it was not measured."""

    def fitness(self) -> float:
        """Return the best robot's mean return in fresh episodes, or else its post-evaluation.

        Raises BotschoolError if no file holds either.
        """
        return self.best_post_evaluated() if self.fresh is None else float(self.fresh.mean())

    def doubt(self) -> str:
        """Return why `fitness` is too high, by luck: "" if it is not, or if no checkpoint tells."""
        episodes = checkpoint.post_episodes(self.folder, self.seed) if self.fresh is None else 0
        return f"post-evaluations of {episodes} episode{'s' * (episodes > 1)}" if episodes else ""

    def best_post_evaluated(self) -> float:
        """Return the best post-evaluated fitness, from the .fit file or else the stat file.

        Raises BotschoolError if neither file holds it.
        """
        fitness = float("nan")
        if self.fit:
            fitness = float(self.fit["bestgfit"])
        elif self.stat:
            fitness = float(read_stat(self.stat)[-1, BEST_POST])
        if not np.isfinite(fitness):
            raise BotschoolError(
                f"the run with seed {self.seed} in {self.folder} has no post-evaluated fitness "
                "yet: let it run for some generations more."
            )
        return fitness


def read_stat(path: Path | str) -> np.ndarray:
    """Return the learning curve of one run: float64, shape (generations, 6).

    STEPS to PARAMETER_SIZE number the columns. Raises BotschoolError if the file is missing or not
    a stat file; Python objects in it are never loaded.
    """
    path = Path(path)
    try:
        numbers = read_numbers(path)
    except FileNotFoundError as error:
        raise BotschoolError(
            f"there is no file {path}: name the statS<seed>.npy of a run, or its folder."
        ) from error
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read ({error.strerror or error}).") from error
    except NotNumbers as error:
        raise BotschoolError(f"{path} is not a stat file: {error}.") from error
    if numbers.ndim not in (1, 2):
        raise BotschoolError(f"{path} is not a stat file: it does not hold a row of plain numbers.")
    if numbers.size == 0:
        raise BotschoolError(f"{path} holds no generation yet: let the run go on for a while.")
    if numbers.size % 6 or (numbers.ndim == 2 and numbers.shape[1] != 6):
        raise BotschoolError(
            f"{path} is not a stat file, or is damaged: its {numbers.size} numbers are not 6 "
            "for each generation."
        )
    stat = numbers.astype(np.float64).reshape(-1, 6)
    steps = stat[:, STEPS]
    if not np.isfinite(steps).all() or steps[0] < 0 or (np.diff(steps) < 0).any():
        raise BotschoolError(
            f"{path} is not a stat file: the first of every 6 numbers should be the steps so "
            "far, which only grow."
        )
    return stat


def read_fit(path: Path | str) -> dict[str, float | str]:
    """Return the `key value` pairs of a run's .fit file, numbers as float, including `bestgfit`.

    A part in brackets, such as `(42.0%)`, is left out. Raises BotschoolError if the file is missing
    or not a .fit file.
    """
    path = Path(path)
    try:
        with opened(path) as file:
            words = re.sub(r"\([^)]*\)", " ", file.read().decode()).split()
    except FileNotFoundError as error:
        raise BotschoolError(f"there is no file {path}: name the .fit file of a run.") from error
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read ({error.strerror or error}).") from error
    except UnicodeDecodeError as error:
        raise BotschoolError(f"{path} is not a .fit file: it is not a line of text.") from error
    pairs = {key: _number(value) for key, value in zip(words[::2], words[1::2], strict=False)}
    if len(words) % 2 or not isinstance(pairs.get("bestgfit"), float):
        raise BotschoolError(
            f"{path} is not a .fit file, or is damaged: it should be a line of 'key value' "
            "pairs with a number for bestgfit."
        )
    return pairs


def _number(word: str) -> float | str:
    try:
        return float(word)
    except ValueError:
        return word


def find_runs(folder: Path | str, warn: Warn = warn) -> list[Run]:
    """Return the runs whose files lie in a folder, by seed.

    The file names give the seed: `statS11.npy` (or `stat11.npy`) belongs to seed 11. An unreadable
    .fit file is left out after a call of `warn`. Raises BotschoolError if there is no such folder
    or no run in it.
    """
    folder = Path(folder)
    try:
        paths = sorted(folder.iterdir())
    except FileNotFoundError as error:
        raise BotschoolError(f"there is no folder {folder}: check its name.") from error
    except NotADirectoryError as error:
        raise BotschoolError(f"{folder} is not a stat file (.npy), and no folder.") from error
    except OSError as error:
        raise BotschoolError(f"{folder} cannot be read ({error.strerror or error}).") from error
    runs: dict[int, Run] = {}
    for path in paths:
        match = _RUN_FILE.fullmatch(path.name)
        if not match:
            continue
        seed = int(match["seed"] or match["fit"] or match["fresh"])
        run = runs.setdefault(seed, Run(seed, folder))
        if match["kind"]:
            setattr(run, match["kind"], path)
            continue
        try:
            if match["fresh"]:
                run.fresh = fresh.read(path)
            else:
                run.fit = read_fit(path)
        except BotschoolError as error:
            warn(f"skipped: {error}")
    if not runs:
        raise BotschoolError(
            f"there are no runs in {folder}: evolve some with `botschool es -f FILE.ini -s SEED`."
        )
    return [runs[seed] for seed in sorted(runs)]


def problem_of(folder: Path | str) -> str:
    """Return problem and algorithm, such as "PlanarHopper-v5, OpenAI-ES", from a checkpoint.

    Return "" if the folder holds no checkpoint that can be read.
    """
    exp = (told_by(folder) or {}).get("exp")
    return f"{exp['environment']}, {exp['algo']}" if exp else ""


def told_by(folder: Path | str) -> dict | None:
    """Return the experiment of a folder's runs, for config.from_dict; None if none tells it."""
    for path in sorted(Path(folder).glob("checkpointS*.npz")):
        try:
            with np.load(path, allow_pickle=False) as saved:
                found = json.loads(str(saved["botschool"]))["experiment"]
            assert found["exp"]["environment"] and found["exp"]["algo"]
            return found
        except Exception:  # a damaged file can fail in any way
            continue
    return None


def read_curves(folder: Path | str, warn: Warn = warn) -> dict[int, np.ndarray]:
    """Return the learning curves of all runs in a folder: seed -> (generations, 6), as `read_stat`.

    An unreadable stat file is left out after a call of `warn`. Raises BotschoolError if none is
    left.
    """
    curves = {}
    for run in find_runs(folder, warn):
        if run.stat is None:
            continue
        try:
            curves[run.seed] = read_stat(run.stat)
        except BotschoolError as error:
            warn(f"skipped: {error}")
    if not curves:
        raise BotschoolError(
            f"there is no readable stat file in {folder}: name a folder with statS<seed>.npy files."
        )
    return curves


def read_fitness(folder: Path | str, warn: Warn = warn) -> dict[int, float]:
    """Return the fitness of each run's best robot in a folder: seed -> mean return.

    It is the mean in fresh episodes; for a run without them it is the best post-evaluated fitness,
    and `warn` says so if a checkpoint tells how few episodes that had. A run without either is left
    out after a call of `warn`. Raises BotschoolError if none is left.
    """
    fitness = {}
    doubts: dict[str, list[str]] = {}
    for run in find_runs(folder, warn):
        if not run.fit and run.stat is None and run.fresh is None:
            continue
        try:
            fitness[run.seed] = run.fitness()
            doubts.setdefault(run.doubt(), []).append(str(run.seed))
        except BotschoolError as error:
            warn(f"skipped: {error}")
    if not fitness:
        raise BotschoolError(
            f"no run in {folder} has a post-evaluated fitness: let one run for a while first."
        )
    doubts.pop("", None)
    for doubt, seeds in doubts.items():
        warn(
            f"note: {folder}, seed {listed(seeds)}: the number is the best of many {doubt}, so "
            "it is too high: add --resume to the run's command to measure its best robot in fresh "
            "episodes."
        )
    return fitness


def read_fresh(folder: Path | str, seeds: set[int]) -> dict[int, np.ndarray]:
    """Return the best robots' returns in fresh episodes: seed -> (episodes,), where a run has them
    and these seeds include it. Damaged files are left out; `find_runs` names them.
    """
    found = {}
    for seed in sorted(seed for seed in seeds if seed >= 0):
        with suppress(BotschoolError):
            found[seed] = fresh.read(RunFiles(Path(folder), seed).fresh)
    return {seed: returns for seed, returns in found.items() if returns is not None}


def seed_of(stat: Path | str) -> int | None:
    """Return the seed in a stat file's name, or None if the name has none."""
    match = _RUN_FILE.fullmatch(Path(stat).name)
    return int(match["seed"]) if match and match["kind"] == "stat" else None


def named(folders: Sequence[Path]) -> dict[str, Path]:
    """Return the shortest names that distinguish the folders: "acrobot", or "old/acrobot"."""
    if not folders:
        raise BotschoolError("nothing to show: name at least one folder of runs.")
    resolved = {folder.resolve(): folder for folder in folders}
    for parts in range(1, max(len(folder.parts) for folder in resolved) + 1):
        names = {"/".join(full.parts[-parts:]): folder for full, folder in resolved.items()}
        if len(names) == len(resolved):
            break
    return names


def common_title(problems: Collection[str], title: str) -> str:
    """Return the title after what all folders have in common: problem and algorithm, or one."""
    for about in ({*problems}, {each.partition(",")[0] for each in problems}):
        if len(about) == 1 and all(about):
            return f"{about.pop()}: {title}"
    return title
