"""Find the people in a download, and the files of each.

It understands the exports of Moodle, Canvas, Gradescope, GitHub and nbgrader, and a folder with a
sub-folder for each student (docs/specification.md, "Collecting submissions").
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import Wanted
from botschool.grading.classes.files import Collector
from botschool.grading.classes.layouts import (
    TABLES,
    VERSION,
    holds_exercise,
    is_clone,
    is_folder,
    is_of_platform,
    visible,
)
from botschool.grading.classes.people import People, Person
from botschool.grading.classes.times import SUBMITTED
from botschool.grading.classes.unpack import Unpackable, room_of_download, unpack
from botschool.grading.declare.checks import plain


@dataclass
class Export:
    """The contents of a download."""

    people: list[Person]
    nobodys: list[str]
    """Files that belong to no person."""
    notes: list[str]


def read_export(download: Path, wanted: Iterable[Wanted], new_folder: Callable[[], Path]) -> Export:
    """Return the people of a folder or a zip file. Raises BotschoolError."""
    wanted, notes = list(wanted), []
    if download.is_file():
        top = new_folder()
        try:
            left_out = unpack(download, top, room_of_download())
        except Unpackable as error:
            raise BotschoolError(f"{download} {error}: download it again.") from None
        except OSError as error:
            raise BotschoolError(f"{download} cannot be read ({error.strerror}).") from None
        notes = [f"{plain(name)} is a link or leads elsewhere: left out." for name in left_out]
    else:
        top = download
    is_zip = top != download
    top = _descend(top, wanted, is_zip)
    for _ in range(2):  # a download that was zipped once more, or lies in a folder as it came
        if (inner := _only_zip(top)) and (found := _unpacked(inner, wanted, new_folder)):
            top, is_zip = found, True
    people = People(new_folder)
    if _is_copy(top, wanted):
        people.folder(download.stem if is_zip else download.resolve().name, top)
    else:
        people.entries(top)
    if not people.found:
        raise BotschoolError(
            f"{download} holds no submissions: it needs a folder for each student, or must be "
            "a learning platform's zip file."
        )
    return Export(list(people.found.values()), people.nobodys, notes + people.notes)


def one_person(place: Path, new_folder: Callable[[], Path]) -> Person:
    """Return the content of a folder or a zip file, or a single file, as one submission."""
    people = People(new_folder)
    names = [place.name] if place.is_file() else [entry.name for entry in visible(place)]
    if any(is_of_platform(name) for name in names):
        people.entries(place.parent if place.is_file() else place, only=names)
        if len(people.found) == 1:
            return next(iter(people.found.values()))

    def add(collector: Collector) -> None:
        if place.is_dir():
            collector.add_folder(place)
        else:
            collector.add_file(place.absolute().parent, place.name, place.name, level=-1)

    return Person(plain(place.name), place.name, sources=[add], new_folder=new_folder)


def _only_zip(top: Path) -> Path | None:
    """Return a folder's only zip file, if nothing else is there but tables of the class."""
    for _ in range(5):
        entries = [e for e in visible(top) if not e.name.lower().endswith(TABLES)]
        if len(entries) != 1 or entries[0].is_symlink():
            break
        if not is_folder(entries[0]):
            is_zip = entries[0].name.lower().endswith(".zip")
            return Path(entries[0].path) if is_zip else None
        if is_of_platform(entries[0].name):
            break
        top = Path(entries[0].path)
    return None


def _unpacked(archive: Path, wanted: list[Wanted], new_folder: Callable[[], Path]) -> Path | None:
    """Return the folder of a platform's zip file inside another one; None for a submission."""
    if is_of_platform(archive.name):
        return None
    top = new_folder()
    try:
        unpack(archive, top, room_of_download())
    except (Unpackable, OSError):
        return None
    top = _descend(top, wanted, is_zip=True)
    is_class = any(is_of_platform(entry.name) for entry in visible(top))
    return top if is_class or _only_zip(top) else None


def _is_copy(folder: Path, wanted: list[Wanted]) -> bool:
    """Return whether a folder is itself a submission: a copy of the course, or its files."""
    for one in wanted:
        for place in (f"exercises/{one.folder}", one.folder, one.file):
            path = folder / place
            if path.exists() and not path.is_symlink():
                return True
    return False


def _descend(top: Path, wanted: list[Wanted], is_zip: bool) -> Path:
    """Return the folder that holds the people: `top`, or its only sub-folder, at any depth."""
    inner = top
    for _ in range(8):
        if (inner / "nbgrader_config.py").is_file() and (inner / SUBMITTED).is_dir():
            return inner / SUBMITTED
        entries = [e for e in visible(inner) if not e.name.lower().endswith(TABLES)]
        alone = len(entries) == 1 and is_folder(entries[0])
        if not alone or is_of_platform(entries[0].name) or _is_copy(inner, wanted):
            break
        inner = Path(entries[0].path)
    if inner == top or _is_copy(inner, wanted):
        return top
    folders = [entry for entry in visible(inner) if is_folder(entry)]
    platform = any(is_of_platform(entry.name) for entry in visible(inner))
    clones = sum(is_clone(Path(entry.path)) for entry in folders)
    named = inner.name == SUBMITTED and bool(folders)
    several = len(folders) > 1 and (is_zip or _are_people(folders, wanted))
    zips = [Path(e.path) for e in visible(inner) if e.name.lower().endswith(".zip")]
    several |= sum(holds_exercise(path, wanted) for path in zips) > 1
    return inner if platform or clones > 1 or named or several else top


def _are_people(folders: list[os.DirEntry], wanted: list[Wanted]) -> bool:
    """Return whether at least two folders hold an exercise without being versions of one."""
    holding = [
        entry
        for entry in folders
        if not VERSION.fullmatch(entry.name)
        and any(_holds(Path(entry.path), one.file) for one in wanted)
    ]
    return len(holding) > 1


def _holds(folder: Path, name: str) -> bool:
    """Return whether a file of the exercise's name is somewhere in a folder."""
    stem = Path(name).stem.casefold()
    for number, (_, _, files) in enumerate(os.walk(folder)):
        if any(stem in file.casefold() for file in files):
            return True
        if number > 200:
            break
    return False
