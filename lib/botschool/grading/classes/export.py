"""Find the people in a download, and the files of each.

It understands the exports of Moodle, Canvas, Gradescope, GitHub and nbgrader, and a folder with a
sub-folder for each student (docs/specification.md, "Collecting submissions").
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import Wanted
from botschool.grading.classes.files import Collector, Handed, is_junk
from botschool.grading.classes.times import METADATA, moment_of, read_metadata
from botschool.grading.classes.unpack import Unpackable, room_of_download, unpack
from botschool.grading.declare.checks import plain

MAXMETADATA, MAX_VALUES = 20 * 2**20, 5_000_000
_MOODLE = re.compile(
    r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<rest>.*))?", re.DOTALL
)
_CANVAS = re.compile(
    r"(?P<name>.+?)_(?P<late>LATE_)?(?P<id>\d+|(?<=anon_)[^\W_]{5}|(?<=anonymous_)[^\W_]{5})"
    r"_(?P<submission>\d+)_(?P<rest>.+)",
    re.DOTALL,
)
_VERSION = re.compile(
    r"(?i)(v|ver|version|attempt|try|old|new|backup|copy|final|draft|week|ex|exercise|task"
    r"|submission)?[\W_]*\d*"
)
"""Names of folders in which one person keeps several versions, or several exercises."""
_GRADESCOPE = re.compile(r"submission_(?P<id>\d+)")
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
    people = _People(new_folder)
    if _is_copy(top, wanted):
        people.folder(download.stem if is_zip else download.resolve().name, top)
    else:
        people.entries(top)
    if not people.found:
        raise BotschoolError(
            f"{download} holds no submissions: it needs a folder for each student, or must be "
            "a learning platform's zip file."
        )
    return Export(list(people.found.values()), people.nobodys, notes)


def one_person(place: Path, new_folder: Callable[[], Path]) -> Person:
    """Return the content of a folder or a zip file, or a single file, as one submission."""
    people = _People(new_folder)
    names = [place.name] if place.is_file() else [entry.name for entry in _visible(place)]
    if any(_is_of_platform(name) for name in names):
        people.entries(place.parent if place.is_file() else place, only=names)
        if len(people.found) == 1:
            return next(iter(people.found.values()))
    person = Person(plain(place.name), place.name)
    collector = Collector(new_folder)
    if place.is_dir():
        collector.add_folder(place)
    else:
        place = place.absolute()
        collector.add_file(place.parent, place.name, place.name)
    person.handed = collector.handed
    return person


def _only_zip(top: Path) -> Path | None:
    """Return a folder's only zip file, if nothing else is there but tables of the class."""
    for _ in range(5):
        tables = (".csv", ".yaml", ".yml")
        entries = [e for e in _visible(top) if not e.name.lower().endswith(tables)]
        if len(entries) != 1 or entries[0].is_symlink():
            break
        if not _is_folder(entries[0]):
            is_zip = entries[0].name.lower().endswith(".zip")
            return Path(entries[0].path) if is_zip else None
        if _is_of_platform(entries[0].name):
            break
        top = Path(entries[0].path)
    return None


def _unpacked(archive: Path, wanted: list[Wanted], new_folder: Callable[[], Path]) -> Path | None:
    """Return the folder of a platform's zip file inside another one; None for a submission."""
    if _is_of_platform(archive.name):
        return None
    top = new_folder()
    try:
        unpack(archive, top, room_of_download())
    except (Unpackable, OSError):
        return None
    top = _descend(top, wanted, is_zip=True)
    is_class = any(_is_of_platform(entry.name) for entry in _visible(top))
    return top if is_class or _only_zip(top) else None


def _visible(folder: Path) -> list[os.DirEntry]:
    try:
        with os.scandir(folder) as entries:
            found = [e for e in entries if not e.name.startswith(".") and not is_junk(e.name)]
    except OSError as error:
        raise BotschoolError(f"{folder} cannot be read ({error.strerror}).") from None
    return sorted(found, key=lambda entry: entry.name)


def _is_folder(entry: os.DirEntry) -> bool:
    return entry.is_dir(follow_symlinks=False)


def _is_of_platform(name: str) -> bool:
    return bool(_MOODLE.fullmatch(name) or _CANVAS.fullmatch(name) or _GRADESCOPE.fullmatch(name))


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
        if (inner / "nbgrader_config.py").is_file() and (inner / "submitted").is_dir():
            return inner / "submitted"
        entries = _visible(inner)
        alone = len(entries) == 1 and _is_folder(entries[0])
        if not alone or _is_of_platform(entries[0].name) or _is_copy(inner, wanted):
            break
        inner = Path(entries[0].path)
    if inner == top or _is_copy(inner, wanted):
        return top
    folders = [entry for entry in _visible(inner) if _is_folder(entry)]
    platform = any(_is_of_platform(entry.name) for entry in _visible(inner))
    clones = sum((Path(entry.path) / ".git").exists() for entry in folders)
    named = inner.name == "submitted" and bool(folders)
    several = len(folders) > 1 and (is_zip or _are_people(folders, wanted))
    return inner if platform or clones > 1 or named or several else top


def _are_people(folders: list[os.DirEntry], wanted: list[Wanted]) -> bool:
    """Return whether at least two folders hold an exercise without being versions of one."""
    holding = [
        entry
        for entry in folders
        if not _VERSION.fullmatch(entry.name)
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


class _People:
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
        entries = [entry for entry in _visible(top) if only is None or entry.name in only]
        folders = Counter(entry.name.casefold() for entry in entries if _is_folder(entry))
        self._alike = {name for name, count in folders.items() if count > 1}
        for entry in entries:
            name, path = entry.name, Path(entry.path)
            if entry.is_symlink():
                person = self._person(("folder", name.casefold()), plain(_shown(name)), name)
                person.problem = "The submission is a link to another place."
            elif "_assignfeedback_" in name:
                self.nobodys.append(_shown(name))
            elif found := _MOODLE.fullmatch(name):
                self._moodle(entry, found)
            elif (found := _GRADESCOPE.fullmatch(name)) and _is_folder(entry):
                self._gradescope(path, found["id"], metadata.get(name, {}))
            elif (found := _CANVAS.fullmatch(name)) and not _is_folder(entry):
                self._canvas(entry, found)
            elif _is_folder(entry):
                clones = _clones(path)
                for each in clones or [path]:
                    self.folder(each.name, each)
            elif path.suffix.lower() in CODE or re.search(r"(?i)\.(py|ipynb)\.txt$", name):
                self._loose(path)
            elif name not in METADATA:
                self.nobodys.append(_shown(name))
        there = {entry.name for entry in entries}
        for name, about in metadata.items():
            if (found := _GRADESCOPE.fullmatch(name)) and name not in there and only is None:
                self._gradescope(top / name, found["id"], about)

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
            self._collectors[key].add_file(path.parent, path.name, path.name)
            files = self._collectors[key].handed.files
            self._collectors[key].handed.files = files[:before] + _without_top(files[before:])
        else:
            self._collectors[key].add_file(path.parent, path.name, path.name)

    def _moodle(self, entry: os.DirEntry, found: re.Match) -> None:
        key, path = ("moodle", found["id"]), Path(entry.path)
        folder = f"{found['name']}_{found['id']}_assignsubmission_file"
        person = self._person(key, plain(_shown(found["name"])), folder, "moodle")
        person.ids["participant"] = found["id"]
        if _is_folder(entry):
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


def _without_top(files: list) -> list:
    """Return the files of one person's zip file, without its name and its only folder."""
    from dataclasses import replace

    for _ in range(2):
        tops = {file.shown.partition("/")[0] for file in files}
        if len(tops) != 1 or any("/" not in file.shown for file in files):
            break
        top = tops.pop()
        if re.match(r"ex\d\d_", top) or top == "exercises":
            break
        files = [replace(file, shown=file.shown[len(top) + 1 :]) for file in files]
    return files


def _clones(folder: Path) -> list[Path]:
    """Return the repositories in a folder that is not one itself, if there are several."""
    if (folder / ".git").exists():
        return []
    try:
        with os.scandir(folder) as entries:
            inner = sorted(Path(entry.path) for entry in entries if _is_folder(entry))
    except OSError:
        return []
    clones = [path for path in inner if (path / ".git").exists()]
    return clones if len(clones) > 1 and len(clones) == len(inner) else []
