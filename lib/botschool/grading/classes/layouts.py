"""Recognise what learning platforms write: names of files and folders, tables, times."""

from __future__ import annotations

import contextlib
import os
import re
import subprocess
import tempfile
import zipfile
from collections.abc import Iterable
from datetime import datetime
from itertools import islice
from pathlib import Path, PurePosixPath
from typing import Any
from zoneinfo import ZoneInfo

from botschool.errors import BotschoolError
from botschool.grading.classes.candidate import Sought
from botschool.grading.classes.files import TIMESTAMP, File, is_junk
from botschool.grading.classes.texts import is_larger
from botschool.grading.classes.unpack import holds_more
from botschool.sandbox.inside import read_inside

MOODLE = re.compile(
    r"(?P<name>.+?)_(?P<id>\d+)_assignsubmission_(?P<kind>[a-z]+)(?:_(?P<rest>.*))?", re.DOTALL
)
CANVAS = re.compile(
    r"(?P<name>.+?)_(?P<late>LATE_)?(?P<id>\d+|(?<=anon_)[^\W_]{5}|(?<=anonymous_)[^\W_]{5})"
    r"_(?P<submission>\d+)_(?P<rest>(?!assignsubmission_).+)",
    re.DOTALL,
)
ATTEMPT = re.compile(
    r"(?:.*?_)??(?P<name>[^_]+)_attempt_(?P<time>\d{4}(?:-\d\d){5})(?:_(?P<rest>.+)|\.txt)",
    re.DOTALL,
)
"""Blackboard's names of files, and those that nbgrader's zip_collect reads."""
GRADESCOPE = re.compile(r"(?P<name>submission)_(?P<id>\d+)")
_PLATFORMS = {"moodle": MOODLE, "canvas": CANVAS, "gradescope": GRADESCOPE, "attempt": ATTEMPT}
VERSION = re.compile(
    r"(?i)(v|ver|version|attempt|try|old|new|backup|copy|final|draft|week|ex|exercise|task"
    r"|submission)?[\W_]*\d*"
)
"""Names of folders in which one person keeps several versions, or several exercises."""
TABLES = (".csv", ".yaml", ".yml")
"""Suffixes of a class's tables and settings."""
MAX_NAMES, MAX_FOLDERS = 50_000, 200
"""Names in a zip file, and folders in one, that may be a class's or a person's, beside others."""
METADATA = ("submission_metadata.yml", "submission_metadata.yaml")
_MAX_METADATA, _MAX_VALUES = 20 * 2**20, 5_000_000
_MAX_REFS, _SECONDS = 5_000_000, 20
SUBMITTED = "submitted"
"""The folder of nbgrader's course that holds the students' folders."""


def visible(folder: Path) -> list[os.DirEntry]:
    """Return the sorted entries of a folder that may be somebody's. Raises BotschoolError."""
    try:
        with os.scandir(folder) as entries:
            found = [e for e in entries if recognised(e.name) or not is_hidden(e.name)]
    except OSError as error:
        raise BotschoolError(f"{folder} cannot be read ({error.strerror}).") from None
    return sorted(found, key=lambda entry: entry.name)


def without_tables(folder: Path) -> list[os.DirEntry]:
    """Return the visible entries of a folder that are no tables of the class."""
    return [entry for entry in visible(folder) if not entry.name.lower().endswith(TABLES)]


def entries_of(folder: Path) -> list[os.DirEntry]:
    """Return the entries of a folder; none if it cannot be read."""
    with contextlib.suppress(OSError), os.scandir(folder) as entries:
        return list(entries)
    return []


def is_hidden(name: str) -> bool:
    """Return whether a name is that of a hidden file or of one that a system left behind."""
    return name.startswith(".") or is_junk(name)


def is_folder(entry: os.DirEntry) -> bool:
    """Return whether an entry is a folder, and no link to one."""
    return entry.is_dir(follow_symlinks=False)


def recognised(name: str) -> tuple[str, re.Match] | None:
    """Return the platform that gives such a name to a person's file or folder, and the match.

    The end of a file's name is the student's choice, and may look like another platform's name: the
    match that begins with the shortest name of a person counts.
    """
    found = [(key, match) for key, each in _PLATFORMS.items() if (match := each.fullmatch(name))]
    return min(found, key=lambda each: each[1].end("name"), default=None)


def is_class(names: Iterable[str]) -> bool:
    """Return whether the names in a folder are those of a platform's class."""
    found = [recognised(name) for name in names if not is_hidden(name)]
    if any(each and each[0] in ("moodle", "gradescope") for each in found):
        return True
    return bool(found) and all(found)


def names_in(path: Path) -> list[str]:
    """Return the names in a zip file, or in a folder and those below; none if it holds too many."""
    if path.is_dir():
        return [name for _, _, files in islice(os.walk(path), MAX_FOLDERS) for name in files]
    with contextlib.suppress(Exception):
        if not holds_more(path, MAX_NAMES):
            with zipfile.ZipFile(path) as archive:
                return archive.namelist()
    return []


def holds_exercise(path: Path, wanted: list[Sought]) -> bool:
    """Return whether a zip file or a folder holds an exercise."""
    stems = [Path(one.file).stem.casefold() for one in wanted]
    return any(stem in name.casefold() for name in names_in(path) for stem in stems)


def zips_a_class(path: Path) -> bool:
    """Return whether a zip file holds a platform's class, perhaps in a folder."""
    names = [name.split("/") for name in names_in(path)]
    tops = {parts[0] for parts in names}
    return is_class(tops) or (len(tops) == 1 and is_class({p[1] for p in names if len(p) > 1}))


def attempts_of(names: list[str]) -> dict[str, tuple[str, str, datetime | None]]:
    """Return for each file of an attempt: its owner, its own name and its time.

    A file of a later attempt gets the number of the attempt, as Canvas writes it.
    """
    found = {name: match for name in names if (match := ATTEMPT.fullmatch(name))}
    times: dict[str, list[str]] = {}
    for match in found.values():
        own = times.setdefault(match["name"].casefold(), [])
        own += [match["time"]] * (match["time"] not in own)
    made = {}
    for name, match in found.items():
        number = sorted(times[match["name"].casefold()]).index(match["time"])
        rest = Path(match["rest"] or "")
        shown = f"{rest.stem}-{number}{rest.suffix}" if number and match["rest"] else str(rest)
        day, clock = match["time"][:10], match["time"][11:].replace("-", ":")
        made[name] = (match["name"], shown * bool(match["rest"]), moment_of(f"{day} {clock}"))
    return made


def clones_in(folder: Path) -> list[Path]:
    """Return the repositories in a folder that is not one itself, if there are several."""
    inner = sorted(Path(entry.path) for entry in entries_of(folder) if is_folder(entry))
    several = len(inner) > 1 and all(map(is_clone, inner))
    return inner if several and not is_clone(folder) else []


def is_clone(folder: Path) -> bool:
    """Return whether a folder is a repository; False if it cannot be read."""
    return os.path.exists(folder / ".git")


def read_metadata(folder: Path) -> dict[str, dict[str, Any]]:
    """Return Gradescope's data on each submission, without the colons of its keys."""
    import yaml

    class Loader(yaml.SafeLoader):
        """Read objects of other languages as plain data."""

    def unmarked(loader: Any, suffix: str, node: Any) -> Any:
        if isinstance(node, yaml.MappingNode):
            return loader.construct_mapping(node, deep=True)
        if isinstance(node, yaml.SequenceNode):
            return loader.construct_sequence(node, deep=True)
        return loader.construct_scalar(node)

    Loader.add_multi_constructor("!", unmarked)
    Loader.add_multi_constructor("tag:", unmarked)
    for name in METADATA:
        path = folder / name
        if path.is_symlink() or not path.is_file() or path.stat().st_size > _MAX_METADATA:
            continue
        try:
            found = yaml.load(path.read_text(encoding="utf-8-sig", errors="replace"), Loader)
        except (yaml.YAMLError, OSError, RecursionError, ValueError):
            raise BotschoolError(f"{path} is damaged: download it again.") from None
        if is_larger(found, _MAX_VALUES):
            raise BotschoolError(f"{path} holds too many values: download it again.")
        if found is not None and not isinstance(found, dict):
            raise BotschoolError(f"{path} does not list submissions: download it again.")
        return {k: v for k, v in _plain_keys(found or {}, 0).items() if isinstance(v, dict)}
    return {}


def _plain_keys(value: Any, depth: int) -> Any:
    if isinstance(value, dict) and depth < 6:
        return {str(k).lstrip(":"): _plain_keys(v, depth + 1) for k, v in value.items()}
    if isinstance(value, list) and depth < 6:
        return [_plain_keys(each, depth + 1) for each in value]
    return value


def moment_of(value: Any) -> datetime | None:
    """Return a table's time in local time."""
    try:
        moment = value if isinstance(value, datetime) else datetime.fromisoformat(str(value))
        return moment if moment.tzinfo is None else moment.astimezone().replace(tzinfo=None)
    except (ValueError, OverflowError, OSError):  # no time, or one before or after all clocks
        return None


def told_by(file: File) -> datetime | None:
    """Return when a file was handed in, from what a platform writes: a clone, or nbgrader's file.

    Students can write the same within what they hand in: of several clones the outermost counts, in
    an archive none, and nbgrader's file beside a clone only in the folder `submitted`.
    """
    file = file.packed or file
    if file.top.parent.name == SUBMITTED:
        return _collected(file)
    return _committed(file) or _collected(file)


def _collected(file: File) -> datetime | None:
    """Return the time in nbgrader's file: "2026-11-20 21:14:03.5 Europe/Rome"."""
    beside = PurePosixPath(file.place).with_name(TIMESTAMP)
    if len(beside.parts) > 2:  # STUDENT/EXERCISE/timestamp.txt, with file.top for STUDENT
        return None
    try:
        words = read_inside(file.top, str(beside), 100).decode().split()
        moment = datetime.fromisoformat(" ".join(words[:2]))
        zone = ZoneInfo(words[2]) if len(words) > 2 else None
    except (OSError, ValueError, LookupError):
        return None
    return moment_of(moment.replace(tzinfo=zone) if zone else moment)


def _committed(file: File) -> datetime | None:
    """Return the time of the last commit that changed a file, in the file's repository."""
    parts = PurePosixPath(file.place).parts
    for depth in range(len(parts)):
        git = file.top.joinpath(*parts[:depth], ".git")
        if git.is_dir() and not git.is_symlink():
            return _last_commit(git, "/".join(parts[depth:]))
    return None


def _last_commit(git: Path, place: str) -> datetime | None:
    """Ask git in an empty repository with the clone's objects, so that no settings of it count."""
    objects, branch = git / "objects", _read(git, "HEAD", 1000).strip().removeprefix("ref: ")
    if objects.is_symlink() or not objects.is_dir() or ".." in branch:
        return None
    names = ["HEAD", "packed-refs", "shallow", *([branch] if branch.startswith("refs/") else [])]
    with tempfile.TemporaryDirectory(prefix="botschool-") as temporary:
        own = Path(temporary)
        environment = {
            "PATH": os.environ.get("PATH", ""),
            "GIT_DIR": str(own),
            "GIT_ALTERNATE_OBJECT_DIRECTORIES": str(objects.absolute()),
            "GIT_CONFIG_NOSYSTEM": "1",
            "GIT_CONFIG_GLOBAL": os.devnull,
            "GIT_LITERAL_PATHSPECS": "1",
        }
        command = ["git", "log", "-1", "--format=%ct", "HEAD", "--", place]
        try:
            for folder in ("objects", "refs"):
                (own / folder).mkdir()
            for name in names:
                if content := _read(git, name, _MAX_REFS):
                    (own / name).parent.mkdir(parents=True, exist_ok=True)
                    (own / name).write_text(content)
            done = subprocess.run(
                command, cwd=own, env=environment, capture_output=True, timeout=_SECONDS, check=True
            )
            return datetime.fromtimestamp(int(done.stdout))
        except (OSError, subprocess.SubprocessError, ValueError, OverflowError):
            return None


def _read(folder: Path, name: str, most: int) -> str:
    try:
        return read_inside(folder, name, most).decode("utf-8", "replace")
    except OSError:
        return ""
