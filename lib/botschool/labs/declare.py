"""What a laboratory declares: conditions, measures, the fields of its sheet, and how they count."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from botschool.config import Experiment, from_dict, to_dict
from botschool.errors import BotschoolError

PARTS = {"prediction": 5, "runs": 25, "measurements": 25, "figure": 10, "conclusion": 25}
"""The points that a machine gives, part by part; WORDS are the instructor's."""
WORDS = 10
NUMBERS = tuple(
    sorted(int(path.stem[3:]) for path in Path(__file__).parent.glob("lab[0-9][0-9].py"))
)
"""The laboratories that exist: modules labNN beside this file."""

STRATEGY = "strategy"
"""The module with the student's own strategy, in the laboratory's folder."""

Data = Mapping[str, Mapping[str, np.ndarray]]
"""Measurements: condition -> measure -> one value for each run."""
Answers = Mapping[str, Any]
"""The sheet's fields that can be read: id -> number, label of a choice, or text."""


@dataclass(frozen=True)
class Condition:
    """One setting of the experiment, replicated with seeds of the student's."""

    name: str
    """In the sheet's table, and of the folder of its runs."""
    experiment: dict[str, dict[str, Any]]
    """As config.to_dict gives it; keys that are missing have their default."""
    generations: int | None = None
    """Where a run ends; None: when the steps of the experiment are spent."""
    x: float = 0.0
    """Its place on the figure's horizontal axis."""
    kind: str = "evolving"
    """The module of botschool.labs that makes its runs: evolving or training."""

    @property
    def maker(self) -> Any:
        """That module: make_all, read, made, genuine."""
        return import_module(f"botschool.labs.{self.kind}")

    @property
    def own(self) -> bool:
        """Whether the student's own strategy evolves."""
        return str(self.experiment["exp"].get("algo")).startswith(f"{STRATEGY}:")

    def load(self) -> Experiment:
        """The experiment of a run that evolves, checked."""
        return from_dict(self.experiment, self.name)

    def told(self) -> dict[str, Any]:
        """The experiment as measure.py is given it."""
        return to_dict(self.load()) if self.kind == "evolving" else self.experiment

    def shortened(self, parts: int) -> Condition:
        """The same with a budget `parts` times smaller."""
        algo = self.experiment["algo"]
        if "maxmsteps" in algo:
            algo = algo | {"maxmsteps": algo["maxmsteps"] / parts}
        if "ngenerations" in algo:
            last = max(2, algo["ngenerations"] // parts)
            algo = algo | {"ngenerations": last, "saveeach": max(1, last // 4)}
        generations = self.generations and max(1, self.generations // parts)
        return replace(self, experiment=self.experiment | {"algo": algo}, generations=generations)


@dataclass(frozen=True)
class Field:
    """A field of the sheet."""

    id: str
    kind: str
    """number, choice or text."""
    what: str
    """What it asks for, as a message names it."""
    low: float = -np.inf
    high: float = np.inf
    words: int = 0
    """How many words a text has at least."""


@dataclass(frozen=True)
class Column:
    """A column of the sheet's table."""

    title: str
    of: Callable[[Mapping[str, np.ndarray]], tuple[float, ...]]
    """From a condition's measurements: one number, or the two ends of an interval."""
    tolerance: Callable[[tuple[float, ...]], float]
    """How far each number may be off."""
    only: Callable[[str], bool] = lambda condition: True
    """Which conditions fill it in."""


@dataclass(frozen=True)
class Statement:
    """A field of the conclusion, right where the student's own data support it."""

    field: str
    points: int
    needs: tuple[str, ...]
    """Conditions whose runs it rests on."""
    judge: Callable[[Data, Answers], tuple[Callable[[Any], bool], str]]
    """Gives whether an answer is right, and what the data say as a sentence."""


@dataclass(frozen=True)
class Figure:
    """What the figure must show."""

    y: str
    """The measure whose values are the heights of its points."""
    conditions: tuple[str, ...]
    units: tuple[str, ...]
    """Words of which the vertical axis's name holds one."""
    mark: Callable[[Data], float | None] = lambda data: None
    """Where on the horizontal axis a vertical line must stand; None: none is needed."""


@dataclass(frozen=True)
class Lab:
    """A laboratory."""

    number: int
    title: str
    conditions: tuple[Condition, ...]
    predictions: tuple[Field, ...]
    fields: tuple[Field, ...]
    """Those after the prediction that the machine reads."""
    measures: dict[str, float]
    """What measure.py returns: name -> relative tolerance."""
    reference: Callable[[dict[str, Any], Answers], dict[str, float]]
    """Measures a run as measure.py should."""
    unseen: tuple[Condition, ...]
    """Conditions of runs that measure.py meets in the check alone."""
    columns: tuple[Column, ...]
    statements: tuple[Statement, ...]
    figure: Figure
    rubric: tuple[str, ...]
    """For the instructor who reads the words."""
    robot: str
    """What a run evolves, in the plural: hoppers."""
    shown: tuple[str, ...]
    """Conditions whose best robots the report replays; none of trainings."""
    best: Callable[[Mapping[str, np.ndarray]], np.ndarray]
    """A number for each run of a condition, the highest for the robot to replay."""
    separate: Callable[[list[dict[str, float]]], str] = lambda measured: ""
    """What is wrong with the measures of the unseen runs taken together; "" if nothing."""
    replications: int = 10
    quick: int = 10
    """How many times smaller the budget of --quick is; it makes three runs of each condition."""
    redone: int = 3
    """Whole runs that a check makes again."""
    others: bool = False
    """Whether measure.py is also given the robots of the condition's other runs."""
    strategy: str = ""
    """The exercise's file that strategy.py is copied from, as ex08_openai_es/openai_es.py."""

    @property
    def name(self) -> str:
        """Of its folder: lab09."""
        return f"lab{self.number:02}"

    def condition(self, name: str) -> Condition:
        """The condition of that name."""
        return next(each for each in self.conditions if each.name == name)


def load_lab(number: str | int) -> Lab:
    """The laboratory of that number. Raises BotschoolError if there is none."""
    text = str(number).removeprefix("lab")
    if not text.isdigit() or int(text) not in NUMBERS:
        there = f"{', '.join(map(str, NUMBERS[:-1]))} and {NUMBERS[-1]}"
        raise BotschoolError(
            f"There is no laboratory {number}: the laboratories that exist are {there}."
        )
    return import_module(f"botschool.labs.lab{int(text):02}").LAB
