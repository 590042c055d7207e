"""Explain why checks failed: a known mistake or another cause, and a small call to try."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Known
from botschool.grading.judge.afresh import KEPT, answers_afresh, kept_something
from botschool.grading.judge.alike import TIE, distance
from botschool.grading.judge.known import VARIED, known_mistake
from botschool.grading.judge.looking import Failure, look_for_causes, looked_at_again
from botschool.grading.judge.sentences import is_vague
from botschool.grading.judge.smallest import difference, smallest_case
from botschool.grading.run.student import Student
from botschool.sandbox import ForkServer

SHORT = 120
"""Characters of a call that needs no smaller one."""
MAX_DIAGNOSED = 2
"""Failures of a function whose calls are repeated."""


@dataclass
class SecondLook:
    """A task's failed checks, to be explained. Points do not depend on it."""

    task: Task
    known: Known
    name: str
    """The name of the submission's file."""
    server: ForkServer
    seconds: float
    """Processor seconds of each process of the submission, or of our solution."""
    begun: Callable[[], Student]
    """Starts the submission in a new process, whose time does not count."""
    cheap: list[Callable[[Student], None]]
    """The task's quick checks."""
    failed: list[tuple[int, Failure]]
    """Places in `problems`, and failures."""
    problems: list[str]
    """A text for each failed check."""

    def explain(self) -> str:
        """Add causes and calls to the problems; return a line on the known mistake, or ""."""
        with tempfile.TemporaryDirectory(prefix="botschool-") as folder:
            place = Path(folder) / self.name
            place.write_text(self.known.solution, encoding="utf-8")
            limits = self.seconds, self.task.memory, self.server, True
            ours = partial(Student, place, *limits, refused=self.task.refused)
            with closing(self.begun()) as again:
                told = self._known_mistake(again, place)
                self._add_causes(told)
                self._add_calls(again, ours)
                if not told:
                    self._add_differences(again, ours)
        return told

    def _known_mistake(self, again: Student, place: Path) -> str:
        """Return a line on a known mistake, or ""; find other causes for the failures."""
        failures = [failure for _, failure in self.failed]
        if not any(failure.answered or failure.raised for failure in failures):
            return ""
        failing = [failure.check for failure in failures]
        slow = [
            (each.request, each.got)
            for each in failures
            if each.answered and each.check not in self.cheap
        ]
        told = known_mistake(self.task, self.cheap, self.known, again, place, self.server, slow)
        look_for_causes(failures, [each for each in self.cheap if each not in failing], again)
        if told.startswith(VARIED) and any(failure.named for failure in failures):
            return ""  # the check's own sentence is written for the task
        return told

    def _add_causes(self, told: str) -> None:
        """Add the causes, each once, if no known mistake explains the failures."""
        causes: set[str] = set()
        vague = told.startswith(VARIED) and is_vague(told[len(VARIED) :])
        for at, failure in self.failed:
            known_cause = (told and not vague) or failure.cause in causes
            cause = "" if known_cause else failure.cause
            causes.add(cause)
            self.problems[at] = f"{failure.text}\n  {cause}" if cause else failure.text

    def _add_calls(self, again: Student, ours: Callable[[], Student]) -> None:
        """Add a call to try to the first failure; it must show the mistake in a new process."""
        for at, failure in [pair for pair in self.failed if pair[1].told][:1]:
            text, call, small = failure.pasted, failure.direct, None
            if self.known.solution and (len(text) > SHORT or not text):
                small = smallest_case(call, again, ours)
                text, call = small or (text, call)
            answers = answers_afresh(call, self.begun, ours) if text else None
            if answers and distance(*answers) <= TIE:
                continue  # it is right in a new process
            if small:
                text = difference(text, *answers) if answers else ""
            if text:
                self.problems[at] += f"\n  To try it: {text}"

    def _add_differences(self, again: Student, ours: Callable[[], Student]) -> None:
        """Add what more calls show to one failure of each function, of those without a cause.

        Two answers that chance decides may be equal, so a later failure may show it.
        """
        looked: dict[str, list[tuple[int, Failure]]] = {}
        for at, failure in self.failed:
            if failure.quick and not failure.cause:
                looked.setdefault(failure.name, []).append((at, failure))
        for failures in looked.values():
            for at, failure in failures[:MAX_DIAGNOSED]:
                if kept_something(failure, self.begun, ours):
                    text = f"\n  {KEPT}"
                else:
                    text = looked_at_again(failure, again, ours)
                self.problems[at] += text
                if text:
                    break
