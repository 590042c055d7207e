"""Serve confined children: a process imports modules once, then forks children.

`ForkServer` is the caller's side, `main` the process; they exchange JSON lines over a socket.
"""

from __future__ import annotations

import contextlib
import ctypes
import gc
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
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

from botschool.sandbox import child, namespace
from botschool.sandbox.confine import end_with
from botschool.sandbox.errors import SandboxError
from botschool.sandbox.paths import IMPORT_ROOT, is_packages

START_SECONDS = 180
"""Seconds for the imports, and for the start of a child."""
POLL_SECONDS = 0.005
"""Seconds between two checks whether a child has ended."""
_CLOSE_ON_EXEC = getattr(socket, "MSG_CMSG_CLOEXEC", 0)
_FORK_AFTER_IMPORTS = sys.platform == "linux"  # on other systems, libraries may not survive a fork


class ForkServer:
    """Start children and report how they ended; a context manager."""

    def __init__(
        self, imports: Iterable[str] = (), environment: Mapping[str, str] | None = None
    ) -> None:
        """Start the server. Raises SandboxError.

        imports: names of modules that every child has imported from the beginning. environment:
        variables that it has besides the few that all children have.
        """
        if not hasattr(os, "killpg"):
            raise SandboxError(
                "Submissions run on Linux or macOS only: on Windows, install WSL with "
                "'wsl --install' and work there."
            )
        self._imports, self._environment = [*imports], environment
        self._lean: dict[tuple[str, ...], ForkServer] = {}
        self._log = tempfile.TemporaryFile()  # noqa: SIM115
        self._home = tempfile.TemporaryDirectory(prefix="botschool-", ignore_cleanup_errors=True)
        self._link, theirs = socket.socketpair()
        self._answers = self._link.makefile("rb")
        self._ready = False
        self._lock = threading.Lock()
        try:
            self._process = subprocess.Popen(
                interpreter("botschool.sandbox.server", str(theirs.fileno()), *self._imports),
                cwd=self._home.name,
                env={**(environment or {}), **_environment(self._home.name)},
                stdin=subprocess.DEVNULL,
                stdout=self._log,
                stderr=subprocess.STDOUT,
                pass_fds=(theirs.fileno(),),
                start_new_session=True,
            )
        except OSError as error:
            raise SandboxError(
                f"Cannot start a process for the submission ({error.strerror}): close other "
                "programs, or use fewer workers (-w)."
            ) from None
        finally:
            theirs.close()

    def without(self, modules: Iterable[str]) -> ForkServer:
        """Return a server that has not imported these modules and packages; this one, if it has.

        This server closes it.
        """
        hidden = [f"{name}." for name in modules]
        kept = tuple(n for n in self._imports if not f"{n}.".startswith(tuple(hidden)))
        if len(kept) == len(self._imports):
            return self
        with self._lock:
            if kept not in self._lean:
                self._lean[kept] = ForkServer(kept, self._environment)
            return self._lean[kept]

    def start(self, requests: int, answers: int, output: int, folder: Path) -> int:
        """Fork a child in a folder, with copies of three file descriptors; return its process id.

        Raises SandboxError.
        """
        with self._lock, self._asked():
            request = json.dumps({"folder": str(folder)}).encode() + b"\n"
            socket.send_fds(self._link, [request], [requests, answers, output])
            return json.loads(self._answers.readline())

    def mount(self, folder: Path, size: int, files: int) -> int | None:
        """Mount a file system in memory on a folder, which this server and its children see.

        size, files: its bytes, and its number of files and folders. Return a descriptor of it for
        this process, or None if the system forbids the mount. Removing the folder ends it. Raises
        SandboxError.
        """
        with self._lock, self._asked():
            request = {"mount": str(folder), "size": size, "files": files}
            self._link.sendall(json.dumps(request).encode() + b"\n")
            _, descriptors, _, _ = socket.recv_fds(self._link, 100, 1, _CLOSE_ON_EXEC)
            return descriptors[0] if descriptors else None

    @contextlib.contextmanager
    def _asked(self) -> Iterator[None]:
        """Wait for the end of the imports; raise SandboxError if no answer comes."""
        self._link.settimeout(START_SECONDS)
        try:
            if not self._ready:
                self._ready = json.loads(self._answers.readline())
            yield
        except (OSError, ValueError):
            raise SandboxError(
                f"The confined child process did not start: {self._last_line()}."
            ) from None

    def ended(self, pid: int, seconds: float) -> int | None:
        """Wait until a child has ended; return its exit code as Popen.returncode, None if it runs.

        No other process gets its process id before this function has returned a code.
        """
        with self._lock, contextlib.suppress(OSError, ValueError):
            self._link.settimeout(seconds + START_SECONDS)
            self._link.sendall(json.dumps({"ended": pid, "seconds": seconds}).encode() + b"\n")
            return json.loads(self._answers.readline())
        return -signal.SIGKILL

    def close(self) -> None:
        """End the server and all its children."""
        for lean in self._lean.values():
            lean.close()
        self._answers.close()
        self._link.close()
        try:
            self._process.wait(1)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._log.close()
        self._home.cleanup()

    def __enter__(self) -> ForkServer:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _last_line(self) -> str:
        self._log.seek(0)
        lines = self._log.read()[-2000:].decode(errors="replace").strip().splitlines()
        return lines[-1] if lines else "the process gave no reason"


def interpreter(module: str, *arguments: str) -> list[str]:
    """Return the command that runs a module's `main` in another interpreter.

    That interpreter finds botschool and the installed packages, and imports nothing from the
    working folder.
    """
    places = [str(IMPORT_ROOT), *(path for path in sys.path if is_packages(path))]
    start = (
        f"import sys; sys.path += [p for p in {places!r} if p not in sys.path]; "
        f"from {module} import main; main()"
    )
    return [sys.executable, "-I", "-c", start, *arguments]


def homes(folder: Path | str) -> dict[str, str]:
    """Return environment variables that put caches and temporary files into a folder."""
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
    """Fork children as the caller asks, until the caller closes its end of the socket.

    Argument 1 is the socket's descriptor; the others are modules to import.
    """
    link, modules = socket.socket(fileno=int(sys.argv[1])), sys.argv[2:]
    enclosed = namespace.enter(os.environ["HOME"])  # before a library starts threads
    if _FORK_AFTER_IMPORTS:
        _import(modules)
    link.sendall(b"true\n")
    while True:
        message, descriptors, _, _ = socket.recv_fds(link, 2**16, 3)
        if not message:
            os._exit(0)
        request = json.loads(message)
        if "ended" in request:
            answer = _ended(request["ended"], request["seconds"])
        elif "mount" in request:
            _mount(link, request, enclosed)
            continue
        else:
            server, answer = os.getpid(), os.fork()
            if answer == 0:
                end_with(server)
                _become_child(modules, descriptors, request["folder"])
            for fd in descriptors:
                os.close(fd)
        link.sendall(json.dumps(answer).encode() + b"\n")


def _import(modules: list[str]) -> None:
    for name in modules:
        importlib.import_module(name)
    gc.freeze()  # a child's collector would copy every page on which an object lies
    sys.stdout.flush()
    ctypes.CDLL(None).fflush(None)  # what C libraries have printed must not reach a child's output


def _mount(link: socket.socket, request: dict, enclosed: bool) -> None:
    """Send a descriptor of the newly mounted folder, or none."""
    folder = request["mount"]
    if not enclosed or not namespace.mount(folder, request["size"], request["files"]):
        link.sendall(b"false\n")
        return
    top = os.open(folder, os.O_RDONLY | os.O_DIRECTORY)
    socket.send_fds(link, [b"true\n"], [top])
    os.close(top)


def _ended(pid: int, seconds: float) -> int | None:
    deadline = time.monotonic() + seconds
    while True:
        done, status = os.waitpid(pid, os.WNOHANG)
        if done:
            return os.waitstatus_to_exitcode(status)
        if time.monotonic() > deadline:
            return None
        time.sleep(POLL_SECONDS)


def _close_all_but(kept: set[int]) -> None:
    """Close all descriptors except these, whatever their numbers."""
    for name in os.listdir("/dev/fd"):
        if int(name) not in kept:
            with contextlib.suppress(OSError):  # the descriptor that listed the others
                os.close(int(name))


def _become_child(modules: list[str], descriptors: list[int], folder: str) -> None:
    """Close what belongs to the server, then serve requests; runs in the forked process."""
    code = 1
    try:
        os.setsid()
        *pipes, output = descriptors
        os.dup2(output, 1)
        os.dup2(output, 2)
        _close_all_but({0, 1, 2, *pipes})
        os.chdir(folder)
        if not _FORK_AFTER_IMPORTS:
            _import(modules)
        child.serve(*pipes)
        code = 0
    finally:
        with contextlib.suppress(Exception):
            sys.stderr.flush()
        os._exit(code)
