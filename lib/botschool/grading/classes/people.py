"""Collect the people of a download, and the files of each."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import datetime
from functools import cached_property, partial
from pathlib import Path
from typing import Any

from botschool.grading.classes.files import Collector, File, Handed
from botschool.grading.classes.layouts import (
    GRADESCOPE,
    attempts_of,
    clones_in,
    entries_of,
    is_class,
    is_folder,
    recognised,
    visible,
    zips_a_class,
)
from botschool.grading.classes.times import METADATA, moment_of, read_metadata
from botschool.grading.classes.unpack import Unpackable, room_of_download, unpack
from botschool.grading.declare.checks import plain

CODE = (".py", ".ipynb", ".pyw", ".zip")
"""Suffixes of a file that is a submission by itself."""


@dataclass
class Person:
    """A person who handed in files."""

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
    sources: list[Callable[[Collector], object]] = field(default_factory=list)
    """What adds the person's files to a collector."""
    new_folder: Callable[[], Path] = Path
    """Makes an empty folder for what is unpacked."""

    @cached_property
    def handed(self) -> Handed:
        """Return the person's files, read at the first use."""
        collector = Collector(self.new_folder)
        for add in self.sources:
            add(collector)
        return collector.handed


class People:
    """Collect people from the entries of a folder; reading their files is left to Person.handed."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        self.found: dict[tuple[str, ...], Person] = {}
        self.nobodys: list[str] = []
        self.notes: list[str] = []
        self._new_folder = new_folder
        self._section = ""
        self._alike: set[str] = set()
        """Names of folders that differ only in capitals, in lower case."""

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
            name, path = entry.name, Path(entry.path)
            platform, found = recognised(name) or ("", None)
            if entry.is_symlink():
                person = self._person(("folder", name.casefold()), plain(_shown(name)), name)
                person.problem = "The submission is a link to another place."
            elif platform == "moodle":
                self._moodle(entry, found)
            elif "_assignfeedback_" in name and not platform:
                self.nobodys.append(_shown(name))
            elif platform == "gradescope" and is_folder(entry):
                self._gradescope(path, found["id"], metadata.get(name, {}))
            elif platform == "attempt" and not is_folder(entry):
                self._attempt(path, *attempts[name])
            elif platform == "canvas" and not is_folder(entry):
                self._canvas(entry, found)
            elif is_folder(entry):
                for each in clones.get(name, [path]):
                    self.folder(each.name, each)
            elif is_own(name):
                self._loose(path)
            elif name not in METADATA:
                self.nobodys.append(_shown(name))
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
        for entry in [each for each in entries if is_folder(each) or is_own(each.name)]:
            names = [each.name for each in entries_of(Path(entry.path))] * is_folder(entry)
            holds = is_class(names) if is_folder(entry) else zips_a_class(Path(entry.path))
            inside[entry] = holds and not recognised(entry.name)
        if not inside or not all(inside.values()):
            self.notes += [
                f"{plain(_shown(entry.name))} holds names that a platform writes, and others here "
                "do not: it counts as one person's. If it is a download, grade it by itself."
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
            return
        top = self._new_folder()
        try:
            unpack(place, top, room_of_download())
        except (Unpackable, OSError):
            self._loose(place)
            return
        inner = visible(top)
        in_folder = not is_class(each.name for each in inner)
        self.entries(Path(inner[0].path) if in_folder else top, sections=False)

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
        key = ("folder", name if folded in self._alike else folded)
        self._person(key, plain(_shown(name)), name).sources.append(_folder(path))

    def _loose(self, path: Path) -> None:
        key = ("folder", path.stem.casefold())
        person = self._person(key, plain(_shown(path.stem)), path.stem)
        is_zip = path.suffix.lower() == ".zip"
        person.sources.append(partial(_add_zip, path) if is_zip else _file(path, path.name))

    def _moodle(self, entry: os.DirEntry, found: re.Match) -> None:
        key, path = ("moodle", found["id"]), Path(entry.path)
        folder = f"{found['name']}_{found['id']}_assignsubmission_file"
        person = self._person(key, plain(_shown(found["name"])), folder, "moodle")
        person.ids["participant"] = found["id"]
        if is_folder(entry):
            person.upload.append(entry.name)
            person.sources.append(_folder(path))
        else:
            rest = found["rest"] or f"{found['kind']}.txt"
            person.sources.append(_file(path, rest))

    def _canvas(self, entry: os.DirEntry, found: re.Match) -> None:
        key, path = ("canvas", found["id"]), Path(entry.path)
        folder = f"{found['name']}_{found['id']}"
        name = folder if found["name"] in ("anon", "anonymous") else found["name"]
        person = self._person(key, plain(_shown(name)), folder, "canvas")
        person.ids |= {"user": found["id"], "submission": found["submission"]}
        person.late = person.late or bool(found["late"])
        person.upload.append(entry.name)
        person.sources.append(_file(path, found["rest"]))

    def _attempt(self, path: Path, user: str, shown: str, moment: datetime | None) -> None:
        key = ("attempt", user.casefold())
        person = self._person(key, plain(_shown(user)), user, "attempt")
        if shown:  # else the platform's text on the attempt
            person.submitted = max(filter(None, (person.submitted, moment)), default=None)
            person.sources.append(_file(path, shown))

    def _gradescope(self, path: Path, number: str, metadata: dict[str, Any]) -> None:
        submitters = metadata.get("submitters")
        submitters = submitters if isinstance(submitters, list) else []
        people = [each for each in submitters if isinstance(each, dict)]
        for index, submitter in enumerate(people or [{}]):
            key = ("gradescope", f"{number}-{index}")
            name = str(submitter.get("name") or path.name)
            person = self._person(key, plain(name), f"{path.name}-{index}", "gradescope")
            named = {name: str(submitter.get(name) or "") for name in ("sid", "email")}
            person.ids |= named | {"submission": number}
            person.submitted = moment_of(metadata.get("created_at"))
            if path.is_dir():
                person.sources.append(_folder(path))

    def _person(
        self, key: tuple[str, str], student: str, folder: str, platform: str = ""
    ) -> Person:
        section = self._section
        made = Person(student, folder, platform, section=section, new_folder=self._new_folder)
        return self.found.setdefault((section, *key), made)


def is_own(name: str) -> bool:
    """Return whether a file of this name is a submission by itself."""
    return name.lower().endswith((*CODE, ".py.txt", ".ipynb.txt"))


def _folder(path: Path) -> Callable[[Collector], None]:
    return lambda collector: collector.add_folder(path)


def _file(path: Path, shown: str) -> Callable[[Collector], object]:
    return lambda collector: collector.add_file(path.parent, path.name, shown)


def _add_zip(path: Path, collector: Collector) -> None:
    before = collector.handed.files
    collector.handed.files = []
    collector.add_file(path.parent, path.name, path.name, level=-1)
    collector.handed.files = before + _without_top(collector.handed.files)


def _shown(name: str) -> str:
    return os.fsencode(name).decode(errors="replace")


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
