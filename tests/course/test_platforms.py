"""Platforms that grade by themselves give each exercise the points that `grade` gives."""

from datetime import datetime, timezone

import pytest

import building
from botschool.grading.classes.platforms import classroom50, graded, gradescope
from test_nbgrader import every_second, partly

pytestmark = pytest.mark.course
HOSTILE = "import os\n\n\ndef {name}(*arguments, **options):\n    os._exit(0)\n"
RUNNER = dict.fromkeys(
    ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL", "OWNER"), "x"
)


def text_of(kind: str, source: building.Source) -> str:
    name = next(name for names in source.functions.values() for name in names)
    return {
        "skeleton": source.skeleton,
        "solution": source.solution,
        "half": partly(source.solution, every_second),
        "hostile": HOSTILE.format(name=name),
    }[kind]


@pytest.mark.parametrize("kind", ["skeleton", "solution", "half", "hostile"])
@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_points_are_those_of_grade(grade, tmp_path, monkeypatch, number, kind):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(building.ROOT))
    file = building.write(tmp_path, number, text_of(kind, building.source(number)))
    expected = {task.id: task.points for task in grade(building.exercise(number), file).tasks}
    result = graded(number, file.parent)
    tests = gradescope(result, 1.0)["tests"]
    assert {test["number"]: test["score"] for test in tests} == expected
    found = classroom50(result, RUNNER, datetime.now(timezone.utc))
    assert {t["test-name"].split()[0]: t["score"] for t in found["tests"]} == expected
    assert found["score"] == sum(expected.values())
