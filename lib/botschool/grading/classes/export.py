"""Find the people in a download, and the files of each.

It understands the exports of Moodle, Canvas, Gradescope, GitHub and nbgrader, and a folder with a
sub-folder for each student (docs/specification.md, "Collecting submissions").
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cached_property
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.candidate import Choice, Sought
from botschool.grading.classes.files import File, Handed
from botschool.grading.classes.layouts import (
    GRADESCOPE,
    METADATA,
    SUBMITTED,
    VERSION,
    attempts_of,
    clones_in,
    entries_of,
    holds_exercise,
    is_class,
    is_clone,
    is_folder,
    moment_of,
    read_metadata,
    recognised,
    visible,
    without_tables,
    zips_a_class,
)
from botschool.grading.classes.unpack import DOWNLOAD, Room, Unpackable, unpack
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number

OWN = (".py", ".ipynb", ".pyw", ".zip", ".py.txt", ".ipynb.txt")
"""Suffixes of a file that is a submission by itself."""


@dataclass
class Person:
    """A person who handed in files: one for each exercise, or the reason why there is none."""

    student: str
    """The name to show."""
    folder: str
    """The name of the person's folder in the export, or the prefix of the names of the files."""
    platform: str = ""
    ids: dict[str, str] = field(default_factory=dict)
    """Ids on a platform: participant, user, submission, sid, email."""
    late: bool = False
    """Whether the platform marks the submission as late."""
    submitted: datetime | None = None
    section: str = ""
    """The download, of several side by side."""
    problem: str = ""
    """Why nothing can be graded."""
    upload: list[str] = field(default_factory=list)
    """Names under which the platform takes feedback back."""
    sources: list[tuple[Path, str]] = field(default_factory=list)
    """Folders, and files with the names to show; "" for a file or zip file that is all there is."""
    new_folder: Callable[[], Path] = Path
    """Makes an empty folder for what is unpacked."""
    choices: dict[Number, Choice] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    """Sentences on files that belong to no exercise."""

    @property
    def files(self) -> dict[Number, Path]:
        return {number: each.file for number, each in self.choices.items() if each.file}

    @cached_property
    def handed(self) -> Handed:
        """Return the person's files, read at the first use."""
        handed = Handed(self.new_folder)
        for path, shown in self.sources:
            top = path.absolute().parent
            if path.is_dir():
                handed.add_folder(path)
            elif shown:
                handed.add_file(top, path.name, shown)
            else:
                before, handed.files = handed.files, []
                handed.add_file(top, path.name, path.name, level=-1)
                handed.files = before + _without_top(handed.files)
        return handed


class Export:
    """The people in a download; reading their files is left to Person.handed."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        self.found: dict[tuple[str, ...], Person] = {}
        self.nobodys: list[str] = []
        """Files that belong to no person."""
        self.notes: list[str] = []
        self._new_folder = new_folder
        self._section = ""
        self._alike: set[str] = set()
        """Names of folders that differ only in capitals, in lower case."""

    @property
    def people(self) -> list[Person]:
        return list(self.found.values())

    def entries(self, top: Path, only: list[str] | None = None, sections: bool = True) -> None:
        """Add the people of a folder.

        only: names of its entries, None for all. sections: whether the folder may hold the folders
        and zip files of several classes, instead of people.
        """
        metadata = read_metadata(top) if only is None else {}
        entries = [entry for entry in visible(top) if only is None or entry.name in only]
        attempts = attempts_of([entry.name for entry in entries])
        folders = [entry for entry in entries if is_folder(entry)]
        counts = Counter(entry.name.casefold() for entry in folders)
        self._alike = {name for name, count in counts.items() if count > 1}
        if sections and only is None and self._sections(entries):
            return
        clones = self._clones(folders)
        for entry in entries:
            name, path, is_dir = entry.name, Path(entry.path), is_folder(entry)
            platform, found = recognised(name) or ("", None)
            if entry.is_symlink():
                person = self._person(name.casefold(), name, name)
                person.problem = "The submission is a link to another place."
            elif platform == "moodle":
                self._moodle(path, found, is_dir)
            elif "_assignfeedback_" in name and not platform:
                self.nobodys.append(name)
            elif platform == "gradescope" and is_dir:
                self._gradescope(path, found["id"], metadata.get(name, {}))
            elif platform == "attempt" and not is_dir:
                self._attempt(path, *attempts[name])
            elif platform == "canvas" and not is_dir:
                self._canvas(path, found)
            elif is_dir:
                for each in clones.get(name, [path]):
                    self.folder(each.name, each)
            elif name.lower().endswith(OWN):
                person = self._person(path.stem.casefold(), path.stem, path.stem)
                person.sources.append((path, ""))
            elif name not in METADATA:
                self.nobodys.append(name)
        there = {entry.name for entry in entries}
        for name, about in metadata.items():
            if (found := GRADESCOPE.fullmatch(name)) and name not in there:
                self._gradescope(top / name, found["id"], about)

    def _sections(self, entries: list[os.DirEntry]) -> bool:
        """Add the people of several classes side by side; return False if these are people.

        They are classes if all of them hold the names of a platform: a student may use such names
        within what he hands in.
        """
        inside = {}
        for entry in entries:
            if is_folder(entry):
                holds = is_class([each.name for each in entries_of(Path(entry.path))])
            elif entry.name.lower().endswith(OWN):
                holds = zips_a_class(Path(entry.path))
            else:
                continue
            inside[entry] = holds and not recognised(entry.name)
        if not inside or not all(inside.values()):
            self.notes += [
                f"{plain(entry.name)} holds names that a platform writes, and others "
                "here do not: it counts as one person's. If it is a download, grade it by itself."
                for entry, holds in inside.items()
                if holds
            ]
            return False
        for entry in inside:
            self._class(Path(entry.path))
        return True

    def _class(self, place: Path) -> None:
        """Add the people of a section: a folder, or a zip file of a platform."""
        self._section = place.name
        if place.is_dir():
            self.entries(place, sections=False)
        elif top := _unpacked(place, self._new_folder):
            inner = visible(top)
            in_folder = not is_class(each.name for each in inner)
            self.entries(Path(inner[0].path) if in_folder else top, sections=False)
        else:
            person = self._person(place.stem.casefold(), place.stem, place.stem)
            person.sources.append((place, ""))

    def _clones(self, folders: list[os.DirEntry]) -> dict[str, list[Path]]:
        """Return the repositories in each folder that are people's; {} if the folders are people.

        If repositories in several folders have the same name, each folder is a person; and a folder
        with repositories beside one without is what a student handed in.
        """
        clones = {entry.name: clones_in(Path(entry.path)) for entry in folders}
        names = [each.name.casefold() for group in clones.values() for each in group]
        return clones if all(clones.values()) and len(set(names)) == len(names) else {}

    def folder(self, name: str, path: Path) -> None:
        """Add a person whose folder has the person's name."""
        folded = name.casefold()
        person = self._person(name if folded in self._alike else folded, name, name)
        person.sources.append((path, ""))

    def _moodle(self, path: Path, found: re.Match, is_dir: bool) -> None:
        folder = f"{found['name']}_{found['id']}_assignsubmission_file"
        person = self._person(found["id"], found["name"], folder, "moodle")
        person.ids["participant"] = found["id"]
        person.upload += [path.name] * is_dir
        person.sources.append((path, found["rest"] or f"{found['kind']}.txt"))

    def _canvas(self, path: Path, found: re.Match) -> None:
        folder = f"{found['name']}_{found['id']}"
        name = folder if found["name"] in ("anon", "anonymous") else found["name"]
        person = self._person(found["id"], name, folder, "canvas")
        person.ids |= {"user": found["id"], "submission": found["submission"]}
        person.late = person.late or bool(found["late"])
        person.upload.append(path.name)
        person.sources.append((path, found["rest"]))

    def _attempt(self, path: Path, user: str, shown: str, moment: datetime | None) -> None:
        person = self._person(user.casefold(), user, user, "attempt")
        if shown:  # else the platform's text on the attempt
            person.submitted = max(filter(None, (person.submitted, moment)), default=None)
            person.sources.append((path, shown))

    def _gradescope(self, path: Path, number: str, metadata: dict[str, Any]) -> None:
        submitters = metadata.get("submitters")
        submitters = submitters if isinstance(submitters, list) else []
        people = [each for each in submitters if isinstance(each, dict)]
        for index, submitter in enumerate(people or [{}]):
            told = {key: str(submitter.get(key) or "") for key in ("name", "sid", "email")}
            folder, name = f"{path.name}-{index}", told.pop("name") or path.name
            person = self._person(f"{number}-{index}", name, folder, "gradescope")
            person.ids |= told | {"submission": number}
            person.submitted = moment_of(metadata.get("created_at"))
            person.sources += [(path, "")] * path.is_dir()

    def _person(self, id: str, student: str, folder: str, platform: str = "") -> Person:
        """Return the person of a platform with an id, a new one if there is none yet."""
        name, section = plain(student), self._section
        made = Person(name, folder, platform, section=section, new_folder=self._new_folder)
        return self.found.setdefault((section, platform, id), made)


def _without_top(files: list[File]) -> list[File]:
    """Return the files of one person's zip file, without its name and its only folder."""
    for _ in range(2):
        tops = {file.shown.partition("/")[0] for file in files}
        if len(tops) != 1 or any("/" not in file.shown for file in files):
            break
        top = tops.pop()
        if re.match(r"ex\d\d_", top) or top == "exercises":
            break
        files = [replace(file, shown=file.shown[len(top) + 1 :]) for file in files]
    return files


def read_export(download: Path, wanted: Iterable[Sought], new_folder: Callable[[], Path]) -> Export:
    """Return the people of a folder or a zip file. Raises BotschoolError."""
    wanted, notes, top, is_zip = list(wanted), [], download, download.is_file()
    if is_zip:
        top = new_folder()
        try:
            left_out = unpack(download, top, Room(*DOWNLOAD))
        except Unpackable as error:
            raise BotschoolError(f"{download} {error}: download it again.") from None
        except OSError as error:
            raise BotschoolError(f"{download} cannot be read ({error.strerror}).") from None
        notes = [f"{plain(name)} is a link or leads elsewhere: left out." for name in left_out]
    top = _descend(top, wanted, is_zip)
    for _ in range(2):  # a download that was zipped once more, or lies in a folder as it came
        inner = _only_zip(top)
        if inner and not recognised(inner.name) and (found := _unpacked(inner, new_folder)):
            found = _descend(found, wanted, is_zip=True)
            if any(recognised(entry.name) for entry in visible(found)) or _only_zip(found):
                top, is_zip = found, True
    export = Export(new_folder)
    export.notes += notes
    if _is_copy(top, wanted):
        export.folder(download.stem if is_zip else download.resolve().name, top)
    else:
        export.entries(top)
    if not export.found:
        raise BotschoolError(
            f"{download} holds no submissions: it needs a folder for each student, or must be "
            "a learning platform's zip file."
        )
    return export


def one_person(place: Path, new_folder: Callable[[], Path]) -> Person:
    """Return the content of a folder or a zip file, or a single file, as one submission."""
    export = Export(new_folder)
    names = [place.name] if place.is_file() else [entry.name for entry in visible(place)]
    if any(map(recognised, names)):
        export.entries(place.parent if place.is_file() else place, only=names)
        if len(export.found) == 1:
            return export.people[0]
    return Person(plain(place.name), place.name, sources=[(place, "")], new_folder=new_folder)


def _unpacked(archive: Path, new_folder: Callable[[], Path]) -> Path | None:
    """Return a folder with the content of a zip file; None if it stays packed."""
    top = new_folder()
    try:
        unpack(archive, top, Room(*DOWNLOAD))
    except (Unpackable, OSError):
        return None
    return top


def _only_zip(top: Path) -> Path | None:
    """Return a folder's only zip file, if nothing else is there but tables of the class."""
    for _ in range(5):
        entries = without_tables(top)
        if len(entries) != 1 or entries[0].is_symlink():
            break
        path = Path(entries[0].path)
        if not is_folder(entries[0]):
            return path if path.name.lower().endswith(".zip") else None
        if recognised(path.name):
            break
        top = path
    return None


def _is_copy(folder: Path, wanted: list[Sought]) -> bool:
    """Return whether a folder is itself a submission: a copy of the course, or its files."""
    names = [(f"exercises/{one.folder}", one.folder, one.file) for one in wanted]
    paths = [folder / each for group in names for each in group]
    return any(path.exists() and not path.is_symlink() for path in paths)


def _descend(top: Path, wanted: list[Sought], is_zip: bool) -> Path:
    """Return the folder that holds the people: `top`, or its only sub-folder, at any depth."""
    inner = top
    for _ in range(8):
        if (inner / "nbgrader_config.py").is_file() and (inner / SUBMITTED).is_dir():
            return inner / SUBMITTED
        entries = without_tables(inner)
        alone = len(entries) == 1 and is_folder(entries[0])
        if not alone or recognised(entries[0].name) or _is_copy(inner, wanted):
            break
        inner = Path(entries[0].path)
    if inner == top or _is_copy(inner, wanted):
        return top
    folders = [Path(entry.path) for entry in visible(inner) if is_folder(entry)]
    zips = [Path(e.path) for e in visible(inner) if e.name.lower().endswith(".zip")]
    people = [each for each in folders if not VERSION.fullmatch(each.name)]
    if (
        any(recognised(entry.name) for entry in visible(inner))
        or sum(map(is_clone, folders)) > 1
        or (inner.name == SUBMITTED and folders)
        or (is_zip and len(folders) > 1)
        or sum(holds_exercise(path, wanted) for path in people) > 1
        or sum(holds_exercise(path, wanted) for path in zips) > 1
    ):
        return inner
    return top
