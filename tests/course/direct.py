"""Judge texts of our own, slips and cases, in this process: a tenth of the time of grading."""

import contextlib
import io
import os
import signal
import tempfile
from pathlib import Path

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.references import functions_of, pruned
from botschool.grading.run.direct import Direct
from botschool.grading.run.ours import Answer
from botschool.sandbox.protocol import pack

SECONDS = 3
"""Processor seconds for all checks of a task; a slip that takes longer is caught."""
SHORT = 0.02
"""Seconds that each answer of our solution is said to take."""


class Slow(BaseException):
    """A slip loops without end."""


@contextlib.contextmanager
def direct(text, name="student.py", references=None):
    """Give a text as a submission in this process."""
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / name
        file.write_text(text, encoding="utf-8")
        with contextlib.closing(Direct(file, references)) as student:
            yield student


class DirectOurs:
    """Answers as run.ours.Ours does; keeps all answers. Enter it by `with`."""

    def __init__(self, solution):
        self.solution, self._kept, self._stack = solution, {}, contextlib.ExitStack()

    def __enter__(self):
        before = os.getcwd()
        self._student = self._stack.enter_context(direct(self.solution))
        self._folder = os.getcwd()
        os.chdir(before)
        return self

    def __exit__(self, *_):
        self._stack.close()

    def answer(self, what, arguments):
        key = pack([what if isinstance(what, str) else what.__name__, [*arguments]])
        if key not in self._kept:
            ask = self._student.run if callable(what) else self._student.call
            value, raised = None, ""
            before = os.getcwd()
            os.chdir(self._folder)
            try:
                value = ask(what, *arguments)
            except Wrong as error:
                raised = str(error)
            os.chdir(before)
            self._kept[key] = Answer({}, value, raised, SHORT)
        return self._kept[key]


def problem(task, text, seconds=SECONDS, references=None):
    """Why a text loses points of a task; "" if it does not. seconds: of the processor, at most."""

    def end(*_):
        raise Slow

    signal.signal(signal.SIGPROF, end)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    quiet = io.StringIO()
    try:
        with (
            contextlib.redirect_stdout(quiet),
            contextlib.redirect_stderr(quiet),
            direct(text, task.exercise.file, references) as student,
        ):
            for _, _, check in task.checks:
                check(student)
        return student.changed
    except (Exception, Slow, SystemExit) as error:
        return str(error) or repr(error)
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)


def lost(exercise, text, tasks, seconds=SECONDS):
    """Return task -> why it loses points, also with our functions of tasks that it builds on."""
    kept = {}

    def why(task):
        if task.id not in kept:
            kept[task.id] = problem(task, text, seconds)
            needed = exercise.needed(task)
            functions = functions_of(exercise.known.solution)
            broken = [each for each in needed if kept[task.id] and why(each)]
            names = [name for each in broken for name in functions.get(each.id, ())]
            if names:
                source = pruned(exercise.references, [each.id for each in needed])
                kept[task.id] = problem(task, text, seconds, {"source": source, "names": names})
        return kept[task.id]

    return {task.id: why(task) for task in tasks if why(task)}
