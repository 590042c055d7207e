"""Who is in a download: the people of an export, and the files of each.

It understands what Moodle, Canvas, Gradescope, GitHub and nbgrader write, and a folder that holds
a sub-folder for each student (docs/specification.md, "Collecting submissions").
"""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import datetime
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import Wanted
from botschool.grading.classes.files import Collector, Handed, is_junk
from botschool.grading.classes.texts import is_larger
from botschool.grading.classes.unpack import Unpackable, room_of_download, unpack
from botschool.grading.declare.checks import plain

MAX_METADATA, MAX_VALUES = 20 * 2**20, 5_000_000
_MOODLE = re.compile(
    r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<rest>.*))?", re.DOTALL
)
_CANVAS = re.compile(
    r"(?P<name>[^_]+)_(?P<late>LATE_)?(?P<id>\d+)_(?P<submission>\d+)_(?P<rest>.+)", re.DOTALL
)
_GRADESCOPE = re.compile(r"submission_(?P<id>\d+)")
_METADATA = ("submission_metadata.yml", "submission_metadata.yaml")
CODE = (".py", ".ipynb", ".pyw", ".zip")
"""Suffixes of a file that is a submission by itself."""


@dataclass
class Person:
    """Somebody who handed something in."""

    student: str
    """The name to show."""
    folder: str
    """The name of his folder in the export, or the beginning of the names of his files."""
    platform: str = ""
    ids: dict[str, str] = field(default_factory=dict)
    """Of a platform: participant, user, submission, sid, email."""
    late: bool = False
    """Whether the platform says so."""
    submitted: datetime | None = None
    handed: Handed = field(default_factory=Handed)
    problem: str = ""
    """Why nothing of it can be graded."""
    upload: list[str] = field(default_factory=list)
    """Names under which the platform takes feedback back."""


@dataclass
class Export:
    """What a download holds."""

    people: list[Person]
    nobodys: list[str]
    """Files that belong to nobody."""
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
    top = _descend(top, wanted, is_zip=top != download)
    people = _People(new_folder)
    if _is_copy(top, wanted):
        people.folder(download.stem if top != download else download.resolve().name, top)
    else:
        people.entries(top)
    if not people.found:
        raise BotschoolError(
            f"{download} holds no submissions: a folder for each student is needed, or the zip "
            "file of a learning platform."
        )
    return Export(list(people.found.values()), people.nobodys, notes)


def one_person(place: Path, new_folder: Callable[[], Path]) -> Person:
    """Return what lies in a folder, a zip file, or is a single file, as somebody's submission."""
    person = Person(plain(place.name), place.name)
    collector = Collector(new_folder)
    if place.is_dir():
        collector.add_folder(place)
    else:
        place = place.absolute()
        collector.add_file(place.parent, place.name, place.name)
    person.handed = collector.handed
    return person


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
    """Return the folder that holds the people: `top`, or one that is alone in it."""
    for _ in range(5):
        entries = _visible(top)
        if (top / "nbgrader_config.py").is_file() and (top / "submitted").is_dir():
            return top / "submitted"
        if len(entries) != 1 or not _is_folder(entries[0]) or _is_of_platform(entries[0].name):
            return top
        inner = Path(entries[0].path)
        if _is_copy(inner, wanted):
            return top
        within = _visible(inner)
        folders = [entry for entry in within if _is_folder(entry)]
        platform = any(_is_of_platform(entry.name) for entry in within)
        clones = sum((Path(entry.path) / ".git").exists() for entry in folders)
        single = is_zip and len(within) == 1 and len(folders) == 1
        if not (platform or clones > 1 or single or (is_zip and len(folders) > 1)):
            return top
        top = inner
    return top


class _People:
    """Gathers people from the entries of a folder."""

    def __init__(self, new_folder: Callable[[], Path]) -> None:
        self.found: dict[tuple[str, str], Person] = {}
        self.nobodys: list[str] = []
        self._new_folder = new_folder
        self._collectors: dict[tuple[str, str], Collector] = {}

    def entries(self, top: Path) -> None:
        metadata = _read_metadata(top)
        for entry in _visible(top):
            name, path = entry.name, Path(entry.path)
            if entry.is_symlink():
                person = self._person(("folder", name.casefold()), plain(_shown(name)), name)
                person.problem = "The submission is a link to another place."
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
            elif name not in _METADATA:
                self.nobodys.append(_shown(name))

    def folder(self, name: str, path: Path) -> None:
        """Somebody whose folder has his name."""
        self._person(("folder", name.casefold()), plain(_shown(name)), name)
        self._collectors["folder", name.casefold()].add_folder(path)

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
        person = self._person(key, plain(_shown(found["name"])), folder, "canvas")
        person.ids |= {"user": found["id"], "submission": found["submission"]}
        person.late = person.late or bool(found["late"])
        person.upload.append(entry.name)
        self._collectors[key].add_file(path.parent, path.name, found["rest"])

    def _gradescope(self, path: Path, number: str, metadata: dict[str, Any]) -> None:
        people = [each for each in metadata.get("submitters", ()) if isinstance(each, dict)]
        for index, submitter in enumerate(people or [{}]):
            key = ("gradescope", f"{number}-{index}")
            name = str(submitter.get("name") or path.name)
            person = self._person(key, plain(name), f"{path.name}-{index}", "gradescope")
            named = {name: str(submitter.get(name) or "") for name in ("sid", "email")}
            person.ids |= named | {"submission": number}
            person.submitted = _moment(metadata.get("created_at"))
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
    """Return the files of a zip file that is one person's, without its name and its only folder."""
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
    """Return the repositories in a folder that is none itself, if there are several."""
    if (folder / ".git").exists():
        return []
    try:
        with os.scandir(folder) as entries:
            inner = sorted(Path(entry.path) for entry in entries if _is_folder(entry))
    except OSError:
        return []
    clones = [path for path in inner if (path / ".git").exists()]
    return clones if len(clones) > 1 and len(clones) == len(inner) else []


def _read_metadata(folder: Path) -> dict[str, dict[str, Any]]:
    """Return what Gradescope says of each submission, without the colons of its keys."""
    import yaml

    class Loader(yaml.SafeLoader):
        """Reads what other languages mark as objects as plain data."""

    def unmarked(loader: Any, suffix: str, node: Any) -> Any:
        if isinstance(node, yaml.MappingNode):
            return loader.construct_mapping(node, deep=True)
        if isinstance(node, yaml.SequenceNode):
            return loader.construct_sequence(node, deep=True)
        return loader.construct_scalar(node)

    Loader.add_multi_constructor("!", unmarked)
    Loader.add_multi_constructor("tag:", unmarked)
    for name in _METADATA:
        path = folder / name
        if path.is_symlink() or not path.is_file() or path.stat().st_size > MAX_METADATA:
            continue
        try:
            found = yaml.load(path.read_text(encoding="utf-8-sig", errors="replace"), Loader)
        except (yaml.YAMLError, OSError, RecursionError, ValueError):
            raise BotschoolError(f"{path} is damaged: download it again.") from None
        if is_larger(found, MAX_VALUES):
            raise BotschoolError(f"{path} holds too many values: download it again.")
        plain_keys = _plain_keys(found, 0)
        return {k: v for k, v in plain_keys.items() if isinstance(v, dict)} if found else {}
    return {}


def _plain_keys(value: Any, depth: int) -> Any:
    if isinstance(value, dict) and depth < 6:
        return {str(k).lstrip(":"): _plain_keys(v, depth + 1) for k, v in value.items()}
    if isinstance(value, list) and depth < 6:
        return [_plain_keys(each, depth + 1) for each in value]
    return value


def _moment(value: Any) -> datetime | None:
    try:
        moment = value if isinstance(value, datetime) else datetime.fromisoformat(str(value))
    except ValueError:
        return None
    return moment if moment.tzinfo is None else moment.astimezone().replace(tzinfo=None)
