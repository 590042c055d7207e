"""Write and read entries of a league: small files with a robot, its network's kind and a name."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool import problems
from botschool.config import Experiment, from_dict, load, to_dict
from botschool.errors import BotschoolError
from botschool.labs.declare import load_lab
from botschool.labs.saved import member
from botschool.output import save_npz
from botschool.paths import own_file
from botschool.policies.policy import Policy
from botschool.problems.base import Problem
from botschool.render.watch import read_genotype
from botschool.sandbox.inside import read_inside
from botschool.screen import plain

DISCIPLINES = {
    "PlanarHopper-v5": "hopper",
    "PlanarWalker2D-v5": "walker",
    "PlanarHalfCheetah-v5": "cheetah",
    "CartPole-v1": "cart-pole",
    "ErPredprey": "chase",
}
"""Environment -> the discipline in which its robots compete."""
ALIKE = {"CartPole-v0": "CartPole-v1"} | {
    name.replace("v5", "v0"): name for name in DISCIPLINES if name.startswith("Planar")
}
"""Environment -> the environment in which its robots compete."""
MAX_BYTES, MAX_CONTENT, MAX_NAME = 2**20, 4 * 2**20, 40
LARGEST = {"nhiddens": 1000, "nhiddens2": 1000, "nlayers": 10}
SUFFIX = ".robot.npz"


class Unusable(Exception):
    """The file is no entry; the text is a sentence that follows the file's name."""


@dataclass(frozen=True, eq=False)
class Entry:
    """A robot in the league."""

    file: str
    name: str
    """The name that the owner chose; "" if the owner stays anonymous."""
    experiment: Experiment
    genotype: np.ndarray

    @property
    def shown(self) -> str:
        """Return the name for the league's page."""
        return self.name or "anonymous"

    @property
    def discipline(self) -> str:
        """Return the discipline in which it competes."""
        return DISCIPLINES[self.experiment.exp.environment]

    def robot(self) -> tuple[Problem, Policy, np.ndarray, np.ndarray | None]:
        """Return problem, policy, genotype and normalisation vectors (None without)."""
        problem = problems.of(self.experiment)
        policy = problem.policy(self.experiment.policy)
        return problem, policy, *policy.split(self.genotype)


def write_entry(genotype: Path, experiment: Path | None, name: str, output: Path | None) -> Path:
    """Write an entry and return its file. Raises BotschoolError.

    experiment: an .ini file; None for a run of a laboratory, whose folders tell the experiment.
    """
    numbers = read_genotype(genotype := own_file(genotype, "genotypes"))
    parts = to_dict(
        load(own_file(experiment, "experiments")) if experiment else _of_laboratory(genotype)
    )
    about = json.dumps({"exp": parts["exp"], "policy": parts["policy"]})
    name = " ".join(name.split())[:MAX_NAME]
    path = output or Path(f"{genotype.stem}{SUFFIX}")
    try:
        read_robot(path.name, name, about, numbers)
    except Unusable as error:
        raise BotschoolError(f"{genotype} {error}") from None
    save_npz(path, {"name": name, "experiment": about, "genotype": numbers})
    return path


def _of_laboratory(genotype: Path) -> Experiment:
    parts = genotype.resolve().parts
    try:
        return load_lab(parts[-4]).condition(parts[-2]).load()
    except (BotschoolError, IndexError, StopIteration, KeyError):
        raise BotschoolError(
            f"Say which experiment {genotype} is of: add -f FILE.ini. Only runs of a laboratory "
            "(lab09/runs/CONDITION) tell it themselves."
        ) from None


def read_entry(path: Path) -> Entry:
    """Read an entry. Raises Unusable."""
    try:
        content = read_inside(path.parent, path.name, MAX_BYTES)
    except OSError:
        raise Unusable("is a link, or cannot be read: hand in the file itself.") from None
    if len(content) > MAX_BYTES:
        raise Unusable(f"is larger than {MAX_BYTES // 2**20} MB: an entry has some KB.")
    try:
        name, about, genotype = (
            member(content, key, MAX_CONTENT) for key in ("name", "experiment", "genotype")
        )
        if name.dtype.kind != "U" or name.shape or about.dtype.kind != "U" or about.shape:
            raise Unusable("has no name or experiment as text")
        return read_robot(path.name, str(name), str(about), genotype)
    except Unusable:
        raise
    except KeyError as error:
        why = f"lacks {error}"
    except ValueError as error:
        why = f"is damaged, or no entry ({error})"
    except Exception as error:  # what an entry states can be wrong in any way
        why = f"cannot play ({type(error).__name__})"
    raise Unusable(f"{why}: make it with botschool enter.")


def read_robot(file: str, name: str, about: str, genotype: np.ndarray) -> Entry:
    """Return an entry made of these parts. Raises Unusable.

    Of the experiment, it uses only the environment and the settings of the network.
    """
    try:
        told = json.loads(about)
        environment, policy = str(told["exp"]["environment"]), dict(told["policy"])
    except (ValueError, KeyError, TypeError, RecursionError):
        raise Unusable("has an experiment that cannot be read.") from None
    environment = ALIKE.get(environment, environment)
    if environment not in DISCIPLINES:
        there = ", ".join(DISCIPLINES)
        raise Unusable(f"is of {environment[:40]!r}, which has no discipline here: {there} have.")
    for key, most in LARGEST.items():
        value = policy.get(key, 0)
        if not isinstance(value, int) or value > most:
            raise Unusable(f"has {key} above {most}, or no number.")
    exp = {"environment": environment, "algo": "OpenAI-ES"}
    if DISCIPLINES[environment] == "chase":
        exp["algo"] = "coevo2"
    shown = plain(" ".join(name.encode("utf-8", "replace").decode().split()))[:MAX_NAME]
    try:
        experiment = from_dict({"exp": exp, "policy": policy, "algo": {}}, "its experiment")
        entry = Entry(file, shown, experiment, genotype)
        entry.robot()
    except BotschoolError as error:
        raise Unusable(f"cannot play: {error}") from None
    return entry
