"""Explain the failures of a task whose grader declares its inputs: a cause, and a small call.

The submission answers all inputs of the task again, in a new process. A known mistake, or a slip of
our solution, is the cause if it gives all these answers (known.py). Points do not depend on it.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass, replace
from functools import partial

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.diagnosis import diagnose
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Known
from botschool.grading.declare.same import KEPT as STAYS
from botschool.grading.declare.same import Same
from botschool.grading.judge.afresh import KEPT, answers_afresh, kept_something
from botschool.grading.judge.alike import TIE, distance
from botschool.grading.judge.calls import Call
from botschool.grading.judge.known import INPUTS, answered_by, calls_of, named
from botschool.grading.judge.looking import Failure, looked_at_again
from botschool.grading.judge.smallest import difference, smallest_case
from botschool.grading.run.ours import Ours
from botschool.grading.run.student import IN_PLACE, Student
from botschool.sandbox.protocol import pack

SECONDS = 3.0
"""Processor seconds to find a cause."""
SLOW = 0.2
"""Processor seconds of our answer to a call that is not repeated."""
SPENT = 0.5
"""Processor seconds of the submission's answers, after which no more calls are made from inputs."""
PATIENT = 4
"""SPENT is so many times as long while too few answers are wrong to name a mistake."""
MOST_WORDS = 80
"""Words of a message; of a longer one, the small call is not shown."""
MORE = ("draw", "changes", "square", "one")
"""The inputs, made from those of a check, whose answers a cause must give, too."""
MOSTLY = 0.8
"""Share of the wrong answers that suggest the same cause."""
_DIGITS = re.compile(r"[-+]?\d[\d.e+-]*")


@dataclass
class Explanation:
    """The failures of a task that are to be explained."""

    task: Task
    known: Known
    ours: Ours
    begun: Callable[[], Student]
    """Starts the submission in a new process, whose time does not count."""
    failures: list[Failure]
    cheap: list[Callable[[Student], None]]
    """The task's quick checks."""
    quiet: bool = False
    """Whether nothing may be shown that the submission returns or raises: it could be ours."""

    def text(self) -> str:
        """Return the cause, if it is found, and the first failure, perhaps with a smaller call."""
        first = self.failures[0]
        shown, cause = first.text, ""
        if self.quiet:
            shown = f"Then {first.pasted} is wrong." if first.pasted else ""
        if not (first.answered or first.raised):
            return shown
        with closing(self.begun()) as again:
            try:
                calls = self._calls(again)
                cause = self._cause(calls, again)
                shown = shown if self.quiet else self._shown(first, again)
            except (BotschoolError, Wrong, OSError):  # no time is left, or a fault of the machine
                pass
        if len(f"{cause} {shown}".split()) > MOST_WORDS:
            shown = first.text
        return cause if cause and self.quiet else "\n".join(filter(None, [cause, shown]))

    def _calls(self, again: Student) -> list[Call]:
        """Return the task's quick calls with both answers."""
        found, more = list[Call](), list[Call]()
        for check in self.cheap:
            if not isinstance(check, Same):
                found += [replace(e, check=check) for e in calls_of(self.ours.student, [check])]
                continue
            made = [(more, each) for name, each in check.more() if name in MORE]
            for calls, arguments in [*((found, each) for each in check.inputs()), *made]:
                answer = self.ours.answer(check.what, arguments)
                if not answer.raised and answer.seconds < SLOW:
                    call = Call(pack(answer.request), answer.value, answer.seconds, check=check)
                    if check.view is not None:
                        call.equal = partial(check.equal, arguments)
                    calls.append(call)
        kept = [call for call in found if answered_by(again, call)]
        for call in more:
            few = len({each.request for each in kept if each.wrong}) < INPUTS
            spent = sum(each.took for each in kept)
            if spent < (PATIENT if few else 1) * SPENT and answered_by(again, call):
                kept.append(call)
        return kept

    def _cause(self, calls: list[Call], again: Student) -> str:
        """Return a sentence on the cause, or ""."""
        limits = SECONDS, self.task.memory, self.ours.server, True
        first = self.failures[0].check
        with closing(Student(self.ours.place, *limits)) as other:
            if told := named(other, calls, first, self.task, self.known, again.text):
                return told
        if self.quiet:
            return ""
        unsteady = self._not_steady(again)
        if unsteady and IN_PLACE not in unsteady:
            return unsteady  # the numbers of such answers mean nothing
        of_first = [call for call in calls if call.check is first]
        return self._diagnosed(calls) or self._diagnosed(of_first) or unsteady

    def _diagnosed(self, calls: list[Call]) -> str:
        """Return a sentence that nearly all wrong answers suggest, two at least, or "".

        A few inputs, as an angle of 0, may suggest another one, or none.
        """
        told: list[tuple[str, str]] = []
        different = {call.request: call for call in calls}.values()
        for call in sorted(different, key=lambda call: len(call.request)):
            wrong = call.numbers()
            if wrong is not None and call.wrong:
                got, wanted, given, name = wrong
                told.append((diagnose(got, wanted, tuple(given), call.got), name))
        alike = [_DIGITS.sub("", said) for said, _ in told]
        often = max(filter(None, alike), key=alike.count, default="")
        if not often or alike.count(often) < max(2, MOSTLY * len(alike)):
            return ""
        chosen = [each for each, text in zip(told, alike, strict=True) if text == often]
        names = {name for _, name in chosen}
        said, name = chosen[0]
        return f"{name}: {said}" if name and len(names) == 1 else said

    def _not_steady(self, again: Student) -> str:
        """Return a sentence if two equal calls have different answers."""
        failure = next((each for each in self.failures if each.quick), None)
        if failure is None or STAYS in failure.text:
            return ""
        ours = partial(self._our_student, 10.0)
        if failure.answered and kept_something(failure, self.begun, ours):
            return KEPT
        return looked_at_again(failure, again, ours).strip()

    def _our_student(self, seconds: float) -> Student:
        limits = seconds, self.task.memory, self.ours.server, True
        return Student(self.ours.place, *limits, refused=self.task.refused)

    def _shown(self, first: Failure, again: Student) -> str:
        """Return the failure's sentence, about a small call if it does not show its own."""
        if first.shown or not first.direct or not first.quick:
            return first.text
        ours = partial(self._our_student, 10.0)
        small = smallest_case(first.direct, again, ours)
        answers = answers_afresh(small[1], self.begun, ours) if small else None
        if small and answers and distance(*answers) > TIE:
            return difference(small[0], *answers)
        return first.text
