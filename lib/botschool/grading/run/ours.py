"""Run our solution in confined processes, to compare a submission with it."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Exercise
from botschool.grading.run.student import Student, driven
from botschool.sandbox import ForkServer
from botschool.sandbox.protocol import pack

SECONDS = 3600.0
"""Processor seconds of all answers."""
APART_SECONDS = 60.0
"""Processor seconds of a process in which mistakes are tried."""


@dataclass
class Answer:
    """Our answer to a request."""

    request: dict[str, Any]
    value: Any
    raised: str
    """The sentence on an exception; "" for an answer."""
    seconds: float
    """Processor seconds that it took."""


class Ours:
    """Our solution for the grading of one submission: answers are kept until it is closed."""

    def __init__(self, solution: str, file: str, memory: int, server: ForkServer) -> None:
        """Take the solution's text and the name of its file; a process starts when it is asked.

        memory: MB.
        """
        self.solution, self.server = solution, server
        self._folder = tempfile.TemporaryDirectory(prefix="botschool-")
        self.place = Path(self._folder.name) / file
        self.place.write_text(solution, encoding="utf-8")
        self._limits = SECONDS, memory, server, True
        self._student: Student | None = None
        self._apart: Student | None = None
        self._kept: dict[bytes, Answer] = {}

    @property
    def student(self) -> Student:
        """Return our solution as a submission."""
        self._student = self._student or Student(self.place, *self._limits)
        return self._student

    @property
    def apart(self) -> Student:
        """Return our solution in another process, in which nothing counts for points.

        Known mistakes are tried there. A new process starts when little time is left.
        """
        if self._apart is None or self._apart.seconds_left < APART_SECONDS / 2:
            self.leave()
            self._apart = Student(self.place, APART_SECONDS, *self._limits[1:])
        return self._apart

    def leave(self) -> None:
        """End the other process."""
        if self._apart is not None:
            self._apart.close()
            self._apart = None

    def answer(self, what: str | Callable[..., Any], arguments: tuple) -> Answer:
        """Return our answer of a function with this name, or of a driver."""
        if callable(what):
            return self.ask(driven(what, *arguments))
        return self.ask({"name": what, "arguments": arguments, "options": {}})

    def ask(self, request: dict[str, Any]) -> Answer:
        """Return our answer to a request, asked once."""
        key = pack(request)
        if key not in self._kept:
            before, value, raised = self.student.seconds_left, None, ""
            try:
                value = self.student.ask(request)
            except Wrong as error:
                raised = str(error)
            seconds = before - self.student.seconds_left
            self._kept[key] = Answer(request, value, raised, seconds)
        return self._kept[key]

    def close(self) -> None:
        """End the processes and remove the file."""
        self.leave()
        if self._student is not None:
            self._student.close()
        self._folder.cleanup()


def ours_of(exercise: Exercise, server: ForkServer) -> Ours:
    """Return an exercise's solution in a process, to compare a submission with."""
    memory = max((task.memory for task in exercise.tasks), default=4096)
    return Ours(exercise.known.solution, exercise.file, memory, server)
