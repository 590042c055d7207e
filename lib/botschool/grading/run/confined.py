"""Define how grading uses the sandbox: imports, files, readable places and exceptions."""

from __future__ import annotations

import errno
import functools
import hashlib
import inspect
import json
import os
import tempfile
import textwrap
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.libraries import Refused as RefusedModules
from botschool.grading.declare.modules import closed_files, needed
from botschool.grading.run.refused import hidden_files, hidden_modules, refuse
from botschool.grading.run.temporary import PREFIX
from botschool.paths import material
from botschool.sandbox import Child, ForkServer, Limits, Refused, SandboxError, Scratch, paths
from botschool.sandbox.errors import CannotRead
from botschool.sandbox.inside import read_inside
from botschool.sandbox.scratch import MAX_COPIED, regular_files

# PyTorch's threads compete for busy cores, and the course's networks are too small for threads:
# on a busy machine, 4,096 steps of PPO take 18.4 s with all threads and 0.9 s with one
os.environ.setdefault("OMP_NUM_THREADS", "1")

IMPORTS = ("gymnasium.envs.classic_control", "numpy.random")
"""Modules that are imported before a submission runs."""
_PRIVATE = ("solutions", "exercises", "tests", "results", "build", ".git", ".botschool")
"""The parts of a course folder that no submission may read."""


NOTHING = RefusedModules()
CLASS = "BOTSCHOOL_CLASS"
"""The environment variable with the folders that close_class has closed, as JSON."""


class MachineFault(BotschoolError):
    """The machine failed, not the submission: it lacked memory or disk, or killed a process."""


class Unread(Wrong):
    """The submission's files cannot be read, so nothing is known about them."""


SHORTAGES = tuple(
    getattr(errno, name)
    for name in ("ENOMEM", "ENOSPC", "EDQUOT", "EAGAIN", "EMFILE", "ENFILE", "EIO")
)


@contextmanager
def translated() -> Iterator[None]:
    """Raise Wrong for refused files, and MachineFault if this machine lacks something."""
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
    """Return the exception for an error of the grader: a MachineFault if something is short."""
    if isinstance(error, OSError) and error.errno not in SHORTAGES:
        return error
    reason = getattr(error, "strerror", None) or "not enough memory"
    return MachineFault(
        f"The grader could not go on ({reason}): free some memory and disk space, or use "
        "fewer workers (-w), and grade again."
    )


def fork_server(imports: Iterable[str] = ()) -> ForkServer:
    """Start a fork server; imports: modules beside IMPORTS. Raises BotschoolError."""
    with translated():
        return ForkServer([*IMPORTS, *imports], {"BOTSCHOOL_COURSE": str(material())})


def start_child(
    server: ForkServer,
    scratch: Scratch,
    file: Path,
    limits: Limits,
    references: dict[str, Any] | None = None,
    refused: RefusedModules = NOTHING,
    in_parts: bool = False,
) -> Child:
    """Start a child for a submission's file, given by its original path. Raises BotschoolError.

    refused: modules and functions that do not exist there. in_parts: as in sandbox.Child.
    """
    names, hidden, opened = list(refused.names), hidden_files(refused.names), None
    if refused.may_use is not None:
        opened = sorted(needed(refused.may_use))
        hidden += closed_files(frozenset(opened))
    prepare = None
    if names or opened is not None:
        prepare = [source_of(refuse), refuse.__name__, names, opened]
    with translated():
        server = server.without(hidden_modules(names))
        places = readable(file, hidden)
        # Python finds a module by the names in its folder
        listed = [p for p in _needed() if any(each.is_relative_to(p) for each in hidden)]
        given = places, references, prepare, listed, in_parts
        return Child(server, scratch, file.name, limits, *given)


@functools.cache
def source_of(function: Callable[..., Any]) -> str:
    """Return a function's text, to send it to a child."""
    return textwrap.dedent(inspect.getsource(function))


def scratch_copy(file: Path) -> Scratch:
    """Copy a submission's files. Raises Wrong if they are too many or too large."""
    with translated():
        return Scratch(file, _is_grader)


def submission_files(file: Path) -> list[Path]:
    """Return a submission's files: its file, those beside it and those in sub-folders.

    Links, hidden files, caches and graders are left out. Raises Wrong if there are too many.
    """
    with translated():
        return regular_files(file, _is_grader)


def content_digest(file: Path, sources: Iterable[str] | None = None) -> hashlib._Hash:
    """Return a hash of names and contents of a submission's files, open for more data.

    sources: for a notebook, the texts of its cells, which replace its file. Raises Wrong like
    submission_files, and OSError.
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
    """Forbid submissions to read these folders of submissions and grades, in this process.

    This also closes the folder of temporary files, which holds the copies of other submissions.
    Raises BotschoolError for a folder that submissions must read.
    """
    data = material() / "data"
    closed = [folder.resolve() for folder in folders]
    temporary = Path(tempfile.gettempdir()).resolve()
    closed.append(temporary.parent if temporary.name.startswith(PREFIX) else temporary)
    if data in closed:
        raise BotschoolError(
            f"The submissions are inside the course's {data}, which every submission may "
            "read: move them into a folder of their own."
        )
    os.environ[CLASS] = json.dumps([str(folder) for folder in closed])


def readable(file: Path, hidden: Iterable[Path] = ()) -> list[Path]:
    """Return the files and folders that a submission may read besides its copy.

    Those in `hidden` stay closed. The course, the original folder of `file`, and the folders that
    close_class has named stay closed, even inside one of the system's folders.
    """
    needed, file = _needed(), file.resolve()
    closed = [
        place
        for place in file.parents[:3]
        if not any(each.is_relative_to(place) for each in needed)
    ]
    closed += [*hidden, *map(Path, json.loads(os.environ.get(CLASS, "[]")))]
    here = Path.cwd() / os.environ.get("BOTSCHOOL_COURSE", "")
    courses = {material(), here, *here.parents, *file.parents}
    closed += [
        course / name for course in courses if (course / "exercises").is_dir() for name in _PRIVATE
    ]
    return paths.without([*needed, material() / "data", *paths.system_paths()], closed)


def _needed() -> list[Path]:
    """Return the folders of botschool, of the interpreter and of its packages."""
    import botschool._core

    own = paths.IMPORT_ROOT.resolve()  # lib/, or site-packages
    core = Path(botschool._core.__file__).resolve()
    return [own / "botschool", core, *paths.interpreter_paths()]
