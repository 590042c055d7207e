"""How grading uses the sandbox: its imports, files, what it may read, and its exceptions."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.run.temporary import PREFIX
from botschool.paths import material
from botschool.sandbox import Child, ForkServer, Limits, Refused, SandboxError, Scratch, paths
from botschool.sandbox.errors import CannotRead
from botschool.sandbox.inside import read_inside
from botschool.sandbox.scratch import MAX_COPIED, regular_files

# PyTorch's threads fight for busy cores, and the course's networks are too small to share out: on a
# busy machine, 4,096 steps of PPO take 18.4 s with all threads and 0.9 s with one
os.environ.setdefault("OMP_NUM_THREADS", "1")

IMPORTS = ("gymnasium.envs.classic_control", "numpy.random", "botschool.evolution.run")
"""Modules that every submission finds imported."""
_PRIVATE = ("solutions", "exercises", "tests", "results", "build", ".git", ".botschool")
"""Of a course folder: what no submission may read."""


CLASS = "BOTSCHOOL_CLASS"
"""Of the environment: folders that close_class has closed, as JSON."""


class MachineFault(BotschoolError):
    """What this machine did, and no submission: it was short of memory or disk, or killed."""


class Unread(Wrong):
    """What was handed in cannot be read, which says nothing about it."""


SHORTAGES = tuple(
    getattr(errno, name)
    for name in ("ENOMEM", "ENOSPC", "EDQUOT", "EAGAIN", "EMFILE", "ENFILE", "EIO")
)


@contextmanager
def translated() -> Iterator[None]:
    """Raises Wrong for what is refused, MachineFault for what this machine cannot do."""
    try:
        yield
    except CannotRead as error:
        raise Unread(str(error)) from None
    except Refused as error:
        raise Wrong(str(error)) from None
    except SandboxError as error:
        raise MachineFault(str(error)) from None
    except OSError as error:
        raise machine_fault(error) from None


def machine_fault(error: OSError | MemoryError) -> MachineFault | Exception:
    """What to raise for an error of the grader itself: a MachineFault if something is short."""
    if isinstance(error, OSError) and error.errno not in SHORTAGES:
        return error
    reason = getattr(error, "strerror", None) or "not enough memory"
    return MachineFault(
        f"The grader could not go on ({reason}): free some memory and disk space, or use fewer "
        "workers (-w), and grade again."
    )


def fork_server(imports: Iterable[str] = ()) -> ForkServer:
    """imports: names of modules beside IMPORTS. Raises BotschoolError."""
    with translated():
        return ForkServer([*IMPORTS, *imports])


def start_child(
    server: ForkServer,
    scratch: Scratch,
    file: Path,
    limits: Limits,
    references: dict[str, Any] | None = None,
) -> Child:
    """A child for a submission's file, given where it was handed in. Raises BotschoolError."""
    with translated():
        return Child(server, scratch, file.name, limits, readable(file), references)


def scratch_copy(file: Path) -> Scratch:
    """A copy of the files of a submission. Raises Wrong when they are too many or too large."""
    with translated():
        return Scratch(file, _is_grader)


def submission_files(file: Path) -> list[Path]:
    """The files that a submission consists of: those beside its file and in sub-folders.

    Links, hidden files, caches and graders are left out. Raises Wrong when it is too much.
    """
    with translated():
        return regular_files(file, _is_grader)


def content_digest(file: Path, sources: Iterable[str] | None = None) -> hashlib._Hash:
    """Return a hash of names and contents of a submission's files, which may go on.

    sources: of a notebook, the texts of its cells, which stand for its file. Raises Wrong as
    submission_files does, and OSError.
    """
    digest = hashlib.sha256()
    for path in submission_files(file):
        name = path.relative_to(file.parent)
        digest.update(hashlib.sha256(os.fsencode(name)).digest())
        if sources is not None and path == file:
            content = json.dumps([*sources]).encode()
        else:
            content = read_inside(file.parent, name, MAX_COPIED)
        digest.update(hashlib.sha256(content).digest())
    return digest


def _is_grader(name: str, depth: int) -> bool:
    return depth == 1 and name.startswith("test_")


def close_class(*folders: Path) -> None:
    """Close the folders that hold submissions and their grades to all of them, in this process.

    The folder of temporary files is closed, too: the copies of others lie there. Raises
    BotschoolError for a folder that submissions must read.
    """
    data = material() / "data"
    closed = [folder.resolve() for folder in folders]
    temporary = Path(tempfile.gettempdir()).resolve()
    closed.append(temporary.parent if temporary.name.startswith(PREFIX) else temporary)
    if data in closed:
        raise BotschoolError(
            f"The submissions stand among the course's files in {data}, which each submission may "
            "read: move them into a folder of their own."
        )
    os.environ[CLASS] = json.dumps([str(folder) for folder in closed])


def readable(file: Path) -> list[Path]:
    """What a submission may read beside its copy.

    Not the course, nor the place where `file` was handed in, even if those lie below one of the
    system's folders; nor what close_class has named.
    """
    import botschool._core

    own = paths.IMPORT_ROOT.resolve()  # lib/, or site-packages
    core = Path(botschool._core.__file__).resolve().parent
    needed = [own / "botschool", core, *paths.interpreter_paths()]
    file = file.resolve()
    closed = [
        place
        for place in file.parents[:3]
        if not any(each.is_relative_to(place) for each in needed)
    ]
    closed += map(Path, json.loads(os.environ.get(CLASS, "[]")))
    here = Path.cwd() / os.environ.get("BOTSCHOOL_COURSE", "")
    courses = {material(), here, *here.parents, *file.parents}
    closed += [
        course / name for course in courses if (course / "exercises").is_dir() for name in _PRIVATE
    ]
    return paths.without([*needed, material() / "data", *paths.system_paths()], closed)
