"""Choose the file of an exercise among all files that a person handed in."""

from __future__ import annotations

import re
from codecs import BOM_UTF8
from collections.abc import Callable
from pathlib import Path

from botschool.grading.classes.candidate import Candidate, Sought, squashed
from botschool.grading.classes.files import File, Handed, listed
from botschool.grading.classes.kinds import kind_of, may_hold_code
from botschool.grading.classes.settle import Choice, settle
from botschool.grading.classes.texts import MAX_NOTEBOOK, MAX_TEXT
from botschool.grading.declare.checks import plain

MAX_NAMED = 5
"""Files that a sentence names, where the exercise's is missing."""
GIVEN = (
    ".venv/", "build/", "data/", "docs/", "envs/", "lib/", "solutions/", "tests/", "tools/",
)  # fmt: skip
"""Folders beside exercises/ that nobody solves an exercise in."""
_COURSE = re.compile(r"((?:.*/)?)exercises/ex\d\d_")


class Wanted(Sought):
    """An exercise whose file is looked for among what a person handed in."""

    def choose(
        self, handed: Handed, new_folder: Callable[[], Path], newest_first: bool = False
    ) -> Choice:
        """Return the file to grade; newest_first: whether the platform numbers attempts."""
        candidates, unread = _candidates(handed, self)
        if not candidates and handed.checkpoints:
            kept = Handed(handed.checkpoints, handed.links)
            candidates, unread = _candidates(kept, self)
        if not candidates:
            if any(_is_of(link, self) for link in handed.links):
                return Choice(problem=f"{self.file} is a link to another place.")
            if unread or handed.unread:
                return Choice(problem=f"The folder of {self.file} is unreadable.", unread=True)
            return Choice(problem=_nothing(handed, self))
        ranked = sorted(candidates, key=lambda each: each.rank(newest_first), reverse=True)
        best, others = ranked[0], ranked[1:]
        choice = Choice(origin=best.file, changed=best.differs)
        choice.used |= {each.file for each in ranked}
        choice.notes = [*_choosing(best, others, self), *_looks(best, self)]
        settle(choice, best, handed, self, new_folder)
        return choice


def _choosing(best: Candidate, others: list[Candidate], wanted: Wanted) -> list[str]:
    """Return sentences on which file is graded, and which are not."""
    notes = []
    if best.file.shown not in wanted.places:
        what = "the text that was typed in" if best.is_typed else best.file.shown
        notes.append(f"Graded: {plain(what)}.")
    if changed := [each.file.shown for each in others if each.differs]:
        notes.append(f"Not used: {listed(changed)}.")
    if best.differs and (given := [each.file.shown for each in others if not each.differs]):
        notes.append(f"Not used, because nothing in it was changed: {listed(given)}.")
    return notes


def _looks(best: Candidate, wanted: Wanted) -> list[str]:
    """Return sentences on a file that is no program of this exercise."""
    name = plain(best.file.name)
    if not best.content.strip():
        return [f"{name} is empty."]
    if not best.differs:
        return [f"Nothing was changed in {name}."] if best.code.strip() else []
    if wanted.names and best.shared == 0:
        return [f"{name} defines no function of the exercise."]
    return []


def _is_of(link: str, wanted: Wanted) -> bool:
    """Return whether a link stands where the exercise's file or its folder is."""
    parts = link.split("/")
    return parts[-1] in (wanted.file, wanted.folder, "exercises") or wanted.folder in parts


def _candidates(handed: Handed, wanted: Wanted) -> tuple[list[Candidate], bool]:
    """Return the files that fit, and whether an unreadable one may be the exercise's.

    Files of other names count only if every file of the exercise's name is unchanged, and what the
    course gives out beside the exercises never: its library has modules of similar names.
    """
    courses = {match[1] for file in handed.files if (match := _COURSE.match(file.shown))}
    given = tuple(course + folder for course in courses for folder in GIVEN)
    own = {file for file in handed.files if not file.shown.startswith(given)}
    named = {file for file in own if wanted.stem in squashed(file.name)}
    found, unread = [], False
    for files in (named, own - named):
        for file in sorted(files, key=lambda file: file.shown):
            if not may_hold_code(file.name):
                continue
            try:
                content = _read(file)
            except OSError as error:
                if file in named:
                    unread |= error.errno is not None  # else a link, or no regular file
                    handed.links += [] if error.errno else [file.shown]
                continue
            if content is None or kind_of(content, file.name):
                continue
            candidate = Candidate(file, wanted, content)
            if candidate.fits():
                found.append(candidate)
        if any(each.differs for each in found):
            break
    return found, unread


def _read(file: File) -> bytes | None:
    """Return a file's content; None if it is too large. Raises OSError."""
    content = file.read(MAX_TEXT)
    if len(content) > MAX_TEXT and content.removeprefix(BOM_UTF8).lstrip().startswith(b"{"):
        content = file.read(MAX_NOTEBOOK)  # with its pictures
        return content if len(content) <= MAX_NOTEBOOK else None
    return content if len(content) <= MAX_TEXT else None


def _nothing(handed: Handed, wanted: Wanted) -> str:
    """Return a sentence that names what was handed in instead."""
    parts = [f"There is no {wanted.file}."]
    shown = [f"{file.shown}{_what(file)}" for file in handed.files[:MAX_NAMED]]
    if shown:
        parts.append(f"Handed in: {listed(shown)}{' ...' * (len(handed.files) > MAX_NAMED)}.")
    elif handed.ignored:
        parts.append(f"Ignored: {listed(handed.ignored[:MAX_NAMED])}.")
    return " ".join(parts)


def _what(file: File) -> str:
    """Return what a file is, in brackets, if it is neither a text nor of a program's size."""
    try:
        content = file.read(MAX_TEXT)
    except OSError:
        return ""
    kind = kind_of(content, file.name)
    size = f"more than {MAX_TEXT // 2**20} MB" if len(content) > MAX_TEXT else ""
    return f" ({kind or size})" if kind or size else ""
