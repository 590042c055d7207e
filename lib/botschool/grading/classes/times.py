"""Find out when files were handed in: Gradescope's table, nbgrader's file, a clone's commits."""

from __future__ import annotations

import os
import re
import subprocess
import tempfile
from datetime import datetime
from pathlib import Path, PurePosixPath
from typing import Any
from zoneinfo import ZoneInfo

from botschool.errors import BotschoolError
from botschool.grading.classes.files import TIMESTAMP, File
from botschool.grading.classes.texts import is_larger
from botschool.sandbox.inside import read_inside

METADATA = ("submission_metadata.yml", "submission_metadata.yaml")
_MAX_METADATA, _MAX_VALUES = 20 * 2**20, 5_000_000
_MAX_REFS, _SECONDS = 5_000_000, 20
SUBMITTED = "submitted"
"""The folder of nbgrader's course that holds the students' folders."""
_COMMIT = re.compile(r"[0-9a-f]{40}")


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
    objects, head = git / "objects", _head(git)
    if head is None or objects.is_symlink() or not objects.is_dir():
        return None
    with tempfile.TemporaryDirectory(prefix="botschool-") as temporary:
        own = Path(temporary)
        (own / "objects").mkdir()
        (own / "refs").mkdir()
        (own / "HEAD").write_text("ref: refs/heads/none\n")
        shallow = _read(git, "shallow", _MAX_REFS)
        if all(map(_COMMIT.fullmatch, shallow.split())):
            (own / "shallow").write_text(shallow)
        environment = {
            "PATH": os.environ.get("PATH", ""),
            "GIT_DIR": str(own),
            "GIT_ALTERNATE_OBJECT_DIRECTORIES": str(objects.absolute()),
            "GIT_CONFIG_NOSYSTEM": "1",
            "GIT_CONFIG_GLOBAL": os.devnull,
            "GIT_LITERAL_PATHSPECS": "1",
        }
        command = ["git", "log", "-1", "--format=%ct", head, "--", place]
        try:
            done = subprocess.run(
                command, cwd=own, env=environment, capture_output=True, timeout=_SECONDS, check=True
            )
            return datetime.fromtimestamp(int(done.stdout))
        except (OSError, subprocess.SubprocessError, ValueError, OverflowError):
            return None


def _head(git: Path) -> str | None:
    """Return the commit that is checked out."""
    name = _read(git, "HEAD", 1000).strip()
    if name.startswith("ref: "):
        name = name[5:]
        packed = re.findall(r"^(\w+) (.+)$", _read(git, "packed-refs", _MAX_REFS), re.MULTILINE)
        by_name = {ref: commit for commit, ref in packed}
        name = _read(git, name, 100).strip() or by_name.get(name, "")
    return name if _COMMIT.fullmatch(name) else None


def _read(folder: Path, name: str, most: int) -> str:
    try:
        return read_inside(folder, name, most).decode("utf-8", "replace")
    except OSError:
        return ""
