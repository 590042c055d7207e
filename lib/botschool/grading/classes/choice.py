"""Find the file of each exercise among what each person handed in."""

from __future__ import annotations

import re
from codecs import BOM_UTF8
from collections.abc import Callable, Iterable
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.candidate import Candidate, Choice, Sought, settle, squashed
from botschool.grading.classes.download import Person, one_person
from botschool.grading.classes.files import TIMESTAMP, File, Handed, listed, numbered_folders
from botschool.grading.classes.texts import MAX_NOTEBOOK, MAX_TEXT
from botschool.grading.classes.unpack import kind_of, may_hold_code
from botschool.grading.classes.wall import Broken, broken, walled
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Exercise, Number
from botschool.grading.declare.mistakes import CASES
from botschool.paths import for_make

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
        candidates, unread = _candidates(handed, handed.files, self)
        if not candidates and handed.checkpoints:
            candidates, unread = _candidates(handed, handed.checkpoints, self)
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
        settle(choice, best, handed, new_folder)
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


def _candidates(handed: Handed, files: list[File], wanted: Wanted) -> tuple[list[Candidate], bool]:
    """Return the files that fit, and whether an unreadable one may be the exercise's.

    Files of other names count only if every file of the exercise's name is unchanged, and what the
    course gives out beside the exercises never: its library has modules of similar names.
    """
    courses = {match[1] for file in files if (match := _COURSE.match(file.shown))}
    given = tuple(course + folder for course in courses for folder in GIVEN)
    own = {file for file in files if not file.shown.startswith(given)}
    named = {file for file in own if wanted.stem in squashed(file.name)}
    found, unread = [], False
    for group in (named, own - named):
        for file in sorted(group, key=lambda file: file.shown):
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


def find_submissions(
    people: Iterable[Person], wanted: list[Wanted], root: Path, new_folder: Callable[[], Path]
) -> list[Person]:
    """Choose the file of each exercise among what each person handed in.

    Each person's files are read behind a wall (`walled`): what cannot be read costs only its owner.
    """
    found = list(people)
    for one in found:
        try:
            told = walled(_of_one, one, wanted, root, new_folder())
            one.choices, one.notes, one.is_empty = told
        except Broken as error:
            one.choices = {each.number: _unreadable(error) for each in wanted}
    return found


def _of_one(
    one: Person, wanted: list[Wanted], root: Path, folder: Path
) -> tuple[dict[Number, Choice], list[str], bool]:
    """Return a person's choices and notes, and whether all files are empty.

    folder: for what is unpacked and copied.
    """
    if one.problem:
        return {each.number: Choice(problem=one.problem) for each in wanted}, [], False
    one.new_folder = new_folder = numbered_folders(folder)
    handed, newest_first = one.handed, one.platform in ("canvas", "attempt")
    for each in wanted:
        try:
            one.choices[each.number] = each.choose(handed, new_folder, newest_first)
        except Exception as error:
            one.choices[each.number] = _unreadable(broken(error))
    files, odd = handed.files, handed.links or handed.unread or handed.notes
    is_empty = bool(files) and not odd and not one.files and not any(map(_holds, files))
    return one.choices, [*handed.notes, *_left(one, root)], is_empty


def _holds(file: File) -> bool:
    """Return whether a file has content, or cannot be read."""
    try:
        return bool(file.read(1))
    except OSError:
        return True


def _unreadable(error: Broken) -> Choice:
    problem = f"What was handed in cannot be read ({plain(str(error))}): hand in the file alone."
    return Choice(problem=problem, unread=error.ours)


def _left(one: Person, root: Path) -> list[str]:
    """Return a sentence on unused files, except those that the course gave out."""
    used = set().union(*(choice.used for choice in one.choices.values()))
    courses = {found[1] for file in one.handed.files if (found := _COURSE.match(file.shown))}
    tops, copies = {"", *courses}, bool(courses)
    names = []
    for file in one.handed.files:
        inner = [file.shown[len(top) :] for top in tops if file.shown.startswith(top)]
        given = any(_is_given(name, root, copies) for name in inner)
        if not given and file not in used and file.name not in (TIMESTAMP, CASES):
            names.append(file.shown)
    if not one.files and len(one.handed.files) <= MAX_NAMED:
        names = []  # the problem of each exercise names them
    names += [f"{link} (a link)" for link in one.handed.links]
    return [f"Not used: {listed(names)}."] if names else []


def _is_given(name: str, root: Path, copies: bool) -> bool:
    """Return whether copies of the course have a file of this path."""
    if name.startswith("solutions/") or not (copies or re.match(r"ex\d\d_", name)):
        return False  # no copy has the solutions
    return (root / name).is_file() or (root / "exercises" / name).is_file()


def find_in(place: Path, exercise: Exercise, root: Path, folder: Path) -> Person:
    """Find an exercise in one person's folder, zip file or file, as grade-all finds it.

    folder: a temporary one.
    """
    new_folder = numbered_folders(folder)
    wanted = Wanted(exercise.number, exercise.file, root)
    return find_submissions([one_person(place, new_folder)], [wanted], root, new_folder)[0]


def find_one(place: Path, exercise: Exercise, root: Path, folder: Path) -> Person:
    """Find an exercise as `find_in`. Raises BotschoolError if there is nothing to grade."""
    one = find_in(place, exercise, root, folder)
    choice = one.choices[exercise.number]
    if choice.file is None:
        raise BotschoolError(
            f"{place}: {choice.problem} Name another folder with --submission "
            f"FOLDER{for_make(root)}."
        )
    return one
