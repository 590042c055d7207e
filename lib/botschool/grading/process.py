"""The child process that a submission runs in, from the grader's side: start, ask, watch, kill."""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
import time
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading import protocol
from botschool.grading.nursery import START_SECONDS, Nursery, homes, is_packages, package
from botschool.grading.scratch import Scratch

OUTPUT_KEPT = 4000
"""Characters of what the student's code prints that are kept."""
LARGEST_OUTPUT = 16 * 2**20
"""Bytes of it, after which the child is killed."""
LARGEST_FILE = 64 * 2**20
MOST_THREADS = 64
LOOK_EACH = 0.1
"""Seconds between two looks at what the child uses."""

_SYSTEM = (
    "/usr", "/lib", "/lib32", "/lib64", "/bin", "/nix/store", "/etc/ld.so.cache", "/etc/localtime",
    "/etc/fonts", "/etc/passwd", "/etc/mime.types", "/etc/ssl/openssl.cnf", "/dev/null",
    "/dev/zero", "/dev/urandom", "/dev/random", "/proc/cpuinfo", "/proc/meminfo",
    "/sys/devices/system/cpu",
)  # fmt: skip
_PRIVATE = ("solutions", "exercises", "tests", "results", "build", ".git", ".botschool")
"""Of a course folder: what no submission may read."""


class Child:
    """A process that has not yet loaded the student's file, shut in and ready for requests."""

    def __init__(
        self, nursery: Nursery, file: Path, scratch: Scratch, seconds: float, memory: int
    ) -> None:
        """file: the submission, where it was handed in; memory: bytes. Raises BotschoolError."""
        self._nursery = nursery
        self._scratch = scratch
        self._reason = ""
        self._kept = bytearray()
        self._closed = threading.Event()
        self._ending = threading.Lock()
        self._code: int | None = None
        to_child, self._requests = os.pipe()
        self._answers, from_child = os.pipe()
        self._output, its_output = os.pipe()
        os.set_blocking(self._requests, False)
        try:
            self._pid = nursery.start(to_child, from_child, its_output, scratch.folder)
        except BotschoolError:
            self._close_pipes()
            os.close(self._output)
            raise
        finally:
            for fd in (to_child, from_child, its_output):
                os.close(fd)
        threading.Thread(target=self._drain, daemon=True).start()
        self.missing = self._set_up(file, seconds, memory)
        threading.Thread(target=self._look, daemon=True).start()

    def _set_up(self, file: Path, seconds: float, memory: int) -> list[str]:
        set_up = {
            "file": str(self._scratch.folder / file.name),
            "seconds": seconds,
            "memory": memory,
            "file_size": LARGEST_FILE,
            "environment": homes(self._scratch.root),
            "readable": [str(path) for path in readable(file)],
            "writable": [str(self._scratch.root), "/dev/null"],
        }
        try:
            protocol.send(self._requests, protocol.pack(set_up), START_SECONDS)
            message = protocol.receive(self._answers, START_SECONDS)
        except (TimeoutError, BrokenPipeError):
            message = None
        if message is None:
            self.kill()
            lines = self.printed().strip().splitlines() or ["no reason was given"]
            raise BotschoolError(f"The grader's child process did not start: {lines[-1]}.")
        return protocol.unpack(message)["missing"]

    def ask(self, request: dict[str, Any], seconds: float) -> dict[str, Any] | None:
        """The answer to a request; None if the child has ended.

        Raises TimeoutError, and ValueError for what is no answer.
        """
        deadline = time.monotonic() + seconds
        with contextlib.suppress(BrokenPipeError):
            protocol.send(self._requests, protocol.pack(request), seconds)
        message = protocol.receive(self._answers, deadline - time.monotonic())
        answer = None if message is None else protocol.unpack(message)
        if answer is not None and not isinstance(answer, dict):
            raise ValueError("not an answer")
        return answer

    def printed(self) -> str:
        """The beginning of what the child has printed."""
        text = bytes(self._kept).decode(errors="replace")
        return text if len(text) <= OUTPUT_KEPT else text[:OUTPUT_KEPT] + "\n[... cut]\n"

    def ending(self) -> str:
        """Why the process ended, in words."""
        code = self._wait(1)
        if code is None:
            return "it closed its connection to the grader"
        if self._reason:
            return self._reason
        if code == -signal.SIGKILL or code == -getattr(signal, "SIGXCPU", 0):
            return "it used too much time or memory"
        if code < 0:
            return f"it crashed (signal {-code})"
        return "it called exit, so nothing came back"

    def kill(self) -> None:
        """Ends the process, with all its threads and what it started."""
        self._closed.set()
        self._kill_group()
        self._wait(5)
        self._close_pipes()

    def _wait(self, seconds: float) -> int | None:
        with self._ending:
            if self._code is None:
                self._code = self._nursery.ended(self._pid, seconds)
            return self._code

    def _kill_group(self) -> None:
        with self._ending:
            if self._code is None:
                for kill in (os.killpg, os.kill):
                    with contextlib.suppress(ProcessLookupError, PermissionError):
                        kill(self._pid, signal.SIGKILL)

    def _close_pipes(self) -> None:
        for fd in (self._requests, self._answers):
            with contextlib.suppress(OSError):
                os.close(fd)

    def _end(self, reason: str) -> None:
        if not self._closed.is_set():
            self._reason = reason
            self._kill_group()

    def _drain(self) -> None:
        total = 0
        with contextlib.suppress(OSError, ValueError):
            while part := os.read(self._output, 65536):
                total += len(part)
                self._kept += part[: max(0, 4 * OUTPUT_KEPT - len(self._kept))]
                if total > LARGEST_OUTPUT:
                    self._end(f"it printed more than {LARGEST_OUTPUT // 2**20} MB")
                    break
        with contextlib.suppress(OSError):
            os.close(self._output)

    def _look(self) -> None:
        while not self._closed.wait(LOOK_EACH) and self._code is None:
            if _threads(self._pid) > MOST_THREADS:
                self._end(f"it started more than {MOST_THREADS} threads")
            if reason := self._scratch.trouble():
                self._end(reason)


def _threads(pid: int) -> int:
    try:
        return os.stat(f"/proc/{pid}/task").st_nlink - 2
    except OSError:
        return 0


def readable(file: Path) -> list[Path]:
    """What the submission may read beside its copy: Python, its packages, the system's libraries.

    Not the course, nor the place where `file` was handed in, even if those lie below one of them.
    """
    import botschool._core

    own = package().resolve()
    core = Path(botschool._core.__file__).resolve().parent
    packages = [Path(path).resolve() for path in sys.path if path and is_packages(path)]
    prefixes = [Path(sys.prefix).resolve(), Path(sys.base_prefix).resolve()]
    needed = [own, core, *packages, *prefixes]
    file = file.resolve()
    closed = [
        place
        for place in file.parents[:3]
        if not any(each.is_relative_to(place) for each in needed)
    ]
    here = Path.cwd() / os.environ.get("BOTSCHOOL_COURSE", "")
    courses = {own.parents[1], here, *here.parents, *file.parents}
    closed += [
        course / name for course in courses if (course / "exercises").is_dir() for name in _PRIVATE
    ]
    system = [Path(place).resolve() for place in _SYSTEM]
    allowed = [*needed, own.parents[1] / "data", *system]
    parts = {part for place in allowed for part in _without(place, closed)}
    return sorted(part for part in parts if part.exists())


def _without(place: Path, closed: list[Path]) -> list[Path]:
    """A folder, or the parts of it that hold none of the closed ones."""
    inside = [each for each in closed if each.is_relative_to(place)]
    if not inside:
        return [place]
    if place in inside or not place.is_dir():
        return []
    return [
        part
        for child in place.iterdir()
        if not child.is_symlink()
        for part in _without(child, inside)
    ]
