"""What depends on the secret from which the grading seeds follow: `make check-course SECRETS=5`.

Each wrong solution is graded under so many secrets in the tasks that it names, each alternative in
the tasks whose functions it writes anew and in those that need them, and both in another quick one.
"""

import ast
import hashlib

import pytest

import building
from botschool.grading.declare.state import VARIABLE

pytestmark = pytest.mark.course

QUICK = 20
"""Seconds that a task may have, at most, to be the other one."""
CASES = [*building.wrong(), *building.right()]


def sample(case, tasks):
    """One of the tasks, the same each time."""
    digest = hashlib.sha256(str(case).encode()).digest()
    return {tasks[digest[0] % len(tasks)]} if tasks else set()


def written_anew(case):
    """The tasks whose functions differ from the solution's."""
    parts = []
    for text in (building.source(case.number).solution, case.submission):
        nodes = ast.parse(text).body
        named = [node for node in nodes if isinstance(node, (ast.FunctionDef, ast.ClassDef))]
        parts.append({node.name: ast.dump(node) for node in named})
    functions = building.source(case.number).functions
    return {
        task
        for task, names in functions.items()
        if any(parts[0].get(name) != parts[1].get(name) for name in names)
    }


def tasks_of(case, exercise):
    """The tasks in which a case is graded, in their order."""
    chosen = set(case.loses)
    if not chosen:
        chosen = written_anew(case)
        chosen |= {
            task.id
            for task in exercise.tasks
            if chosen & {each.id for each in exercise.needed(task)}
        }
    others = [each.id for each in exercise.tasks if each.id not in chosen and each.seconds <= QUICK]
    chosen |= sample(case, others)
    return [task for task in exercise.tasks if task.id in chosen]


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_verdict_is_the_same_under_all_secrets(grade, secrets, monkeypatch, case, tmp_path):
    file = building.write(tmp_path, case.number, case.submission)
    astray = []
    for secret in secrets:
        monkeypatch.setenv(VARIABLE, secret)  # before the grader is loaded: it may draw at once
        exercise = building.exercise(case.number)
        for task in grade(exercise, file, tasks=tasks_of(case, exercise)).tasks:
            if (task.points < task.max_points) != (task.id in case.loses):
                got = f"{task.points} of {task.max_points} points"
                astray.append(f"secret {secret!r}: task {task.id} gets {got}. {task.message}")
    assert not astray, "\n".join([f"{case}: {len(astray)} of {len(secrets)} secrets", *astray])
