"""Draw a task's answers: those of a submission over those of our solution."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import closing
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Check, Exercise, Task, cannot_be_graded
from botschool.grading.declare.picture import Picture
from botschool.grading.declare.same import Same
from botschool.grading.judge.submission import Submission, opened
from botschool.grading.report.calls import Call, calls_of
from botschool.grading.report.drawing import Panel, draw, numbers, panels_of
from botschool.grading.run.confined import fork_server
from botschool.grading.run.failures import NotDone
from botschool.grading.run.student import Student
from botschool.output import save_bytes

RIGHT, WRONG, OPEN = "right", "wrong", "not done yet"
PANELS = 6
"""Most panels of a picture."""
UNSEEN = "The picture does not show what is wrong: botschool explain {} lists all calls."


@dataclass
class Drawn:
    """What a task's picture shows."""

    task: Task
    state: str
    """RIGHT, WRONG or OPEN."""
    message: str = ""
    panels: list[Panel] = field(default_factory=list)

    def save(self, folder: Path) -> Path:
        """Write the picture and return its path. Raises BotschoolError."""
        content, place = BytesIO(), folder / f"task_{self.task.id.replace('.', '_')}.png"
        title = f"{self.task.id} {self.task.title}: {self.state}"
        draw(title, self.panels).savefig(content, dpi=100, format="png")
        folder.mkdir(parents=True, exist_ok=True)
        save_bytes(place, content.getvalue())
        return place


def checkpoints(exercise: Exercise, tasks: list[Task], file: Path) -> Iterator[Drawn]:
    """Yield what can be drawn of each task that has a picture.

    The submission's functions run confined, as for grading. Raises BotschoolError.
    """
    with fork_server(exercise.imports) as server, opened(exercise, file, server) as submission:
        for task in tasks:
            if task.picture and not cannot_be_graded(task):
                yield _drawn(task, task.picture, submission)


def _drawn(task: Task, picture: Picture, submission: Submission) -> Drawn:
    try:
        with closing(submission.begun(task)) as student:
            checks = [check for _, _, check in task.checks]
            same = [check for check in checks if isinstance(check, Same)]
            calls = [call for check in same for call in calls_of(check, student, _inputs(check))]
            wrong = [call for call in calls if not call.right]
            failed = student.changed or ("" if wrong else _failed(checks, student))
            right = not wrong and not failed
            message = failed or next((call.message for call in wrong if call.message), "")
            panels: list[Panel] = []
            if picture.call:
                call = picture.call
                what, *given = call(task.exercise.grader) if callable(call) else call
                own = Same(task, what, lambda rng: [tuple(given)], 1e-9, (), None, {})
                own.__name__ = ""
                panels = _panels(next(calls_of(own, student, own.inputs())), picture, right)
            elif not wrong:
                panels = _of_checks(calls, picture, right)
            for how in (picture, Picture(picture.says)):
                if wrong and not (picture.call and how.of) and not _shows(panels):
                    panels = _of_checks(wrong, how, False) or panels
            if not right and not _shows(panels):
                message = f"{message} {UNSEEN.format(task.id)}".strip()
            return Drawn(task, RIGHT if right else WRONG, message, panels[:PANELS])
    except NotDone as error:
        return Drawn(task, OPEN, str(error))
    except Wrong as error:
        return Drawn(task, WRONG, str(error))


def _inputs(check: Same) -> list[tuple]:
    """Return a check's inputs, the largest one last."""
    return [*(each for _, each in check.more()), *check.inputs()]


def _failed(checks: list[Check], student: Student) -> str:
    """Return why the first check fails that compares nothing, such as one of a training."""
    for check in checks:
        if not isinstance(check, Same):
            try:
                check(student)
            except NotDone:
                raise
            except Wrong as error:
                return str(error)
    return ""


def _of_checks(calls: list[Call], picture: Picture, right: bool) -> list[Panel]:
    """Return panels of the largest call of each check; of right ones, of each function once."""
    groups: dict[Any, list[Call]] = {}
    for call in calls:
        groups.setdefault(call.check.what if right else call.check, []).append(call)
    return [panel for group in groups.values() for panel in _of_one(group, picture, right)]


def _of_one(group: list[Call], picture: Picture, right: bool) -> list[Panel]:
    pairs = [(_one(call.got, call), _one(call.wanted, call)) for call in group]
    single = [(a, b) for a, b in pairs if a is not None and b is not None and a.ndim == b.ndim == 0]
    if len(single) > 1 and len(single) == len(pairs) and not picture.of:
        yours, expected = (np.array(column) for column in zip(*single, strict=True))
        return [Panel(_name(group[0]), yours, expected, Picture("", kind="against"))]
    return next(filter(None, (_panels(call, picture, right) for call in reversed(group))), [])


def _one(answer: Any, call: Call) -> np.ndarray | None:
    """Return an answer, or its part if the check compares only one, as an array."""
    parts = call.check.parts
    return numbers(answer.get(parts[0]) if isinstance(answer, dict) and len(parts) == 1 else answer)


def _panels(call: Call, picture: Picture, right: bool) -> list[Panel]:
    """Return the panels of a call; of a wrong one, those that differ."""
    try:
        wanted = _shown(call.wanted, call, picture)
    except (LookupError, TypeError, ValueError):  # the picture is of another function
        return []
    try:
        got = _shown(call.got, call, picture)
    except Exception:  # an answer of another form
        got = None
    parts = () if picture.of else call.check.parts
    panels = panels_of(_name(call), got, wanted, picture, right, parts)
    return [panel for panel in panels if panel.apart] or panels


def _shows(panels: list[Panel]) -> bool:
    """Return whether a difference is seen."""
    return any(panel.apart for panel in panels)


def _shown(answer: Any, call: Call, picture: Picture) -> Any:
    if picture.of is not None:
        return picture.of(answer, *call.arguments)
    return answer if call.check.view is None else call.check.view(answer, *call.arguments)


def _name(call: Call) -> str:
    what = call.check.what
    return what if isinstance(what, str) else call.check.__name__.replace("_", " ")
