"""Try a task's known mistakes if a check fails, to find one that answers as the submission does.

The result never changes the points. The checks run on our solution in a confined child; its calls
are repeated on the submission and on each known mistake. A mistake is reported if all its answers
equal the submission's and at least two of them, to different calls, differ from ours. Where the
submission raises an exception, the mistake must be wrong, too; it is proof if it raises the same.
Calls of functions that are not done yet do not count. If no mistake fits, the same is tried with
our solution with one slip in it (variations.py), then with right solutions in other styles with one
slip, and then with known mistakes that import a package.
"""

from __future__ import annotations

import math
import re
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from dataclasses import replace
from itertools import count, islice
from typing import Any, TypeVar

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Task
from botschool.grading.declare.mistakes import Case, Known
from botschool.grading.judge.alike import SINGLE, counts, distance, equal
from botschool.grading.judge.calls import LOOSE, LOOSEST, STRICT, Call, Check, raised
from botschool.grading.judge.evidence import may_be_true, words_of
from botschool.grading.judge.likeness import likest
from botschool.grading.judge.looking import TookTooLong, processor_time_limit
from botschool.grading.judge.sentences import Variation
from botschool.grading.judge.variations import variations
from botschool.grading.run.student import Student
from botschool.sandbox.protocol import unpack

TOLD = "Your code"
VARIED = "Your answers fit this slip:"
"""Words before the sentence on a known mistake, and before the sentence on a slip."""
SECONDS = 3.0
"""Processor seconds for all slips of a task; known mistakes have half of that before."""
SLIP_SECONDS = 0.1
"""Processor seconds for one answer with a slip in our solution, which may loop without end."""
CASE_SECONDS = 0.25
"""Processor seconds for the first answer of a known mistake, unless the submission took longer."""
BATCH, FEW = 16, 4
"""Slips that are tried in one request, and known mistakes, the likest ones first."""
MOST = 100
"""Mistakes of a task to try."""
INPUTS, COUNTS = 2, 4
"""Smallest number of different calls that must point to a mistake; the second is for slips if all
answers are small whole numbers.
"""
NOT_DONE = ("NotImplementedError", "Missing")
"""Exceptions of functions that are not done yet."""
T = TypeVar("T")
_NUMBERS = count()
"""Numbers of the folders in which mistakes are tried: files of one are not found by another."""
_IMPORTED = re.compile(r"^[ \t]*(?:from|import) +(\w+)", re.MULTILINE)


def named(
    ours: Student, calls: list[Call], first: Check | None, task: Task, known: Known, text: str
) -> str:
    """Return a line about the known mistake, or the slip, that gives these answers, or "".

    Of two mistakes, one may explain the calls of the first check that fails: it is named if
    nothing explains all calls. ours: our solution in a process whose time limits the search.
    text: the submission's.
    """
    levels = {
        level: [replace(each, loose=STRICT if each.check is first else level) for each in calls]
        for level in (STRICT, LOOSE, LOOSEST)
    }
    levels = {n: some for n, some in levels.items() if _tells(some, [e.got for e in some])}
    if not known.solution or not levels:
        return ""
    made = [(each.what, _changed(each, known.solution)) for each in known.of(task.id)[:MOST]]
    made = likest((pair for pair in made if pair[1]), known.solution, text)
    quick = [pair for pair in made if _imports_little(pair[1], known.solution)]
    rest = [pair for pair in made if pair not in quick]
    found, at = "", None
    with suppress(BotschoolError, Wrong):  # no time is left
        near: list[tuple[str, str]] = []
        strictest = next(iter(levels.values()))
        for pair in _fitting(ours, quick, [*levels.values()][-1]):
            if told := _mistake(ours, [pair], strictest):
                return told
            near.append(pair)
        for level, some in [*levels.items()][1:]:
            if found := _mistake(ours, near, some):
                at = level
                break
        for level, some in levels.items():
            if level in (at, LOOSEST):
                break
            slips = _slips(ours, task, known, some)
            if slip := _clearest(each for each in slips if may_be_true(each, text)):
                return f"{VARIED} {_placed(slip, text)}"
            if told := _mistake(ours, rest, some):
                return told
    return found


def _mistake(ours: Student, made: list[tuple[str, str]], calls: list[Call]) -> str:
    """Return a line about the first of these mistakes that explains all calls, or ""."""
    fits = (what for what, wrong in made if _explains(ours, wrong, calls))
    return line_about(what) if (what := next(fits, "")) else ""


def line_about(what: str) -> str:
    """Return the line about a known mistake; what: its sentence, "Takes the sum for the mean."."""
    return f"{TOLD} {_lower(what)}"


def _placed(slip: Variation, text: str) -> str:
    """Return the sentence of a slip, without a variable as its place that a text does not have."""
    placed = re.fullmatch(r"In `(\w+)`: (.*(?:wrong way round|sign is reversed).*)", slip.what)
    if placed is None or placed[1] in (slip.function, *words_of(text, slip.function)):
        return slip.what
    return placed[2][0].upper() + placed[2][1:]


def _lower(sentence: str) -> str:
    return sentence[0].lower() + sentence[1:]


def calls_of(ours: Student, checks: Iterable[Check]) -> list[Call]:
    """Return the calls that the checks make to our solution."""
    ours.trace = []
    for check in checks:
        try:
            with processor_time_limit(SECONDS):
                check(ours)
        except (Wrong, TookTooLong):
            continue
    found, ours.trace = ours.trace, None
    return [Call(request, unpack(answer), seconds) for request, answer, seconds in found]


def answered_by(submission: Student, call: Call) -> bool:
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


def _changed(case: Case, solution: str) -> str:
    """Return the text of a mistake; "" if it no longer fits the solution."""
    try:
        return case.of(solution)
    except ValueError:
        return ""


def _imports_little(text: str, solution: str) -> bool:
    """Return whether a text imports no package that our solution does not import.

    Such imports take long, and a time limit that cuts them short may crash the child.
    """
    names = {*_IMPORTED.findall(text)} - {*_IMPORTED.findall(solution)}
    return names <= sys.stdlib_module_names | {"numpy"}


def _fitting(
    ours: Student, made: list[tuple[str, str]], calls: list[Call]
) -> Iterator[tuple[str, str]]:
    """Yield (sentence, text) of mistakes that fit one wrong answer, for half of the time."""
    telling = _telling(calls)
    limit = max(CASE_SECONDS, 2 * telling.took)
    for batch in _batches(ours, made, SECONDS / 2, FEW):
        near = _near(ours, [text for _, text in batch], telling, limit, "known mistakes")
        yield from (pair for pair, fits_one in zip(batch, near, strict=True) if fits_one)


def _telling(calls: list[Call]) -> Call:
    """Return the call with the shortest request among those whose answers are wrong.

    An exception comes after other wrong answers, because many mistakes raise it. So does a call
    that takes our solution long: mistakes would run out of time.
    """
    return min(
        (call for call in calls if not call.loose),
        key=lambda c: (
            not c.wrong,
            c.equal is None and distance(c.got, c.ours) <= SINGLE,  # perhaps by rounding
            raised(c.got),
            max(c.seconds, c.took) > CASE_SECONDS / 2,
            len(c.request),
        ),
    )


def _near(ours: Student, texts: list[str], call: Call, seconds: float, said: str) -> list[bool]:
    """Return which texts answer a call as the submission does."""
    made = ours.run(tried, texts, unpack(call.request), seconds, said=said)
    return [bool(answers) and call.agrees(answers[0]) for answers in made]


def _explains(ours: Student, text: str, calls: list[Call]) -> bool:
    """Return whether a wrong solution answers as the submission does, in an empty folder."""
    made: list[Any] = []
    folder = f"try-{next(_NUMBERS)}"
    for part in (calls[:1], calls[1:]):
        try:
            requests = [unpack(call.request) for call in part]
            made += ours.run(answered, text, requests, folder, said="a known mistake")
        except Wrong:
            if ours.seconds_left <= 0:
                raise
            return False
        if not all(call.agrees(each) for call, each in zip(calls, made, strict=False)):
            return False
    return _tells(calls, made)


def _clearest(slips: Iterator[Variation]) -> Variation | None:
    """Return the first slip; if it is vague, the first of our own that names its place, if any."""
    first = next(slips, None)
    if first is None or not first.vague:
        return first
    try:
        return next((each for each in slips if each.own and not each.vague), first)
    except (BotschoolError, Wrong):  # no time is left
        return first


def _slips(ours: Student, task: Task, known: Known, calls: list[Call]) -> Iterator[Variation]:
    """Yield the slips that explain a submission's answers: in our solution, then in others."""
    telling = [call for call in calls if call.wrong]
    always = len(calls) > COUNTS and equal([call.got for call in calls])
    if _few(telling) or (always and not equal([call.ours for call in calls])):
        return  # any slip might lead to it
    whole = all(counts(call.got, math.inf) for call in telling)  # the same for a limit a bit away
    styles = [text for text in known.styles() if _imports_little(text, known.solution)]
    slips = (
        slip for slip in variations(known.solution, task.id, styles) if not (whole and slip.near)
    )
    for batch in _batches(ours, slips, SECONDS):
        texts = [each.text for each in batch]
        near = _near(ours, texts, _telling(calls), SLIP_SECONDS, "slips in our solution")
        for slip, fitting in zip(batch, near, strict=True):
            if fitting and _explains(ours, slip.text, calls):
                yield slip


def _few(wrong: list[Call]) -> bool:
    """Return whether wrong answers are exceptions or a few small whole numbers.

    Many slips may lead to these.
    """
    told = [call for call in wrong if not raised(call.got)]
    return not told or (all(counts(call.got) for call in told) and len(wrong) < COUNTS)


def _batches(
    ours: Student, each: Iterable[T], seconds: float, many: int = BATCH
) -> Iterator[list[T]]:
    """Yield a few at a time until they end, or until so many seconds of our child have passed."""
    waiting, end = iter(each), ours.seconds_left - seconds
    while ours.seconds_left > end and (batch := list(islice(waiting, many))):
        yield batch


def tried(module, texts, request, seconds):
    """Return the answers of other texts, each in a list, [] for none; runs in our child."""
    import copy
    import io
    import signal
    import sys
    import types

    from botschool.sandbox.child import run
    from botschool.sandbox.exceptions import MAX_TEXT
    from botschool.sandbox.protocol import pack

    class TooLong(BaseException):
        pass

    def end(number, frame):
        raise TooLong

    before = signal.signal(signal.SIGVTALRM, end)
    found = []
    for text in texts:
        other = types.ModuleType("student")
        other.__file__ = module.__file__
        sys.modules["student"] = other
        stdout, sys.stdout = sys.stdout, io.StringIO()
        answer = []
        try:
            signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
            exec(compile(text, module.__file__, "exec"), vars(other))
            try:
                answer = [run(other, copy.deepcopy(request))]
            except Exception as error:
                answer = [{"raised": type(error).__name__, "text": str(error)[:MAX_TEXT]}]
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            pack(answer)
        except BaseException:
            answer = []
        finally:
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
            sys.stdout = stdout
        found.append(answer)
    signal.signal(signal.SIGVTALRM, before)
    return found


def answered(module, text, requests, folder):
    """Return another text's answers in a folder; runs in the child of our solution."""
    import os
    import sys
    import types

    from botschool.sandbox.child import run
    from botschool.sandbox.exceptions import MAX_TEXT

    def answer(request):
        try:
            return run(other, request)
        except Exception as error:
            return {"raised": type(error).__name__, "text": str(error)[:MAX_TEXT]}

    other = types.ModuleType("student")
    other.__file__ = module.__file__
    sys.modules["student"] = other
    before = os.getcwd()
    os.makedirs(folder, exist_ok=True)
    os.chdir(folder)
    try:
        exec(compile(text, module.__file__, "exec"), vars(other))
        return [answer(request) for request in requests]
    finally:
        os.chdir(before)


def _tells(calls: list[Call], answers: list[Any]) -> bool:
    """Return whether answers that fit the submission's prove a mistake, on enough inputs.

    Exceptions alone are half as much proof, because many mistakes raise them.
    """
    told: dict[bytes, float] = {}
    for call, answer in zip(calls, answers, strict=True):
        told[call.request] = max(told.get(call.request, 0.0), call.proof(answer))
    failing = {call.request for call in calls if raised(call.got)}
    only = not any(proof for request, proof in told.items() if request not in failing)
    return sum(told.values()) / (2 if only else 1) >= INPUTS
