"""Define the parts of a laboratory: conditions, measures, fields of the sheet, statements."""

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
"""Points of each part that the check gives; the instructor gives up to WORDS more."""
WORDS = 10
NUMBERS = tuple(
    sorted(int(path.stem[3:]) for path in Path(__file__).parent.glob("lab[0-9][0-9].py"))
)
"""Numbers of all laboratories: the modules labNN beside this file."""

STRATEGY = "strategy"
"""Name of the module with the student's own strategy, in the laboratory's folder."""

Data = Mapping[str, Mapping[str, np.ndarray]]
"""Measurements: condition -> measure -> one value for each run."""
Answers = Mapping[str, Any]
"""Readable fields of the sheet: id -> number, label of a choice, or text."""


@dataclass(frozen=True)
class Condition:
    """One setting of the experiment, repeated with the student's seeds."""

    name: str
    """Its name in the sheet's table; also the name of the folder of its runs."""
    experiment: dict[str, dict[str, Any]]
    """Like the result of config.to_dict; missing keys have their default."""
    generations: int | None = None
    """Generations of a run; None: until the experiment's steps are spent."""
    x: float = 0.0
    """Its place on the figure's horizontal axis."""
    kind: str = "evolving"
    """The module of botschool.labs that makes its runs: evolving or training."""

    @property
    def maker(self) -> Any:
        """Return that module, which has make_all, read, made and genuine."""
        return import_module(f"botschool.labs.{self.kind}")

    @property
    def own(self) -> bool:
        """Return whether the student's own strategy evolves."""
        return str(self.experiment["exp"].get("algo")).startswith(f"{STRATEGY}:")

    def load(self) -> Experiment:
        """Return the experiment of a run that evolves, checked."""
        return from_dict(self.experiment, self.name)

    def told(self) -> dict[str, Any]:
        """Return the experiment in the form that measure.py gets."""
        return to_dict(self.load()) if self.kind == "evolving" else self.experiment

    def shortened(self, parts: int) -> Condition:
        """Return the same condition with a budget `parts` times smaller."""
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
    """"number", "choice" or "text"."""
    what: str
    """What the field asks for, in the words of messages."""
    low: float = -np.inf
    high: float = np.inf
    words: int = 0
    """Smallest number of words of a text."""


@dataclass(frozen=True)
class Column:
    """A column of the sheet's table."""

    title: str
    of: Callable[[Mapping[str, np.ndarray]], tuple[float, ...]]
    """Measurements of a condition -> one number, or the two ends of an interval."""
    tolerance: Callable[[tuple[float, ...]], float]
    """Right numbers -> largest error allowed in each."""
    only: Callable[[str], bool] = lambda condition: True
    """Name of a condition -> whether its row has this column."""


@dataclass(frozen=True)
class Statement:
    """A field of the conclusion; it is right if the student's own data support it."""

    field: str
    points: int
    needs: tuple[str, ...]
    """Names of the conditions whose runs it needs."""
    judge: Callable[[Data, Answers], tuple[Callable[[Any], bool], str]]
    """Data, answers -> a function that tells whether an answer is right; a sentence on the data."""


@dataclass(frozen=True)
class Figure:
    """The requirements of the figure."""

    y: str
    """The measure that gives the heights of the points."""
    conditions: tuple[str, ...]
    units: tuple[str, ...]
    """Words for the unit; the name of the vertical axis must hold one of them."""
    mark: Callable[[Data], float | None] = lambda data: None
    """Data -> where the figure must have a vertical line; None if it needs none."""


@dataclass(frozen=True)
class Lab:
    """A laboratory."""

    number: int
    title: str
    conditions: tuple[Condition, ...]
    predictions: tuple[Field, ...]
    fields: tuple[Field, ...]
    """Fields after the prediction that the check reads."""
    measures: dict[str, float]
    """What measure.py returns: name -> relative tolerance."""
    reference: Callable[[dict[str, Any], Answers], dict[str, float]]
    """Returns the right measures of a run."""
    unseen: tuple[Condition, ...]
    """Conditions of the check's own runs, which measure.py has never seen."""
    columns: tuple[Column, ...]
    statements: tuple[Statement, ...]
    figure: Figure
    rubric: tuple[str, ...]
    """Sentences for the instructor who grades the words."""
    robot: str
    """Word for what a run makes, in the plural, such as "hoppers"."""
    shown: tuple[str, ...]
    """Conditions whose best robot the report replays; only conditions that evolve."""
    best: Callable[[Mapping[str, np.ndarray]], np.ndarray]
    """Measurements of a condition -> a number for each run; the report replays the best run."""
    separate: Callable[[list[dict[str, float]]], str] = lambda measured: ""
    """Returns what is wrong with the measures of all unseen runs together; "" if nothing."""
    replications: int = 10
    quick: int = 10
    """With --quick, each condition has three runs with a budget this many times smaller."""
    redone: int = 3
    """Number of runs that a check makes again."""
    others: bool = False
    """Whether measure.py also gets the robots of the condition's other runs."""
    strategy: str = ""
    """The exercise's file that becomes strategy.py, such as ex08_openai_es/openai_es.py."""

    @property
    def name(self) -> str:
        """Return the name of its folder, such as lab09."""
        return f"lab{self.number:02}"

    def condition(self, name: str) -> Condition:
        """Return the condition with this name."""
        return next(each for each in self.conditions if each.name == name)

    def what(self, field: str) -> str:
        """Return what messages call a field of the conclusion."""
        return next(each.what for each in self.fields if each.id == field)


def load_lab(number: str | int) -> Lab:
    """Return the laboratory with this number. Raises BotschoolError if there is none."""
    text = str(number).removeprefix("lab")
    if not text.isdigit() or int(text) not in NUMBERS:
        there = f"{', '.join(map(str, NUMBERS[:-1]))} and {NUMBERS[-1]}"
        raise BotschoolError(
            f"There is no laboratory {number}: the laboratories that exist are {there}."
        )
    return import_module(f"botschool.labs.lab{int(text):02}").LAB
