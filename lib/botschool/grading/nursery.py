"""Where the processes for submissions come from: copies (forks) of one that has made its imports.

What takes long to import is imported once for a grading, and not in the time of a task.
`Nursery` is the grader's side, `main` the process; they speak JSON lines over a socket.
"""

from __future__ import annotations

import contextlib
import ctypes
import importlib
import json
import os
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterable
from pathlib import Path

import botschool
from botschool.errors import BotschoolError

START_SECONDS = 180
"""Longest time for the imports, and for a child to start."""
BASIC = ("gymnasium.envs.classic_control", "numpy.random", "botschool.evolution.run")
"""What every child has imported."""
LOOK_EACH = 0.005
"""Seconds between two looks at whether a child has ended."""
_EARLY = sys.platform == "linux"  # elsewhere libraries may not survive a fork


class Nursery:
    """Starts children, and tells when and how they ended; close it when there are no more."""

    def __init__(self, imports: Iterable[str] = ()) -> None:
        """imports: names of modules beside the basic ones. Raises BotschoolError."""
        if not hasattr(os, "killpg"):
            raise BotschoolError(
                "Grading needs Linux or macOS: on Windows, install WSL with 'wsl --install' and "
                "work there."
            )
        self._said = tempfile.TemporaryFile()  # noqa: SIM115
        self._home = tempfile.TemporaryDirectory(prefix="botschool-", ignore_cleanup_errors=True)
        self._link, theirs = socket.socketpair()
        self._answers = self._link.makefile("rb")
        self._ready = False
        self._lock = threading.Lock()
        try:
            self._process = subprocess.Popen(
                interpreter("botschool.grading.nursery", str(theirs.fileno()), *BASIC, *imports),
                cwd=self._home.name,
                env=_environment(self._home.name),
                stdin=subprocess.DEVNULL,
                stdout=self._said,
                stderr=subprocess.STDOUT,
                pass_fds=(theirs.fileno(),),
                start_new_session=True,
            )
        except OSError as error:
            raise BotschoolError(
                f"No process can be started for a submission ({error.strerror}): close other "
                "programs, or use fewer workers (-w)."
            ) from None
        finally:
            theirs.close()

    def start(self, requests: int, answers: int, output: int, folder: Path) -> int:
        """The process id of a new child; it keeps copies of these file descriptors.

        Raises BotschoolError.
        """
        with self._lock:
            self._link.settimeout(START_SECONDS)
            try:
                if not self._ready:
                    self._ready = json.loads(self._answers.readline())
                request = json.dumps({"folder": str(folder)}).encode() + b"\n"
                socket.send_fds(self._link, [request], [requests, answers, output])
                return json.loads(self._answers.readline())
            except (OSError, ValueError):
                raise BotschoolError(
                    f"The grader's child process did not start: {self._last_line()}."
                ) from None

    def ended(self, pid: int, seconds: float) -> int | None:
        """How a child ended (as Popen.returncode), waited for; None if it has not.

        Until this says so, the process id belongs to no other process.
        """
        with self._lock, contextlib.suppress(OSError, ValueError):
            self._link.settimeout(seconds + START_SECONDS)
            self._link.sendall(json.dumps({"ended": pid, "seconds": seconds}).encode() + b"\n")
            return json.loads(self._answers.readline())
        return -signal.SIGKILL

    def close(self) -> None:
        """Ends the process, and with it all children."""
        self._answers.close()
        self._link.close()
        try:
            self._process.wait(1)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._said.close()
        self._home.cleanup()

    def __enter__(self) -> Nursery:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _last_line(self) -> str:
        self._said.seek(0)
        lines = self._said.read()[-2000:].decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else "no reason was given"


def interpreter(module: str, *arguments: str) -> list[str]:
    """The command that runs a module's main in another interpreter.

    It finds our packages wherever they were installed, and nothing in the working folder.
    """
    places = [str(package().parent), *(path for path in sys.path if is_packages(path))]
    start = (
        f"import sys; sys.path += [p for p in {places!r} if p not in sys.path]; "
        f"from {module} import main; main()"
    )
    return [sys.executable, "-I", "-c", start, *arguments]


def is_packages(path: str) -> bool:
    """Whether a folder of sys.path holds installed packages."""
    return Path(path).name in ("site-packages", "dist-packages")


def package() -> Path:
    """The folder of botschool's Python files."""
    return Path(botschool.__file__).parent


def homes(folder: Path | str) -> dict[str, str]:
    """Environment variables that make a folder the place for all that is written."""
    return dict.fromkeys(("HOME", "TMPDIR", "MPLCONFIGDIR"), str(folder))


def _environment(home: str) -> dict[str, str]:
    return {
        "PATH": os.environ.get("PATH", ""),
        "LANG": "C.UTF-8",
        "MPLBACKEND": "Agg",
        "SDL_VIDEODRIVER": "dummy",
        "OPENBLAS_NUM_THREADS": "1",
        "OMP_NUM_THREADS": "1",
        "PYTHONDONTWRITEBYTECODE": "1",
        "PYTHONHASHSEED": "0",
    } | homes(home)


# ------------------------------------------------------------------- the process
def main() -> None:
    """Argument 1: the socket; the others: modules to import. Ends when the grader does."""
    link, modules = socket.socket(fileno=int(sys.argv[1])), sys.argv[2:]
    if _EARLY:
        _import(modules)
    link.sendall(b"true\n")
    while True:
        message, descriptors, _, _ = socket.recv_fds(link, 2**16, 3)
        if not message:
            os._exit(0)
        request = json.loads(message)
        if "ended" in request:
            answer = _ended(request["ended"], request["seconds"])
        else:
            answer = os.fork()
            if answer == 0:
                _become_child(modules, descriptors, request["folder"])
            for fd in descriptors:
                os.close(fd)
        link.sendall(json.dumps(answer).encode() + b"\n")


def _import(modules: list[str]) -> None:
    for name in modules:
        importlib.import_module(name)
    sys.stdout.flush()
    ctypes.CDLL(None).fflush(None)  # what libraries in C have printed is not the student's


def _ended(pid: int, seconds: float) -> int | None:
    deadline = time.monotonic() + seconds
    while True:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        if time.monotonic() > deadline:
            return None
        time.sleep(LOOK_EACH)


def _become_child(modules: list[str], descriptors: list[int], folder: str) -> None:
    """In the copy: leaves what belongs to the nursery and serves as a child, for ever."""
    from botschool.grading import child

    code = 1
    try:
        os.setsid()
        *pipes, output = (os.dup2(fd, 100 + n) for n, fd in enumerate(descriptors))
        os.dup2(output, 1)
        os.dup2(output, 2)
        os.closerange(3, 100)
        os.close(output)
        os.chdir(folder)
        if not _EARLY:
            _import(modules)
        child.serve(*pipes)
        code = 0
    finally:
        with contextlib.suppress(Exception):
            sys.stderr.flush()
        os._exit(code)


if __name__ == "__main__":
    main()
