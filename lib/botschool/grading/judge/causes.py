"""Explain the failures of a task: a cause, and a small call. Points do not depend on it.

The submission answers the task's quick calls again, in a new process. A known mistake of the
exercise is the cause if it gives all the wrong answers, to two different calls at least; the
mistakes are tried in a process of our solution. If none does, a detector may explain them.
"""

from __future__ import annotations

import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.alike import (
    INPUTS,
    TIE,
    Call,
    distance,
    proves,
    raised,
    telling_call,
)
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.diagnosis import diagnose
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Case, Known
from botschool.grading.declare.same import Same
from botschool.grading.judge.repeated import answer_afresh, repeats
from botschool.grading.judge.sentence import Check, Failure, difference, line_about
from botschool.grading.judge.smallest import smallest_call
from botschool.grading.run.limit import TookTooLong, processor_time_limit
from botschool.grading.run.ours import Ours
from botschool.grading.run.student import Student
from botschool.sandbox.protocol import pack, unpack

SECONDS = 1.5
"""Processor seconds for all known mistakes of a task."""
PATIENCE = 5.0
"""Processor seconds of one request to the process in which mistakes are tried."""
MOST_SECONDS = 0.25
"""Processor seconds of a known mistake's answer, unless the submission took longer."""
MANY = 6
"""Known mistakes that are tried in one request, the likest ones first."""
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
NOT_DONE = ("NotImplementedError", "Missing")
"""Exceptions of functions that are not done yet."""
_IMPORTED = re.compile(r"^[ \t]*(?:from|import) +(\w+)", re.MULTILINE)
_TOKEN = re.compile(r"\w+|[^\w\s]+")
Mistake = tuple[Case, str]
"""A known mistake, and the text of the solution that makes it."""


@dataclass
class Explanation:
    """The failures of a task that are to be explained."""

    task: Task
    known: Known
    ours: Ours
    begun: Callable[[], Student]
    """Starts the submission in a new process, whose time does not count."""
    failures: list[Failure]
    cheap: list[Check]
    """The task's quick checks."""
    quiet: bool = False
    """Whether nothing may be shown that the submission returns or raises: it could be ours."""

    def message(self) -> tuple[str, str]:
        """Return the cause, if it is found, and the first failure, perhaps with a smaller call."""
        first = self.failures[0]
        shown, cause = first.public if self.quiet else first.text, ""
        if not (first.answered or first.raised):
            return "", shown
        # no time is left, or a fault of the machine
        with suppress(BotschoolError, Wrong, OSError), closing(self.begun()) as again:
            wrong = next((failure for failure in self.failures if failure.quick), None)
            fresh = _answer(again, wrong.request) if wrong else None
            cause = self._cause(self._calls(again), wrong, fresh, again)
            if not self.quiet:
                shown = self._smaller(first, again)
        if len(f"{cause} {shown}".split()) > MOST_WORDS and not self.quiet:
            shown = first.text
        return cause, shown

    def _calls(self, again: Student) -> list[Call]:
        """Return the task's quick calls with both answers."""
        calls, more = list[Call](), list[Call]()
        for check in self.cheap:
            if not isinstance(check, Same):
                calls += self._calls_of(check)
                continue
            inputs = [(calls, arguments) for arguments in check.inputs()]
            inputs += [(more, arguments) for name, arguments in check.more() if name in MORE]
            for kind, arguments in inputs:
                answer = self.ours.answer(check.what, arguments)
                if not answer.raised and answer.seconds < SLOW:
                    kind.append(Call(pack(answer.request), answer.value, check, answer.seconds))
                    if check.view is not None:
                        kind[-1].equal = _equal_to(check, arguments)
        calls = [call for call in calls if _answered(again, call)]
        for call in more:
            few = len({kept.request for kept in calls if kept.wrong}) < INPUTS
            spent = sum(kept.took for kept in calls)
            if spent < (PATIENT if few else 1) * SPENT and _answered(again, call):
                calls.append(call)
        return calls

    def _calls_of(self, check: Check) -> list[Call]:
        """Return the calls that a check makes to our solution, which compares nothing itself."""
        student, calls = self.ours.student, list[Call]()
        student.trace = []
        with suppress(Wrong, TookTooLong), processor_time_limit(SECONDS):
            check(student)
        for request, answer, seconds in student.trace:
            calls.append(Call(request, unpack(answer), check, seconds))
        student.trace = None
        return calls

    def _cause(self, calls: list[Call], wrong: Failure | None, fresh: Any, again: Student) -> str:
        """Return a sentence on the cause, or ""."""
        first = self.failures[0].check
        if case := self._known_mistake(calls, first, again.text):
            return line_about(case.what)
        if self.quiet:
            return ""
        unsteady = changes = ""
        if wrong is not None and not wrong.stays:
            unsteady, changes = repeats(wrong, fresh, again, self.begun, self.ours.apart)
        if unsteady:
            return unsteady  # the numbers of such answers mean nothing
        of_first = [call for call in calls if call.check is first]
        return _diagnosed(calls) or _diagnosed(of_first) or changes

    def _known_mistake(self, calls: list[Call], first: Check | None, text: str) -> Case | None:
        """Return the first mistake that gives all answers of the submission.

        If there is none, it is one that gives those of the first failed check, and elsewhere is
        wrong only where the submission is wrong, too: that has two mistakes then.
        """
        if not proves(calls, [call.got for call in calls]):
            return None
        at_first = [call for call in calls if call.check is first]
        telling = telling_call(at_first if any(call.wrong for call in at_first) else calls)
        part: Case | None = None
        with suppress(BotschoolError, Wrong):  # no time is left
            for case, mistake in self._fitting(telling, text):
                answers = self._answers([mistake], [call.request for call in calls], 0)[0]
                if len(answers) < len(calls):
                    continue
                pairs = [*zip(calls, answers, strict=True)]
                if not proves(calls, answers):
                    continue
                if all(call.agrees(answer) for call, answer in pairs):
                    return case
                in_part = all(
                    call.agrees(answer)
                    or (call.check is not first and (call.wrong or call.right(answer)))
                    for call, answer in pairs
                )
                of_first = [answer for call, answer in pairs if call.check is first]
                if part is None and in_part and proves(at_first, of_first):
                    part = case
        return part

    def _fitting(self, telling: Call, text: str) -> Iterator[Mistake]:
        """Yield the mistakes that answer one call as the submission does, the likest ones first."""
        mistakes = likest(self.known.changed(self.task.id), self.known.solution, text)
        quick = [_imports_little(mistake, self.known.solution) for _, mistake in mistakes]
        usual = [pair for pair, few in zip(mistakes, quick, strict=True) if few]
        batches = [usual[at : at + MANY] for at in range(0, len(usual), MANY)]
        end, limit = self.ours.apart.seconds_left - SECONDS, max(MOST_SECONDS, 2 * telling.took)
        # a limit that cuts an import short may crash the process
        alone = [[pair] for pair, few in zip(mistakes, quick, strict=True) if not few]
        for number, batch in enumerate([*batches, *alone]):
            if self.ours.apart.seconds_left < end:
                return
            seconds = limit if number < len(batches) else 0
            texts = [mistake for _, mistake in batch]
            answers = self._answers(texts, [telling.request], seconds)
            for pair, answer in zip(batch, answers, strict=True):
                if answer and telling.agrees(answer[0]):
                    yield pair

    def _answers(self, texts: list[str], requests: list[bytes], seconds: float) -> list[list]:
        """Return the answers of each text; [] where one takes longer than so many seconds."""
        apart, given = self.ours.apart, [unpack(request) for request in requests]
        try:
            with apart.within(PATIENCE, answers_of):
                return apart.run(answers_of, texts, given, seconds, said="known mistakes")
        except Wrong:  # a mistake may have changed more than itself
            self.ours.leave()
            return [[] for _ in texts]

    def _smaller(self, first: Failure, again: Student) -> str:
        """Return the failure's sentence, about a small call if it does not show its own."""
        small = None
        if not first.shown and first.direct and first.quick:
            small = smallest_call(first.direct, again, self.ours.apart)
        if small is None:
            return first.text
        text, request, right = small
        got = answer_afresh(request, self.begun)
        return difference(text, got, right) if distance(got, right) > TIE else first.text


def _equal_to(check: Same, arguments: tuple) -> Callable[[Any, Any], bool]:
    return lambda one, other: check.equal(arguments, one, other)


def _answer(student: Student, request: dict[str, Any]) -> Any:
    try:
        return student.ask(request)
    except Wrong:
        return None


def _answered(submission: Student, call: Call) -> bool:
    """Store the submission's answer to a call; return False if that function is not done yet."""
    before = submission.seconds_left
    try:
        call.got = submission.ask(unpack(call.request))
        call.took = before - submission.seconds_left
    except Wrong:
        if not submission.raised:
            raise
        call.got = submission.raised
    return not raised(call.got) or call.got["raised"] not in NOT_DONE


def likest(mistakes: list[Mistake], solution: str, text: str) -> list[Mistake]:
    """Return the mistakes, the one whose text is most like the submission's first.

    Pairs of neighbouring words count: of those that a mistake adds to our solution, or takes away,
    the share that the submission adds or takes away as well. Equals stay in order.
    """
    theirs = _pairs_apart(solution, text)

    def likeness(mistake: Mistake) -> float:
        own = _pairs_apart(solution, mistake[1])
        shared = sum((one & other).total() for one, other in zip(own, theirs, strict=True))
        return shared / (sum(pairs.total() for pairs in own) or 1)

    return sorted(mistakes, key=likeness, reverse=True)


def _pairs_apart(solution: str, text: str) -> tuple[Counter, Counter]:
    """Return the pairs that a text adds to our solution, and those that it lacks."""
    ours, other = Counter(solution.splitlines()), Counter(text.splitlines())
    more, fewer = _pairs(other - ours), _pairs(ours - other)
    return more - fewer, fewer - more


def _pairs(lines: Counter[str]) -> Counter:
    return Counter(pair for line in lines.elements() for pair in pairwise(_TOKEN.findall(line)))


def _imports_little(text: str, solution: str) -> bool:
    """Return whether a text imports no package that our solution does not import, which is slow."""
    names = {*_IMPORTED.findall(text)} - {*_IMPORTED.findall(solution)}
    return names <= sys.stdlib_module_names | {"numpy"}


def _diagnosed(calls: list[Call]) -> str:
    """Return a sentence that nearly all wrong answers suggest, two at least, or "".

    A few inputs, as an angle of 0, may suggest another one, or none.
    """
    different = {call.request: call for call in calls if call.wrong}.values()
    suggested: list[tuple[str, str, str]] = []
    for call in sorted(different, key=lambda call: len(call.request)):
        if (numbers := call.numbers()) is not None:
            got, wanted, given, part = numbers
            suggested.append((*diagnose(got, wanted, tuple(given), call.got), part))
    detectors = [detector for detector, _, _ in suggested]
    often = max(filter(None, detectors), key=detectors.count, default="")
    if not often or detectors.count(often) < max(2, MOSTLY * len(detectors)):
        return ""
    chosen = [(sentence, part) for detector, sentence, part in suggested if detector == often]
    sentence, part = chosen[0]
    return f"{part}: {sentence}" if part and len({p for _, p in chosen}) == 1 else sentence


def answers_of(module, texts, requests, seconds):
    """Return each text's answers to requests, in a new folder; runs in a child of our solution.

    seconds: processor time of a text, 0 for no limit; one that takes longer has no answers.
    """
    import io
    import os
    import signal
    import sys
    import tempfile
    import types

    from botschool.sandbox.child import run
    from botschool.sandbox.exceptions import MAX_TEXT
    from botschool.sandbox.protocol import pack, unpack

    class TooLong(BaseException):
        pass

    def end(number, frame):
        raise TooLong

    def answer(request):
        try:
            return run(other, request)
        except Exception as error:
            return {"raised": type(error).__name__, "text": str(error)[:MAX_TEXT]}

    before, stdout, packed = os.getcwd(), sys.stdout, pack(requests)
    handler = signal.signal(signal.SIGVTALRM, end)
    answers = []
    for text in texts:
        own = []
        other = types.ModuleType("student")
        other.__file__ = module.__file__
        sys.modules["student"] = other
        os.chdir(tempfile.mkdtemp(dir=before))
        sys.stdout = io.StringIO()
        try:
            signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
            exec(compile(text, module.__file__, "exec"), vars(other))
            own = [answer(request) for request in unpack(packed)]
            pack(own)
        except BaseException:
            own = []
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            sys.stdout = stdout
            os.chdir(before)
        answers.append(own)
    signal.signal(signal.SIGVTALRM, handler)
    return answers
