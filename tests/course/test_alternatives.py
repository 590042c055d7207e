"""Prove that right answers in other styles than the solution's get all points.

building.py describes the files of alternatives. `-k ex03` runs those of exercise 3.
"""

import ast

import pytest

import building

pytestmark = pytest.mark.course

ALTERNATIVES = building.cases("alternatives")


def redefined(text):
    """The functions and classes that a text defines."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name for node in ast.parse(text).body if isinstance(node, kinds)}


@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_three_that_write_everything_anew(number):
    codes = [case.code for case in ALTERNATIVES if case.number == number]
    assert len(set(codes)) >= 3
    anew = set().union(*map(redefined, codes))
    for task, names in building.source(number).functions.items():
        assert anew & set(names), f"no alternative writes {' or '.join(names)} of task {task}"


@pytest.mark.parametrize("alternative", ALTERNATIVES, ids=str)
def test_alternative_gets_everything(grade, alternative, tmp_path):
    file = building.write(tmp_path, alternative.number, alternative.submission)
    result = grade(building.exercise(alternative.number), file)
    assert result.points == 100, [(task.id, task.message) for task in result.tasks if task.message]
    assert not any(task.message for task in result.tasks)
