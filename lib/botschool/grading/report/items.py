"""Let pytest collect the tasks and checks of an exercise as items: `pytest exercises/ex03_...`.

exercises/conftest.py imports the hook. A task is graded once, confined as ever, for all its items.
"""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from botschool.grading.declare.exercise import Exercise, load_exercise, submission_file
from botschool.grading.declare.exercise import Task as Declared
from botschool.grading.judge.points import TaskResult
from botschool.grading.judge.submission import grade

_FOLDER = re.compile(r"ex(\d\d)_\w+")


class Failed(Exception):
    """A check fails; the message is the sentence that the learner reads."""


def pytest_pycollect_makemodule(module_path: Path, parent: Any) -> pytest.Collector | None:
    """Return the collector of a grader's file, and None for other files."""
    folder = module_path.parent
    if not _FOLDER.fullmatch(folder.name) or folder.parent.name != "exercises":
        return None
    return Grader.from_parent(parent, path=module_path)


class Grader(pytest.File):
    """A grader's file: its tasks."""

    def collect(self) -> Iterator[pytest.Collector]:
        """Yield a collector for each task."""
        number = int(self.path.parent.name[2:4])
        exercise = load_exercise(number, self.path.parents[2])
        file = submission_file(number, os.environ.get("SUBMISSION") or None, self.path.parents[2])
        for task in exercise.tasks:
            name = f"{task.id} {task.title}"
            yield Task.from_parent(self, name=name, exercise=exercise, task=task, file=file)


class Task(pytest.Collector):
    """A task: its checks."""

    def __init__(self, exercise: Exercise, task: Declared, file: Path, **more: Any) -> None:
        super().__init__(**more)
        self._exercise, self._task, self._file = exercise, task, file
        self._result: TaskResult | None = None

    def collect(self) -> Iterator[pytest.Item]:
        """Yield an item for each check."""
        for points, name, _ in self._task.checks:
            yield Check.from_parent(self, name=f"{name} ({points} points)")

    @property
    def result(self) -> TaskResult:
        """Return the result; the task is graded when it is asked for the first time."""
        if self._result is None:
            self._result = grade(self._exercise, self._file, tasks=[self._task]).tasks[0]
        return self._result


class Check(pytest.Item):
    """A check."""

    def runtest(self) -> None:
        """Raise Failed, or skip what this machine cannot grade."""
        result: TaskResult = self.parent.result  # type: ignore[attr-defined]
        if not result.graded:
            pytest.skip(result.message)
        name = self.name.partition(" ")[0]
        if result.points < result.max_points and result.checks.get(name, result.message):
            first = next((each for each, why in result.checks.items() if why), name)
            raise Failed(result.message if name == first else result.checks[name])

    def repr_failure(self, excinfo: Any, style: Any = None) -> Any:
        """Return the sentence alone."""
        own = isinstance(excinfo.value, Failed)
        return str(excinfo.value) if own else super().repr_failure(excinfo)

    def reportinfo(self) -> tuple[Path, int | None, str]:
        """Return where the item is, and its name."""
        return self.path, None, f"{self.parent.name}: {self.name}"  # type: ignore[union-attr]
