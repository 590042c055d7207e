"""Right answers in other styles than the solution's get all points.

An alternative is a file in alternatives/exNN/: its first line says in words what is different, and
the rest redefines functions of the solution. `-k ex03` runs those of exercise 3.
"""

import ast
import re

import pytest

import building

pytestmark = pytest.mark.course

ALTERNATIVES = sorted((building.HERE / "alternatives").glob("ex[0-9][0-9]/*.py"))


def redefined(text):
    """The functions and classes that a text defines."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name for node in ast.parse(text).body if isinstance(node, kinds)}


@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_three_that_write_everything_anew(number):
    own = [path for path in ALTERNATIVES if path.parent.name == f"ex{number:02d}"]
    texts = [path.read_text(encoding="utf-8") for path in own]
    assert len(set(texts)) >= 3
    anew = set().union(*map(redefined, texts))
    for task, names in building.source(number).functions.items():
        assert anew & set(names), f"no alternative writes {' or '.join(names)} of task {task}"


@pytest.mark.parametrize(
    "alternative", ALTERNATIVES, ids=[f"{path.parent.name}-{path.stem}" for path in ALTERNATIVES]
)
def test_alternative_gets_everything(grade, alternative, tmp_path):
    number, text = int(alternative.parent.name[2:]), alternative.read_text(encoding="utf-8")
    assert re.match(r"# \w", text), "the first line says what is different"
    file = building.write(
        tmp_path, number, building.inserted(building.source(number).solution, text)
    )
    result = grade(building.exercise(number), file)
    assert result.points == 100, [(task.id, task.message) for task in result.tasks if task.message]
    assert not any(task.message for task in result.tasks)
