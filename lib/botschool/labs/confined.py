"""Run a student's measure.py and figure.py in the sandbox; this process imports neither."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.libraries import Refused
from botschool.grading.run.student import Student
from botschool.grading.run.temporary import temporary_folder
from botschool.labs.sheet import made_by
from botschool.sandbox.scratch import MAX_PICTURE, MAX_PICTURE_SIDE

SECONDS = 30
"""Processor seconds for all calls of one file."""
PICTURE = "figure.png"
MAY_USE = frozenset({"botschool.labs.measuring"})
"""The module of botschool that a student's file may use: no others exist in its process."""


@contextmanager
def student_file(path: Path) -> Iterator[Student]:
    """Yield a file alone in a child process. Raises Wrong if there is no such file."""
    if path.is_symlink() or not path.is_file():
        raise Wrong(f"{path.name} is missing: {made_by(path)} makes it again.")
    with temporary_folder() as folder:
        copy = folder / "submitted" / path.name
        copy.parent.mkdir()
        shutil.copyfile(path, copy)
        student = Student(copy, seconds=SECONDS, refused=Refused(may_use=MAY_USE))
        try:
            yield student
        finally:
            student.close()


def measured(student: Student, run: dict[str, Any], names: tuple[str, ...]) -> dict[str, float]:
    """Return the numbers that measure(run) gives, one for each name. Raises Wrong."""
    answer = student.call("measure", run)
    if not isinstance(answer, dict):
        raise Wrong(f"measure(run) must return a dict, but returned {type(answer).__name__}.")
    values = {}
    for name in names:
        try:
            value = float(np.asarray(answer[name], dtype=float).reshape(()))
        except KeyError:
            raise Wrong(f"measure(run) returns no '{name}': add it to the dict.") from None
        except (TypeError, ValueError, OverflowError):
            raise Wrong(f"measure(run)['{name}'] is not one number.") from None
        if not np.isfinite(value):
            raise Wrong(f"measure(run)['{name}'] is {value}: it must be a finite number.")
        values[name] = value
    return values


def drawn_figure(student: Student, measurements: dict[str, Any]) -> dict[str, Any]:
    """Return what figure(measurements) shows: axes' names, points, lines, PNG. Raises Wrong."""
    found = student.run(_inspect, measurements, PICTURE, said="figure(measurements)")
    pictures = dict(student.pictures())
    if PICTURE not in pictures:
        raise Wrong(
            f"the picture has more than {MAX_PICTURE // 1000} kB, or more than {MAX_PICTURE_SIDE} "
            "pixels on a side: draw a smaller figure."
        )
    try:
        return {
            "labels": [(str(x), str(y)) for x, y in found["labels"]],
            "points": np.asarray(found["points"], dtype=float).reshape(-1, 2),
            "verticals": np.asarray(found["verticals"], dtype=float).ravel(),
            "png": pictures[PICTURE],
        }
    except Exception:  # the submission can forge what its child sends
        raise Wrong("figure(measurements) must return a matplotlib figure.") from None


def _inspect(student: Any, measurements: dict[str, Any], file: str) -> dict[str, Any]:
    """Runs in the child: draw the figure into a file, then read the points from its axes."""
    import matplotlib

    matplotlib.use("Agg")
    import numpy as np

    figure = student.figure(measurements)
    if not hasattr(figure, "axes") or not hasattr(figure, "savefig"):
        raise TypeError("figure(measurements) must return a matplotlib figure")
    labels, points, verticals = [], [], []
    for axes in figure.axes:
        labels.append([axes.get_xlabel(), axes.get_ylabel()])
        for line in axes.lines:
            marker, places = line.get_marker(), np.asarray(line.get_xydata(), float)
            if marker not in ("", " ", "none", "None", None):
                points.append(places)
            elif len(set(places[:, 0])) == 1 < len(places):
                verticals.append(float(places[0, 0]))
        points += [np.asarray(each.get_offsets(), float) for each in axes.collections]
    figure.savefig(file, format="png", dpi=100)
    return {
        "labels": labels,
        "points": np.concatenate(points) if points else np.zeros((0, 2)),
        "verticals": verticals,
    }
