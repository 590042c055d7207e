"""Run a submission in a child process: calls go in, plain data comes out."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.libraries import Refused
from botschool.grading.declare.values import argument, pasted
from botschool.grading.run.confined import (
    NOTHING,
    MachineFault,
    fork_server,
    machine_fault,
    scratch_copy,
    source_of,
    start_child,
)
from botschool.grading.run.failures import Origin, SourceLines, explained, where_it_was
from botschool.grading.run.rewiring import Rewired
from botschool.sandbox import Allowance, Child, ForkServer, Limits
from botschool.sandbox.protocol import pack
from botschool.sandbox.usage import is_full

IN_PLACE = "in place, but the caller still needs it as it was: work on a copy (.copy())."


class Student:
    """A submission's file, ready to be called.

    All calls together may use `seconds` of processor time, and some more of the time that passes
    (sandbox.Allowance). If a child dies, hangs or is killed, the next call starts another one, so
    that later checks are judged independently.
    """

    def __init__(
        self,
        file: Path,
        seconds: float = 20,
        memory: int = 4096,
        server: ForkServer | None = None,
        tried: bool = True,
        origin: Origin | None = None,
        references: dict[str, Any] | None = None,
        refused: Refused = NOTHING,
    ) -> None:
        """Prepare the submission. Raises Wrong if it is too large.

        memory: MB of address space. server: a fork server; None starts one. refused: what the
        submission's process does not have.
        origin: where the lines of the file come from, if it is made of parts of another one.
        references: as in sandbox.Child, functions that replace the submission's own.
        tried: whether a fault that may be the machine's has happened before; then a second one
        counts against the submission, unless the machine is known to be at fault.
        """
        self._file = Path(file)
        self._memory = memory * 2**20
        self._allowance = Allowance(seconds)
        self._tried = tried
        self._refused = refused
        self._child: Child | None = None
        self._printed = ""
        self._limit = self._later = 0.0
        self.hung: set[str] = set()
        """Names of functions and drivers that did not return in time."""
        self.missing: list[str] = []
        """What this system could not confine, in words."""
        self.answers = 0
        """Number of requests that the submission has answered."""
        self.said = "your file"
        """The last call, as the learner would write it."""
        self.pasted = ""
        """The last call to paste into Python; "" if it is too long, or not a function call."""
        self.request: dict[str, Any] = {}
        """The last request."""
        self.direct: dict[str, Any] = {}
        """The last function call as a request, also one that a driver made; else {}."""
        self.answer: Any = None
        """The answer to the last request."""
        self.raised: dict[str, str] = {}
        """What the last request raised, "raised" and "text" of the exception; else {}."""
        self.changed = ""
        """A sentence on the first call that changed an array, list or dict of its caller."""
        self.trace: list[tuple[bytes, bytes, float]] | None = None
        """Packed requests and their packed answers, if this is a list."""
        self.rewired: Rewired | None = None
        """The robot of the last request, with its record of what was evaluated."""
        self._references = references
        self._origin = origin or Origin()
        self._source = SourceLines(self._file, self._origin)
        self._scratch = scratch_copy(self._file)
        self._server = server
        self._own: ForkServer | None = None

    def call(self, name: str, *arguments: Any, **options: Any) -> Any:
        """Call a function of the submission; return its result as plain data.

        Raises Wrong with a sentence if the call fails, hangs or returns something else.
        """
        shown = [*map(argument, arguments), *(f"{k}={argument(v)}" for k, v in options.items())]
        self.said = f"{name}({', '.join(shown)})"
        self.pasted = pasted(name, arguments, options)
        self.direct = {"name": name, "arguments": arguments, "options": options}
        return self._request(self.direct)

    def run(
        self,
        driver: Callable[..., Any],
        *arguments: Any,
        said: str | None = None,
        call: tuple[Any, ...] | None = None,
        robot: dict[str, Any] | None = None,
    ) -> Any:
        """Run a function of the grader in the child, as driver(student_module, ...).

        The driver must import what it needs. The submission can forge what the driver reports:
        check it. call: name and arguments of the function that the driver calls, if it calls one;
        learners can then try it. robot: arguments of a Rewired, which stays in this process and
        answers the driver, driver(student_module, ask, ...); then `rewired` is it.
        """
        self.said, self.pasted, self.direct = said or f"{driver.__name__}(...)", "", {}
        if call is not None:
            self.pasted = pasted(call[0], call[1:], {})
            self.direct = {"name": call[0], "arguments": call[1:], "options": {}}
        request = driven(driver, *arguments)
        return self._request(request if robot is None else request | {"robot": robot})

    @contextmanager
    def within(self, seconds: float, what: str | Callable[..., Any]) -> Iterator[None]:
        """Limit the processor time of the calls in the block.

        what: the function or driver; Wrong is raised if it has not returned in time before.
        """
        self._not_hung(what if isinstance(what, str) else what.__name__)
        allowed, self._limit = self._allowance.seconds, seconds
        self._allowance.seconds = min(allowed, self._allowance.processor + seconds)
        self._later = allowed - self._allowance.seconds
        try:
            yield
        finally:
            self._allowance.seconds, self._limit, self._later = allowed, 0.0, 0.0

    def _not_hung(self, name: str) -> None:
        if name in self.hung:
            raise Wrong("It is not called again: a call before took too long, or all memory.")

    def ask(self, request: dict[str, Any]) -> Any:
        """Repeat a request from another Student's trace and return the answer. Raises Wrong."""
        self.said = str(request["name"])
        return self._request(request)

    def twice(self, request: dict[str, Any]) -> dict[str, Any] | None:
        """Make a request twice; return both answers and the arguments after the first time.

        The keys are "answers" and "arguments"; None if a request fails. No points depend on it.
        """
        try:
            found = self._request(request | {"twice": True})
        except Wrong:
            return None
        fine = isinstance(found, dict) and isinstance(found.get("answers"), list)
        return found if fine and len(found["answers"]) == 2 else None

    @property
    def text(self) -> str:
        """Return the submission's text."""
        return self._file.read_text(encoding="utf-8", errors="replace")

    @property
    def printed(self) -> str:
        """Return the beginning of what the submission has printed."""
        text = self._printed + (self._child.printed() if self._child else "")
        return self._source.without_folder(text, str(self._scratch.folder))

    @property
    def seconds_left(self) -> float:
        """Return the seconds left."""
        return self._allowance.left

    def scratch(self, name: str) -> Path:
        """Copy a file that the submission has written beside its own; return the copy's path."""
        try:
            return self._scratch.copy(name)
        except OSError as error:
            fault = machine_fault(error)
            if isinstance(fault, MachineFault):
                raise fault from None
            raise Wrong(f"{self.said} should have written the file {name}, but has not.") from None

    def pictures(self) -> list[tuple[str, bytes]]:
        """Return (name, content) of a few small PNG files beside the submission's file."""
        return self._scratch.pictures()

    def stop(self) -> None:
        """Kill the child, if there is one; the next call starts another."""
        if self._child is not None:
            self._child.kill()
            self._printed = self.printed
            self._child = None

    def close(self) -> None:
        """Kill the child and remove the scratch copy."""
        self.stop()
        if self._own is not None:
            self._own.close()
        self._scratch.remove()

    def _request(self, request: dict[str, Any]) -> Any:
        self.request, self.answer, self.raised = request, None, {}
        self._not_hung(str(request["name"]))
        if self.seconds_left <= 0:
            raise Wrong("the task's time was used up by the checks before.")
        first, before = self._child is None, self.seconds_left
        if first:
            if self._server is None:
                self._server = self._own = fork_server()
            limits = Limits(self.seconds_left + self._later, self._memory)
            given = self._references, self._refused, self._origin.in_parts
            self._child = start_child(self._server, self._scratch, self._file, limits, *given)
            self.missing = self._child.missing
        try:
            answer = self._answer_to(request)
        except TimeoutError:
            where = where_it_was(self._child.where(), self._source)
            self.stop()
            self.hung.add(str(request["name"]))
            slept = ": it waits instead of computing" if self._allowance.slept else ""
            # A call's limit depends on how long our solution took: whole seconds repeat.
            limit = self._allowance.seconds
            within = str(int(self._limit)) if self._limit else f"the task's {limit:.3g}"
            raise Wrong(
                f"{self.said} did not return within {within} seconds{slept}.{where}"
            ) from None
        except ValueError:
            self.stop()
            raise Wrong(f"{self.said} sent back something that is not plain data.") from None
        if answer is None:
            reason = self._child.ending()
            self._blame_the_machine_for_a_kill()
            self.stop()
            raise Wrong(f"The program ended while {self.said} was running: {reason}.")
        self.answers += 1
        self._blame_the_machine_for_a_full_disk(answer)
        if answer.get("error") == "MemoryError":
            self.hung.add(str(request["name"]))
        if "error" in answer:
            self.raised = {"raised": str(answer["error"]), "text": str(answer.get("text"))}
            raise explained(answer, self.said, self._source)
        if "value" not in answer:
            raise Wrong(f"{self.said} sent back something that is not plain data.")
        self.answer = answer["value"]
        if answer.get("changed") and not self.changed:
            number = answer["changed"][0] if isinstance(answer["changed"], list) else "?"
            self.changed = f"{self.said} changed its argument number {number} {IN_PLACE}"
        if self.trace is not None:
            self.trace.append((pack(request), pack(self.answer), before - self.seconds_left))
        return self.answer

    def _answer_to(self, request: dict[str, Any]) -> dict[str, Any] | None:
        """Return what Child.ask returns. A robot answers the child in between.

        It does so in a thread: its time is the task's, not that of the check.
        """
        if "robot" not in request:
            self._child.helping = None
            return self._child.ask(request, self._allowance)
        self.rewired = Rewired(**request["robot"])
        self._child.helping = self.rewired.answer
        sent = {name: each for name, each in request.items() if name != "robot"} | {"asks": True}
        with ThreadPoolExecutor(1) as thread:
            return thread.submit(self._child.ask, sent, self._allowance).result()

    def _blame_the_machine_for_a_kill(self) -> None:
        """Raise MachineFault if something other than the grader has killed the child."""
        if not self._child.was_killed():
            return
        memory = self._child.memory_ran_out()
        if memory or not self._tried:
            why = "for lack of memory" if memory else "from outside"
            raise MachineFault(
                f"A process of the grading was killed {why} while {self.said} was running: close "
                "other programs, or use fewer workers (-w), and grade again."
            )

    def _blame_the_machine_for_a_full_disk(self, answer: dict[str, Any]) -> None:
        """Raise MachineFault if other programs have filled the disk."""
        full = os.strerror(errno.ENOSPC) in str(answer.get("text"))
        if full and (is_full(self._scratch.root) or not self._tried):
            raise MachineFault(
                f"The disk was full while {self.said} was running: free some space and grade again."
            )


def driven(driver: Callable[..., Any], *arguments: Any) -> dict[str, Any]:
    """Return the request that runs a driver."""
    return {"driver": source_of(driver), "name": driver.__name__, "arguments": arguments}
