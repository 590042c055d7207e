"""Write and read checkpoints, from which a run continues as if it had never stopped."""

from __future__ import annotations

import json
import re
import tempfile
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from botschool.config import Experiment, defaults, free, to_dict
from botschool.errors import ANEW, RESUME, BotschoolError, Option
from botschool.evolution.record import RunFiles
from botschool.output import save_npz
from botschool.problems import Problem

FORMAT = 1


class Resumable(Protocol):
    """The methods of a run that its checkpoint needs."""

    experiment: Experiment
    seed: int
    problem: Problem
    policy: Any

    def restore(self, state: dict[str, np.ndarray]) -> None:
        """Raise KeyError, ValueError, IndexError or TypeError for the state of another run."""

    def reproduces(self) -> bool:
        """Return whether robots still get the fitness in the record."""


def save(path: Path, experiment: Experiment, seed: int, state: dict[str, np.ndarray]) -> None:
    """Write a checkpoint atomically; state is arrays only."""
    header = {"format": FORMAT, "seed": seed, "experiment": to_dict(experiment), "scaled": True}
    save_npz(path, {"botschool": np.array(json.dumps(header)), **state})


def load(path: Path, experiment: Experiment, seed: int) -> dict[str, np.ndarray]:
    """Return the state of a checkpoint of this experiment and seed.

    Raises BotschoolError when the file is damaged or belongs to another experiment or seed.
    """
    try:
        with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as file:
            state = {name: file[name] for name in file.files}
        header = json.loads(str(state.pop("botschool")))
        version, owner = header["format"], header["seed"]
        saved = {section: dict(keys) for section, keys in header["experiment"].items()}
        if not all(isinstance(value, np.ndarray) for value in state.values()):
            raise ValueError("a part is not an array")
    except Exception as error:  # a damaged file can fail in any way
        raise BotschoolError(
            f"{path} is not a complete checkpoint of botschool ({_reason(error)}): restore it "
            "from a copy",
            *ANEW,
        ) from None
    if version != FORMAT:
        raise BotschoolError(
            f"{path} was written by another version of botschool: use that one", *ANEW
        )
    if owner != seed:
        raise BotschoolError(
            f"{path} is a checkpoint of seed {owner}, not of {seed}: give that seed",
            Option(" with -s", ""),
            *ANEW,
        )
    now, may_change = to_dict(experiment), free(experiment)
    unsaid = defaults(experiment)  # keys that older versions did not have
    for section, keys in now.items():
        for key, value in keys.items():
            before = saved.get(section, {}).get(key, unsaid[section][key])
            if (section, key) not in may_change and before != value:
                raise BotschoolError(
                    f"{path} belongs to an experiment with {key} = {before}, but {key} is now "
                    f"{value}: change it back to resume",
                    *ANEW,
                )
    return state


def header(path: Path) -> dict[str, Any]:
    """Return format, seed and experiment (as to_dict gives it) of a checkpoint.

    Raises BotschoolError if there is none, or if it is damaged.
    """
    try:
        with open(path, "rb") as stream, np.load(stream, allow_pickle=False) as file:
            found = json.loads(str(file["botschool"]))
        if not isinstance(found["experiment"], dict):
            raise ValueError("it names no experiment")
    except Exception as error:  # a damaged file can fail in any way
        raise BotschoolError(
            f"{path} is not a complete checkpoint of botschool ({_reason(error)})."
        ) from None
    return found


def check_scaling(genotype: Path, policy: Any) -> None:
    """Raise BotschoolError for a robot whose run took outputs as they were, where they are scaled
    now. The checkpoint beside the genotype's file tells it.
    """
    name = re.fullmatch(r"bestg?S([0-9]+)(G[0-9]+)?\.npy", genotype.name, re.ASCII)
    if not policy.scales or name is None:
        return
    path = RunFiles(genotype.parent, int(name[1])).checkpoint
    if path.exists() and not header(path).get("scaled"):
        raise BotschoolError(
            f"{genotype} is of a version of botschool that did not scale outputs to the limits of "
            "the actions: add wrappers = ClipAction under [EXP], by which they are taken as they "
            "were."
        )


def post_episodes(folder: Path, seed: int) -> int:
    """Return the episodes of a post-evaluation of a run; 0 if its checkpoint does not tell, or
    if two sides evolved, whose fitness is the mean over all opponents.
    """
    try:
        found = header(RunFiles(folder, seed).checkpoint)["experiment"]
        return 0 if "ngenerations" in found["algo"] else int(found["policy"]["pepisodes"])
    except (BotschoolError, KeyError, TypeError, ValueError):
        return 0


def resume(path: Path, run: Resumable) -> None:
    """Restore a run to its state at the checkpoint.

    Raises BotschoolError as `load` does, if the state belongs to another kind of run, or if this
    version of botschool gives its robots another fitness than the version that wrote it.
    """
    try:
        run.restore(load(path, run.experiment, run.seed))
    except (KeyError, ValueError, IndexError, TypeError):
        raise BotschoolError(
            f"{path} does not fit this run (the environment has changed, or parts are "
            "missing): restore it from a copy",
            *ANEW,
        ) from None
    if run.policy.scales and not header(path).get("scaled"):
        raise BotschoolError(
            f"{path} was written by a version of botschool that did not scale outputs to the "
            "limits of the actions: use that version",
            *ANEW,
        )
    if run.problem.native and not run.reproduces():  # others may be slow, or never repeat
        raise BotschoolError(
            f"{path} was written by a version of botschool that evaluates robots differently (its "
            "best one gets another fitness here): use that version",
            *ANEW,
        )


def rescued(run: Any, unsaved: BotschoolError) -> BotschoolError:
    """Save a run whose folder cannot be written in a temporary folder; return the error to raise,
    which says where.
    """
    try:
        files = RunFiles(Path(tempfile.mkdtemp(prefix="botschool-")), run.seed)
        save(files.checkpoint, run.experiment, run.seed, run.state())
        run.write(files, ended=True)
    except (OSError, BotschoolError):
        return unsaved
    return BotschoolError(
        f"{unsaved} The run is in {files.folder}: go on with ",
        Option("-o ", "folder="),
        f"{files.folder} ",
        RESUME,
        ".",
    )


def _reason(error: Exception) -> str:
    if isinstance(error, KeyError):
        return "parts are missing"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    return "it is damaged or of another kind"
