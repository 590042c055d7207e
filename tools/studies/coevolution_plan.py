"""The study of co-evolution: which runs it consists of, where they lie, and how far they are."""

from __future__ import annotations

from collections.abc import Iterator
from copy import deepcopy
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from study import EXPERIMENTS

from botschool import config
from botschool.analysis.populations import seeds_of
from botschool.analysis.runs import STEPS, read_stat
from botschool.config import Experiment
from botschool.evolution.record import RunFiles

FULL_ARCHIVE, FULL_RUN = 25_000, 75_000
"""archivelen of maxsolvestar, and the million steps of the published run that it is meant for."""


@dataclass(frozen=True)
class Variant:
    """One of the ways to evolve that are compared."""

    name: str
    file: str
    """In data/experiments, without .ini."""
    changes: dict = field(default_factory=dict)
    """Hyperparameters in [ALGO] that the file has otherwise."""


VARIANTS = (
    Variant("coevo2-best", "predprey", {"evolving": "best"}),
    Variant("coevo2-random", "predprey", {"evolving": "random"}),
    Variant("archive", "predprey_archive"),
    Variant("archivestar", "predprey_archivestar"),
    Variant("maxsolvestar", "predprey_maxsolvestar"),
)


@dataclass(frozen=True)
class Plan:
    """Runs of all variants with the same seeds, as long as each other."""

    name: str
    about: str
    milestones: tuple[float, ...]
    """Million steps. All runs of the plan reach one before any goes on to the next."""
    seeds: tuple[int, ...]
    saveeach: dict[str, int]
    """Generations between saved individuals, by variant."""
    changes: dict[str, dict] = field(default_factory=dict)
    """Variant -> hyperparameters in [ALGO] that this plan has otherwise."""

    def experiment(self, variant: Variant) -> Experiment:
        """What its runs evolve."""
        experiment = deepcopy(config.load(EXPERIMENTS / f"{variant.file}.ini"))
        longest = self.milestones[-1]
        own = {"saveeach": self.saveeach[variant.name]}
        if hasattr(experiment.algo, "maxmsteps"):
            own["maxmsteps"] = float(longest)
        if hasattr(experiment.algo, "archivelen"):  # the same part of the run as of the full one
            own["archivelen"] = round(FULL_ARCHIVE * longest / FULL_RUN)
        for key, value in (own | variant.changes | self.changes.get(variant.name, {})).items():
            setattr(experiment.algo, key, value)
        return experiment


SMALL = {"popsize": 10, "selsize": 3, "samplesize": 10}
PLANS = (
    Plan(
        "small",
        "coevo2 with popsize 10, selsize 3 and samplesize 10; the others as in their files",
        (50, 100, 200),
        (1, 2, 3, 4, 5),
        {
            "coevo2-best": 1,
            "coevo2-random": 1,
            "archive": 10,
            "archivestar": 1,
            "maxsolvestar": 10,
        },
        {"coevo2-best": SMALL, "coevo2-random": SMALL},
    ),
    Plan(
        "full",
        "the files as they are",
        (250, 500, 1000, 1500, 2000),
        (1, 2, 3, 4, 5),
        {
            "coevo2-best": 2,
            "coevo2-random": 2,
            "archive": 100,
            "archivestar": 20,
            "maxsolvestar": 100,
        },
    ),
)


@dataclass(frozen=True)
class StudyRun:
    """One run: FOLDER/PLAN/VARIANT, with files of its seed."""

    folder: Path
    plan: Plan
    variant: Variant
    seed: int

    @property
    def name(self) -> str:
        """Unique in the study."""
        return f"{self.plan.name} {self.variant.name} {self.seed}"

    @property
    def home(self) -> Path:
        """The folder of the runs of its variant."""
        return self.folder / self.plan.name / self.variant.name

    @property
    def files(self) -> RunFiles:
        """Those that it writes."""
        return RunFiles(self.home, self.seed)

    def steps(self) -> np.ndarray:
        """Steps done after each generation, from 0 on; empty if it has not begun."""
        if not self.files.populations(0).exists():
            return np.zeros(0)
        if not np.load(self.files.stat).size:
            return np.zeros(1)
        return np.append(0, read_stat(self.files.stat)[:, STEPS])

    def reached(self) -> float:
        """Million steps done."""
        return float(np.append(0, self.steps())[-1]) / 1e6

    def saved(self) -> list[int]:
        """Generations of which it has individuals, sorted."""
        return seeds_of(self.home)[self.seed]

    def write_experiment(self) -> Path:
        """Writes the .ini file for the command, and gives its path."""
        self.home.mkdir(parents=True, exist_ok=True)
        lines = []
        for section, keys in config.to_dict(self.plan.experiment(self.variant)).items():
            lines += [f"[{section.upper()}]"]
            lines += [f"{key} = {value}" for key, value in keys.items() if value != ""]
        path = self.home / "experiment.ini"
        text = "\n".join(lines) + "\n"
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")
        return path


def runs(folder: Path, plan: Plan) -> list[StudyRun]:
    """All of a plan: the first seed of all variants, then the next one."""
    return [StudyRun(folder, plan, variant, seed) for seed in plan.seeds for variant in VARIANTS]


def jobs(folder: Path, plans: tuple[Plan, ...] = PLANS) -> Iterator[tuple[StudyRun, float]]:
    """What there is to do, in its order: a run, and the million steps that it is to reach.

    The first milestone of each plan, then the first plan to its end, then those after it.
    """
    first = [(plan, plan.milestones[0]) for plan in plans]
    then = [(plan, milestone) for plan in plans for milestone in plan.milestones[1:]]
    for plan, milestone in first + then:
        for run in runs(folder, plan):
            yield run, milestone


def complete(folder: Path, plan: Plan) -> float | None:
    """The last milestone that all runs of a plan have reached; None if there is none."""
    least = min(run.reached() for run in runs(folder, plan))
    return max((m for m in plan.milestones if m <= least), default=None)
