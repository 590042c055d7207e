"""Start a confined process, ask it, watch it and kill it."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import threading
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from botschool.sandbox import protocol, usage
from botschool.sandbox.allowance import Allowance
from botschool.sandbox.errors import SandboxError
from botschool.sandbox.scratch import Scratch
from botschool.sandbox.server import START_SECONDS, ForkServer, homes

OUTPUT_KEPT = 4000
"""Characters to keep of what the code prints."""
MAX_OUTPUT = 16 * 2**20
"""Bytes that the code may print."""
MAX_FILE = 64 * 2**20
"""Bytes of a written file."""
MAX_WRITTEN_IN_ALL = 2**30
"""Bytes that the code may write to the disk, including removed and overwritten ones."""
MAX_THREADS = 64
WHERE_SECONDS, MAX_TRACE = 1.0, 2**16
"""Seconds to wait for an answer to `where`; bytes of that answer."""
POLL_SECONDS = 0.1
"""Seconds between two checks of what the child uses."""


@dataclass(frozen=True)
class Limits:
    """Limits of what a child may use."""

    seconds: float = 20
    """Seconds of processor time, after which the system ends the child unless the caller has."""
    memory: int = 4 * 2**30
    """Bytes of address space beyond the imports' own."""


class Child:
    """A confined process that answers requests; it loads the untrusted file at the first one."""

    def __init__(
        self,
        server: ForkServer,
        scratch: Scratch,
        file: str,
        limits: Limits,
        readable: Iterable[Path] = (),
        references: dict[str, Any] | None = None,
        prepare: list[Any] | None = None,
        listed: Iterable[Path] = (),
        in_parts: bool = False,
    ) -> None:
        """Start the process.

        file: the name of the untrusted file in the scratch folder.
        readable: files and folders that it may read.
        references: {"source", "names"}: functions that replace the file's own ones.
        prepare: source of a function, its name and its arguments, called before the process is
        confined and the file is loaded; it returns a function to call afterwards.
        listed: folders in which it may read names, also of files that are closed.
        in_parts: whether a statement of the file that fails costs only what uses its names.
        Raises SandboxError.
        """
        self.helping: Callable[[Any], Any] | None = None
        """Answers what the child asks, which may be forged, before it answers a request. Its time
        is charged."""
        self._server = server
        self._scratch = scratch
        self._reason = ""
        self._kept = bytearray()
        self._closed = threading.Event()
        self._ending = threading.Lock()
        self._code: int | None = None
        self._memory_kills = usage.memory_kills()
        to_child, self._requests = os.pipe()
        self._answers, from_child = os.pipe()
        self._output, its_output = os.pipe()
        os.set_blocking(self._requests, False)
        try:
            scratch.enter(server)
            self._pid = server.start(to_child, from_child, its_output, scratch.folder)
        except SandboxError:
            self._close_pipes()
            os.close(self._output)
            raise
        finally:
            for fd in (to_child, from_child, its_output):
                os.close(fd)
        self._drains = threading.Thread(target=self._drain, daemon=True)
        self._drains.start()
        self.missing = self._set_up(
            limits,
            file=str(scratch.folder / file),
            readable=[str(path) for path in readable],
            listed=[str(path) for path in listed],
            references=references,
            prepare=prepare,
            in_parts=in_parts,
        )
        """What this system cannot confine: some of "files", "processes", "network"."""
        threading.Thread(target=self._look, daemon=True).start()

    def _set_up(self, limits: Limits, **given: Any) -> list[str]:
        set_up = given | {
            "seconds": limits.seconds,
            "memory": limits.memory,
            "file_size": MAX_FILE,
            "environment": homes(self._scratch.root),
            "writable": [str(self._scratch.root), "/dev/null"],
        }
        try:
            protocol.send(self._requests, protocol.pack(set_up), START_SECONDS)
            message = protocol.receive(self._answers, START_SECONDS)
        except (TimeoutError, BrokenPipeError):
            message = None
        if message is None:
            self.kill()
            lines = self.printed().strip().splitlines() or ["the process gave no reason"]
            raise SandboxError(f"The confined child process did not start: {lines[-1]}.")
        return protocol.unpack(message)["missing"]

    def ask(self, request: dict[str, Any], allowance: Allowance) -> dict[str, Any] | None:
        """Return the answer to a request; None if the child has ended.

        Raises TimeoutError when the allowance is used up, ValueError for anything that is not an
        answer.
        """
        with allowance.charged(self._pid) as left:
            while True:
                with contextlib.suppress(BrokenPipeError):
                    protocol.send(self._requests, protocol.pack(request), left)
                message = protocol.receive(self._answers, left)
                answer = None if message is None else protocol.unpack(message)
                if answer is not None and not isinstance(answer, dict):
                    raise ValueError("not an answer")
                if self.helping is None or answer is None or "asks" not in answer:
                    break
                with left.helping():
                    request = self.helping(answer["asks"])
        if answer is not None and "error" in answer and (full := self._scratch.is_full()):
            self._end(full)
            return None
        return answer

    def where(self) -> list[tuple[str, int]]:
        """Return (file, line) of the untrusted code that runs now, the innermost call first.

        File is a name in the scratch folder. Return [] if the process does not tell. After this
        call the process can answer no other request. The answer may be a lie.
        """
        with self._ending:
            if self._code is not None:
                return []
            with contextlib.suppress(OSError):
                os.kill(self._pid, signal.SIGUSR1)
        told = protocol.read_some(self._answers, MAX_TRACE, WHERE_SECONDS).decode(errors="replace")
        threads = re.split(r"(?=^(?:Current thread|Thread) 0x)", told, flags=re.MULTILINE)
        threads.sort(key=lambda thread: not thread.startswith("Current"))
        inside = re.compile(
            rf'^  File "{re.escape(str(self._scratch.folder))}/(.+)", line (\d+) in'
        )
        for thread in threads:
            found = [inside.match(line) for line in thread.splitlines()]
            if any(found):
                return [(each[1], int(each[2])) for each in found if each]
        return []

    def printed(self) -> str:
        """Return the beginning of what the child has printed."""
        text = bytes(self._kept).decode(errors="replace")
        return text if len(text) <= OUTPUT_KEPT else text[:OUTPUT_KEPT] + "\n[... cut]\n"

    def ending(self) -> str:
        """Return why the process ended, in words."""
        code = self._wait(1)
        if code is None:
            return "it closed its connection"
        if self._reason and code == -signal.SIGKILL:
            return self._reason
        if code == -getattr(signal, "SIGXCPU", 0):
            return "it used too much time"
        if code == -signal.SIGKILL:
            return "it was killed, by itself or for lack of memory"
        if code < 0:
            return f"it crashed (signal {-code})"
        return "it called exit, so nothing came back"

    def was_killed(self) -> bool:
        """Return whether the system, a user or the process itself killed it, not this object."""
        return self._wait(1) == -signal.SIGKILL and not self._reason and not self._closed.is_set()

    def memory_ran_out(self) -> bool:
        """Return whether Linux has killed a process for lack of memory since this one started."""
        return usage.memory_kills() > self._memory_kills

    def kill(self) -> None:
        """End the process with all its threads and everything it started."""
        self._closed.set()
        self._kill_group()
        self._wait(5)
        self._drains.join(1)  # what the child printed last may still be in the pipe
        self._close_pipes()

    def _wait(self, seconds: float) -> int | None:
        with self._ending:
            if self._code is None:
                self._code = self._server.ended(self._pid, seconds)
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
            self._reason = self._reason or reason
            self._kill_group()

    def _drain(self) -> None:
        total = 0
        with contextlib.suppress(OSError, ValueError):
            while part := os.read(self._output, 65536):
                total += len(part)
                self._kept += part[: max(0, 4 * OUTPUT_KEPT - len(self._kept))]
                if total > MAX_OUTPUT:
                    self._end(f"it printed more than {MAX_OUTPUT // 2**20} MB")
                    break
        with contextlib.suppress(OSError):
            os.close(self._output)

    def _look(self) -> None:
        while not self._closed.wait(POLL_SECONDS) and self._code is None:
            try:
                reason = self._trouble()
            except BaseException as error:  # a child that cannot be watched must not run
                reason = f"it could not be watched ({type(error).__name__})"
            if reason:
                self._end(reason)
                return

    def _trouble(self) -> str:
        """Return the limit that the child exceeds, in words; "" if none."""
        if usage.threads(self._pid) > MAX_THREADS:
            return f"it started more than {MAX_THREADS} threads"
        if usage.has_lost_its_leader(self._pid):
            return "it ended its first thread while others ran on"
        if self._scratch.in_memory:  # the kernel counts what the child writes
            return self._scratch.is_full()
        if usage.written_bytes(self._pid) > MAX_WRITTEN_IN_ALL:
            return f"it wrote more than {MAX_WRITTEN_IN_ALL // 2**20} MB to the disk in all"
        removed = usage.removed(self._pid, self._scratch.root, MAX_FILE)
        return self._scratch.trouble(removed.size, removed.count)
