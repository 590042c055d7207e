"""Collect the people of a download, and the files of each."""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from typing import Any

from botschool.grading.classes.files import Collector, File, Handed
from botschool.grading.classes.layouts import (
    CANVAS,
    GRADESCOPE,
    MOODLE,
    attempts_of,
    clones_in,
    entries_of,
    is_class,
    is_folder,
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
    handed: Handed = field(default_factory=Handed)
    problem: str = ""
    """Why nothing can be graded."""
    upload: list[str] = field(default_factory=list)
    """Names under which the platform takes feedback back."""


class People:
    """Collect people from the entries of a folder."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        self.found: dict[tuple[str, str], Person] = {}
        self.nobodys: list[str] = []
        self._new_folder = new_folder
        self._collectors: dict[tuple[str, str], Collector] = {}
        self._alike: set[str] = set()
        """Names of folders that differ only in capitals, in lower case."""

    def entries(self, top: Path, only: list[str] | None = None) -> None:
        """Add the people of a folder; only: names of its entries, None for all."""
        metadata = read_metadata(top)
        entries = [entry for entry in visible(top) if only is None or entry.name in only]
        attempts = attempts_of([entry.name for entry in entries])
        clones = {entry.name: clones_in(Path(entry.path)) for entry in entries if is_folder(entry)}
        names = Counter(each.name.casefold() for group in clones.values() for each in group)
        folders = Counter(entry.name.casefold() for entry in entries if is_folder(entry))
        self._alike = {name for name, count in folders.items() if count > 1}
        for entry in entries:
            name, path = entry.name, Path(entry.path)
            if entry.is_symlink():
                person = self._person(("folder", name.casefold()), plain(_shown(name)), name)
                person.problem = "The submission is a link to another place."
            elif "_assignfeedback_" in name:
                self.nobodys.append(_shown(name))
            elif found := MOODLE.fullmatch(name):
                self._moodle(entry, found)
            elif (found := GRADESCOPE.fullmatch(name)) and is_folder(entry):
                self._gradescope(path, found["id"], metadata.get(name, {}))
            elif name in attempts and not is_folder(entry):
                self._attempt(path, *attempts[name])
            elif (found := CANVAS.fullmatch(name)) and not is_folder(entry):
                self._canvas(entry, found)
            elif is_folder(entry) and is_class(each.name for each in entries_of(path)):
                self.entries(path)
            elif is_folder(entry):
                # repositories of the same names in several folders: each folder is a person
                own = all(names[each.name.casefold()] == 1 for each in clones[name])
                for each in (own and clones[name]) or [path]:
                    self.folder(each.name, each)
            elif path.suffix.lower() == ".zip" and zips_a_class(path) and self._class(path):
                pass
            elif path.suffix.lower() in CODE or re.search(r"(?i)\.(py|ipynb)\.txt$", name):
                self._loose(path)
            elif name not in METADATA:
                self.nobodys.append(_shown(name))
        there = {entry.name for entry in entries}
        for name, about in metadata.items():
            if (found := GRADESCOPE.fullmatch(name)) and name not in there and only is None:
                self._gradescope(top / name, found["id"], about)

    def _class(self, archive: Path) -> bool:
        """Add the people of a platform's zip file; return False if it cannot be unpacked."""
        top = self._new_folder()
        try:
            unpack(archive, top, room_of_download())
        except (Unpackable, OSError):
            return False
        inner = visible(top)
        self.entries(Path(inner[0].path) if not is_class(e.name for e in inner) else top)
        return True

    def folder(self, name: str, path: Path) -> None:
        """Add a person whose folder has the person's name."""
        folded = name.casefold()
        key = ("folder", name if folded in self._alike else folded)
        self._person(key, plain(_shown(name)), name)
        self._collectors[key].add_folder(path)

    def _loose(self, path: Path) -> None:
        key = ("folder", path.stem.casefold())
        self._person(key, plain(_shown(path.stem)), path.stem)
        if path.suffix.lower() == ".zip":
            before = len(self._collectors[key].handed.files)
            self._collectors[key].add_file(path.parent, path.name, path.name, level=-1)
            files = self._collectors[key].handed.files
            self._collectors[key].handed.files = files[:before] + _without_top(files[before:])
        else:
            self._collectors[key].add_file(path.parent, path.name, path.name)

    def _moodle(self, entry: os.DirEntry, found: re.Match) -> None:
        key, path = ("moodle", found["id"]), Path(entry.path)
        folder = f"{found['name']}_{found['id']}_assignsubmission_file"
        person = self._person(key, plain(_shown(found["name"])), folder, "moodle")
        person.ids["participant"] = found["id"]
        if is_folder(entry):
            person.upload.append(entry.name)
            self._collectors[key].add_folder(path)
        else:
            rest = found["rest"] or f"{found['kind']}.txt"
            self._collectors[key].add_file(path.parent, path.name, rest)

    def _canvas(self, entry: os.DirEntry, found: re.Match) -> None:
        key, path = ("canvas", found["id"]), Path(entry.path)
        folder = f"{found['name']}_{found['id']}"
        name = folder if found["name"] in ("anon", "anonymous") else found["name"]
        person = self._person(key, plain(_shown(name)), folder, "canvas")
        person.ids |= {"user": found["id"], "submission": found["submission"]}
        person.late = person.late or bool(found["late"])
        person.upload.append(entry.name)
        self._collectors[key].add_file(path.parent, path.name, found["rest"])

    def _attempt(self, path: Path, user: str, shown: str, moment: datetime | None) -> None:
        key = ("attempt", user.casefold())
        person = self._person(key, plain(_shown(user)), user, "attempt")
        if shown:  # else the platform's text on the attempt
            person.submitted = max(filter(None, (person.submitted, moment)), default=None)
            self._collectors[key].add_file(path.parent, path.name, shown)

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
                self._collectors[key].add_folder(path)

    def _person(
        self, key: tuple[str, str], student: str, folder: str, platform: str = ""
    ) -> Person:
        if key not in self.found:
            self._collectors[key] = Collector(self._new_folder)
            handed = self._collectors[key].handed
            self.found[key] = Person(student, folder, platform, handed=handed)
        return self.found[key]


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
