"""Run a task's checks on many texts in this process: for slips of our own solution only.

It is not confined and has no processes, so it is a hundred times as fast as grading.
"""

import contextlib
import io
import os
import signal
import sys
import tempfile
import types

from botschool.grading.declare.checks import Wrong
from botschool.grading.run.ours import Answer
from botschool.sandbox.protocol import NotPlain, pack, unpack

SECONDS = 3
"""Processor seconds for all checks of a task; a slip that takes longer is caught."""


SHORT = 0.02
"""Seconds that each answer of our solution is said to take."""


class Slow(BaseException):
    """A slip loops without end."""


class Direct:
    """Offers the methods of Student that checks use."""

    seconds_left = 99.0
    said = pasted = changed = ""
    hung: frozenset[str] = frozenset()

    def __init__(self, text):
        self._text = text
        self.stop()

    def stop(self):
        self.module = types.ModuleType("student")
        self.module.__file__ = "student.py"
        sys.modules["student"] = self.module
        exec(compile(self._text, "<slip>", "exec"), vars(self.module))

    def within(self, seconds, what):
        return contextlib.nullcontext()

    def call(self, name, *arguments, **options):
        self.said, before = f"{name}(...)", pack([arguments, options])
        given = unpack(before)
        answer = self._answer(lambda: getattr(self.module, name)(*given[0], **given[1]))
        if pack(given) != before:
            self.changed = f"{self.said} changed an argument."
        return answer

    def run(self, driver, *arguments, said=None, call=None):
        self.said = said or driver.__name__
        given = unpack(pack([*arguments]))
        return self._answer(lambda: driver(self.module, *given))

    def _answer(self, call):
        try:
            return unpack(pack(call()))
        except (Exception, NotPlain) as error:
            raise Wrong(f"{self.said} raised {error!r}") from None


class DirectOurs:
    """Answers as run.ours.Ours does; keeps all answers."""

    def __init__(self, solution):
        self.solution, self._student, self._kept = solution, Direct(solution), {}

    def answer(self, what, arguments):
        key = pack([what if isinstance(what, str) else what.__name__, [*arguments]])
        if key not in self._kept:
            ask = self._student.run if callable(what) else self._student.call
            value, raised = None, ""
            try:
                value = ask(what, *arguments)
            except Wrong as error:
                raised = str(error)
            self._kept[key] = Answer({}, value, raised, SHORT)
        return self._kept[key]


def problem(task, text, seconds=SECONDS):
    """Why a text loses points of a task; "" if it does not. seconds: of the processor, at most."""

    def end(*_):
        raise Slow

    signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    quiet, before = io.StringIO(), os.getcwd()
    try:
        with (
            contextlib.redirect_stdout(quiet),
            contextlib.redirect_stderr(quiet),
            tempfile.TemporaryDirectory() as folder,
        ):
            os.chdir(folder)
            student = Direct(text)
            for _, _, check in task.checks:
                check(student)
        return student.changed
    except (Exception, Slow, SystemExit) as error:
        return str(error) or repr(error)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        os.chdir(before)
