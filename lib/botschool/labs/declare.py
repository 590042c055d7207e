"""Define the parts of a laboratory: conditions, measures, the table, the figure, statements."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from botschool.config import Experiment, from_dict, to_dict
from botschool.errors import BotschoolError
from botschool.labs.fields import Field, fields_of
from botschool.wrappers import keywords

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
Judged = tuple[Callable[[Any], bool], str]
"""Whether an answer is right; a sentence that says how to find the right one."""


@dataclass(frozen=True)
class Condition:
    """One setting of the experiment, repeated with the student's seeds."""

    name: str
    """Its name in the sheet's table; also the name of the folder of its runs."""
    experiment: dict[str, dict[str, Any]]
    """Like the result of config.to_dict; missing keys have their default."""
    generations: int | None = None
    """Generations of a run; None: until the experiment's steps are spent."""
    kind: str = "evolving"
    """The module of botschool.labs that makes its runs: evolving or training."""

    @classmethod
    def of(
        cls,
        name: str,
        environment: str,
        policy: str,
        algo: str,
        by: str = "OpenAI-ES",
        generations: int | None = None,
        **more: Any,
    ) -> Condition:
        """Return a condition of runs that evolve.

        policy, algo: settings, as in "episodes=1, bias=1". The hyperparameters of a strategy of the
        student's become its options. by: the algorithm. more: further settings of [EXP].
        """
        told = keywords(algo)
        if by.startswith(f"{STRATEGY}:"):
            options = ", ".join(f"{k}={v:g}" for k, v in told.items() if k != "maxmsteps")
            told = {"maxmsteps": told["maxmsteps"], "options": options}
        exp = {"environment": environment, "algo": by} | more
        return cls(name, {"exp": exp, "policy": keywords(policy), "algo": told}, generations)

    @classmethod
    def trained(
        cls, name: str, environment: str, msteps: float, ppo: str, **more: Any
    ) -> Condition:
        """Return a condition of trainings by PPO. more: further parts of the experiment."""
        experiment: dict[str, Any] = {
            "exp": {"environment": environment, "algo": "PPO"},
            "policy": {"pepisodes": 20},
            "algo": {"maxmsteps": msteps},
            "ppo": keywords(ppo),
        }
        return cls(name, experiment | more, kind="training")

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
class Statement:
    """A field of the conclusion that is right if the student's own data support it."""

    points: int
    needs: tuple[str, ...]
    """Names of the conditions whose runs the answer needs."""
    judge: Callable[[Data, Answers], Judged]
    """Returns whether an answer is right, and a sentence on how to find the right one."""


INTERVAL = 0.3
"""Share of an interval's length by which each of its ends may be off."""


@dataclass(frozen=True)
class Column:
    """A column of the sheet's table."""

    statistic: Callable[[np.ndarray], Any]
    """A function of an array: np.median, np.mean, np.sum, or interval."""
    measure: str
    """Name of a measure, or of two in the form "reported - fresh"."""
    within: float
    """Largest error allowed in each number."""
    share: float = 0
    """Share of the right number that is allowed beyond it; of an interval, INTERVAL counts."""
    only: str = ""
    """Beginning of the names of the conditions whose rows have this column."""
    unit: float = 1
    """The table shows the numbers divided by this."""

    def of(self, values: Mapping[str, np.ndarray]) -> tuple[float, ...]:
        """Return one number of a condition's measurements, or the two ends of an interval."""
        found = np.atleast_1d(self.statistic(measured(self.measure, values)))
        return tuple((found / self.unit).tolist())

    def tolerance(self, true: tuple[float, ...]) -> float:
        """Return the largest error allowed in each of the right numbers."""
        if len(true) == 2:
            return self.within + INTERVAL * (true[1] - true[0])
        return self.within + self.share * abs(true[0])


def measured(name: str, values: Mapping[str, np.ndarray]) -> np.ndarray:
    """Return a measure of each run, or the difference of two in the form "reported - fresh"."""
    first, _, second = name.partition(" - ")
    return values[first] - values[second] if second else values[first]


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
    """A laboratory: what its page, labNN.md, does not say."""

    number: int
    conditions: tuple[Condition, ...]
    statements: dict[str, Statement]
    """The fields of the conclusion that earn points, by their id."""
    measures: dict[str, float]
    """What measure.py returns: name -> relative tolerance."""
    reference: Callable[[dict[str, Any], Answers], dict[str, float]]
    """Returns the right measures of a run."""
    unseen: tuple[Condition, ...]
    """Conditions of the check's own runs, which measure.py has never seen."""
    columns: tuple[Column, ...]
    """The columns of the table, in the order of the page."""
    figure: Figure
    rubric: tuple[str, ...]
    """Sentences for the instructor who grades the words."""
    shown: tuple[str, ...] = ()
    """Conditions whose best robot the report replays; only conditions that evolve."""
    separate: Callable[[list[dict[str, float]]], str] = lambda measured: ""
    """Returns what is wrong with the measures of all unseen runs together; "" if nothing."""
    replications: int = 10
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

    @cached_property
    def page(self) -> str:
        """Return labNN.md: the sheet, and after it the scripts that the student's folder gets."""
        return Path(__file__).with_name(f"{self.name}.md").read_text(encoding="utf-8")

    @property
    def title(self) -> str:
        """Return the question in the sheet's first line."""
        return self.page.partition("\n")[0].partition(". ")[2]

    @cached_property
    def fields(self) -> dict[str, Field]:
        """Return the fields of the sheet that the check reads."""
        return fields_of(self.page)

    @property
    def titles(self) -> list[str]:
        """Return the titles of the table's columns."""
        before = self.page.partition(f"\n| {self.conditions[0].name} |")[0]
        return [title.strip() for title in before.splitlines()[-2].split("|")[2:-1]]

    def condition(self, name: str) -> Condition:
        """Return the condition with this name."""
        return next(each for each in self.conditions if each.name == name)


def load_lab(number: str | int) -> Lab:
    """Return the laboratory with this number. Raises BotschoolError if there is none."""
    text = str(number).removeprefix("lab")
    if not text.isdigit() or int(text) not in NUMBERS:
        there = f"{', '.join(map(str, NUMBERS[:-1]))} and {NUMBERS[-1]}"
        raise BotschoolError(
            f"There is no laboratory {number}: the laboratories that exist are {there}."
        )
    return import_module(f"botschool.labs.lab{int(text):02}").LAB
