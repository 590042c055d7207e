"""Find sheets of laboratories that look like another student's, and show them side by side."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from html import escape

from botschool.grading.classes.identity import words
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, called

LONG = 6
"""Words of an answer that two people hardly write by chance."""


@dataclass(frozen=True)
class Sheet:
    """A laboratory's sheet, as it was handed in."""

    student: str
    name: str
    """The name that stands in it."""
    robots: frozenset[str]
    """Hashes of the robots of its runs."""
    prediction: Mapping[str, str] = field(default_factory=dict)
    """Question -> answer."""

    @property
    def sentences(self) -> set[str]:
        """Return the long answers of the prediction, without signs and capital letters."""
        return {
            own for each in self.prediction.values() if len((own := words(each)).split()) >= LONG
        }


@dataclass(frozen=True)
class Doubt:
    """Sentences that say why these sheets deserve a look."""

    told: list[str]
    sheets: tuple[Sheet, ...]


def doubtful(sheets: Sequence[Sheet], people: Iterable[str]) -> list[Doubt]:
    """Return each sheet of another's name, and each two with equal runs or predictions.

    people: the names of all students. A sheet may hold a part of its student's name.
    """
    known = {person: set(words(person).split()) for person in people}
    found = []
    for sheet in sheets:
        named, own = set(words(sheet.name).split()), set(words(sheet.student).split())
        others = [person for person, parts in known.items() if named <= parts]
        if named and not named <= own and others:
            said = (
                f"{sheet.student} handed in a sheet with the name {plain(sheet.name[:80])}, "
                f"which is that of {', '.join(others)}."
            )
            theirs = [each for each in sheets if each.student in others]
            found.append(Doubt([said], (sheet, *theirs)))
    for first, second in itertools.combinations(sheets, 2):
        if first.student == second.student:
            continue
        told, both = [], f"{first.student} and {second.student}"
        if common := len(first.robots & second.robots):
            told.append(
                f"{both} handed in the same runs: {common} of {len(first.robots)} and of "
                f"{len(second.robots)}."
            )
        if first.sentences & second.sentences:
            told.append(f"{both} give the same reason in their predictions.")
        if told:
            found.append(Doubt(told, (first, second)))
    return found


def sheets_section(number: Number, doubts: Sequence[Doubt]) -> str:
    """Return the part of the page on similar submissions that shows these sheets."""
    shown = []
    for doubt in doubts:
        told = "".join(f"<p>{escape(each)}</p>" for each in doubt.told)
        sides = "".join(map(_side, doubt.sheets))
        shown.append(f'<section>{told}<div class="both">{sides}</div></section>')
    return f"<h1>{called(number)}: sheets to look at</h1>{''.join(shown)}"


def _side(sheet: Sheet) -> str:
    answers = "".join(
        f"<dt>{escape(what)}</dt><dd>{escape(plain(text))}</dd>"
        for what, text in sheet.prediction.items()
    )
    about = f"name: {plain(sheet.name[:80]) or 'none'}; runs: {len(sheet.robots)}"
    return f"<div><h2>{escape(sheet.student)}</h2><p>{escape(about)}</p><dl>{answers}</dl></div>"
