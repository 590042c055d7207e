"""Graders that declare inputs: answers are compared with our solution's, and what all must keep."""

import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.grading import Exercise, expect, same
from botschool.grading.commands import explain_command
from botschool.grading.judge.submission import grade

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
SOLUTION = '''"""A solution."""
import json
import numpy as np


def mixed(centre, samples, factor, many):
    """mixed([1.0], [[2.0]], 0.5, 3) returns a table."""
    ### BEGIN SOLUTION task 4.1: mix
    return many * np.asarray(centre) + factor * np.asarray(samples)
    ### END SOLUTION


def logs(values):
    """The logarithms; of 0 it is minus infinity, of less NaN."""
    ### BEGIN SOLUTION task 4.2: take logarithms
    with np.errstate(all="ignore"):
        return np.log(values)
    ### END SOLUTION


def load(path):
    """What a file holds."""
    ### BEGIN SOLUTION task 4.3: read a file
    with open(path) as file:
        return json.load(file)
    ### END SOLUTION


def noise(n, seed):
    """Random numbers, however drawn."""
    ### BEGIN SOLUTION task 4.4: draw
    return 0.5 * np.random.default_rng(seed).normal(size=n)
    ### END SOLUTION


def judged(value):
    """A number and a word."""
    ### BEGIN SOLUTION task 4.5: judge
    return {"value": 2 * value, "word": "high" if value > 0.5 else "low"}
    ### END SOLUTION
'''
MISTAKES = """%% root_of_the_deviation loses 4.4
Takes 0.5 for the variance instead of the standard deviation.
def noise(n, seed):
    return np.random.default_rng(seed).normal(size=n) * 0.5**0.5


%% factor_left_out loses 4.1
Leaves out the factor.
-     return many * np.asarray(centre) + factor * np.asarray(samples)
+     return many * np.asarray(centre) + np.asarray(samples)
"""


def written(module, content):
    """load(path) of a file with {0}"""
    import json

    with open("written.json", "w") as file:
        json.dump(content, file)
    return module.load("written.json")


def spread(answer, n, seed):
    expect(len(answer) == n, f"there are {len(answer)} numbers")
    return {"the deviation": float(np.std(answer))}


@pytest.fixture
def exercise():
    made = Exercise(4, "Tiny", file="tiny.py")

    @same(made.task("4.1", "Mixing"), 40, "mixed")
    def mixes(rng):
        for rows, columns in ((2, 3), (5, 4)):
            yield rng.normal(size=columns), rng.normal(size=(rows, columns)), rng.uniform(), 3

    @same(made.task("4.2", "Logarithms"), 20, "logs")
    def takes_logs(rng):
        yield np.array([1.0, 0.0, -1.0, 2.0])
        yield rng.uniform(size=5)

    @same(made.task("4.3", "Reading"), 20, written)
    def reads(rng):
        yield {"a": float(rng.uniform())}

    @same(made.task("4.4", "Drawing"), 10, "noise", 0.05, view=spread)
    def draws(rng):
        yield 5000, int(rng.integers(1000))
        yield 9000, int(rng.integers(1000))

    @same(made.task("4.5", "Judging"), 10, "judged", parts=("value", "word"))
    def judges(rng):
        yield from (0.2, 0.5, float(rng.uniform(0.6, 1)))

    made.knows(SOLUTION, MISTAKES)
    return made


@pytest.fixture
def graded(exercise, tmp_path, server):
    """Points and messages of our solution with other functions at its end."""

    def call(code):
        file = tmp_path / "tiny.py"
        file.write_text(SOLUTION + "\n\n" + code)
        result = grade(exercise, file, server=server)
        return {t.id: t.points == t.max_points for t in result.tasks}, {
            t.id: t.message for t in result.tasks
        }

    return call


RIGHT = {
    "the solution": "",
    "loops": """
def mixed(centre, samples, factor, many):
    return [[many * c + factor * s for c, s in zip(centre, row)] for row in samples]

def logs(values):
    import math
    return [math.log(v) if v > 0 else -math.inf if v == 0 else math.nan for v in values]

def noise(n, seed):
    import random
    draw = random.Random(seed)
    return [draw.gauss(0, 0.5) for _ in range(n)]

def judged(value):
    return {"word": ("low", "high")[value > 0.5], "value": value + value, "more": 1}
""",
    "a cache of all arguments": """
import functools

@functools.cache
def kept(*args):
    return many_of(*[np.frombuffer(a).reshape(s) if s else a for a, s in args])

def many_of(centre, samples, factor, many):
    return many * centre + factor * samples

def mixed(centre, samples, factor, many):
    arrays = [np.asarray(a, dtype=float) for a in (centre, samples)]
    return kept(*[(a.tobytes(), a.shape) for a in arrays], (factor, ()), (many, ()))
""",
}


@pytest.mark.parametrize("code", RIGHT.values(), ids=RIGHT)
def test_right_answers_in_any_style_pass(graded, code):
    passed, messages = graded(code)
    assert all(passed.values()), messages


KEPT = """
_kept = {{}}
_ours = {name}

def {name}(*a):
    key = {key}
    if key not in _kept:
        _kept[key] = _ours(*a)
    return _kept[key]
"""
ONCE = """
_ours, _calls = mixed, []

def mixed(centre, samples, factor, many):
    {}
    return _ours(centre, samples, factor, many)
"""
WRONG = {
    "cache by size": KEPT.format(name="mixed", key="a[1].shape"),
    "cache by size and a number": KEPT.format(name="mixed", key="(a[1].shape, a[2])"),
    "cache without the first": KEPT.format(
        name="mixed", key="(np.asarray(a[1]).tobytes(), a[2], a[3])"
    ),
    "cache without the second": KEPT.format(
        name="mixed", key="(np.asarray(a[0]).tobytes(), a[2], a[3])"
    ),
    "cache without the third": KEPT.format(
        name="mixed", key="(np.asarray(a[0]).tobytes(), np.asarray(a[1]).tobytes(), a[3])"
    ),
    "cache without the last": KEPT.format(
        name="mixed", key="(np.asarray(a[0]).tobytes(), np.asarray(a[1]).tobytes(), a[2])"
    ),
    "cache by path": KEPT.format(name="load", key="a"),
    "transposed if square": ONCE.format(
        "samples = samples.T if np.shape(samples)[0] == np.shape(samples)[1] else samples"
    ),
    "squeezed": ONCE.format("return np.squeeze(_ours(centre, samples, factor, many))"),
    "double precision only": ONCE.format(
        "samples = np.frombuffer(np.asarray(samples).tobytes()).reshape(-1, len(centre))"
    ),
    "arrays only": ONCE.format("samples = samples.reshape(-1, len(centre))"),
    "changes the centre": ONCE.format("centre += 1 if len(centre) else 0; centre -= 1"),
    "wrong after three calls": ONCE.format("_calls.append(1); factor += len(_calls) > 3"),
    "one array for all answers": """
_ours, _made = mixed, {}

def mixed(centre, samples, factor, many):
    answer = _ours(centre, samples, factor, many)
    _made.setdefault(answer.shape, answer)[...] = answer
    return _made[answer.shape]
""",
    "wrong in a second process": ONCE.format("""import os
    if not _calls and os.path.exists("mark"):
        factor += 1
    _calls.append(open("mark", "w").close())"""),
    "NaN for infinity": "def logs(v):\n    return np.where(np.isinf(np.log(v)), np.nan, np.log(v))",
    "a number for infinity": "def logs(v):\n    return np.maximum(np.log(v), -1e300)",
    "0 for NaN": "def logs(values):\n    return np.nan_to_num(np.log(values), neginf=-np.inf)",
    "another word": "def judged(value):\n    return {'value': 2 * value, 'word': 'medium'}",
    "no dict": "def judged(value):\n    return [2 * value, 'low']",
    "no numbers": "def noise(n, seed):\n    return None",
}


@pytest.mark.parametrize("name", WRONG)
def test_what_every_function_must_keep_is_tried(graded, name):
    passed, messages = graded(WRONG[name])
    lost = [task for task, whole in passed.items() if not whole]
    assert len(lost) == 1, messages
    assert len(messages[lost[0]].split()) < 80


def test_a_mistake_is_named_also_where_chance_decides(graded):
    _, messages = graded("def noise(n, seed):\n    return np.random.normal(0, 0.7071, n)")
    assert messages["4.4"].startswith("Your code takes 0.5 for the variance")
    _, messages = graded(ONCE.format("factor = 1"))
    assert messages["4.1"].startswith("Your code leaves out the factor.\nmixed(np.array(")


@pytest.mark.parametrize(
    "name, key", [("mixed", "0"), ("mixed", "a[3]"), ("logs", "np.ndim(a[0])")]
)
def test_an_answer_that_stays_is_named(graded, name, key):
    """Already the second input shows it."""
    _, messages = graded(KEPT.format(name=name, key=key))
    (message,) = filter(None, messages.values())
    assert message.startswith("The same call in a new process gives the right answer")
    assert len(message.split()) < 80


def test_the_smallest_call_is_shown(graded):
    _, messages = graded("def judged(value):\n    return {'value': value, 'word': 'low'}")
    assert "judged(0.2): value is 0.2, but 0.4 was expected." in messages["4.5"].splitlines()


def test_a_reason_switches_a_try_off(tmp_path, server):
    made = Exercise(4, "Tiny", file="tiny.py")
    off = {"one": "there are at least two rows", "square": "no reason"}

    @same(made.task("4.1", "Mixing"), 100, "mixed", off=off)
    def mixes(rng):
        yield rng.normal(size=3), rng.normal(size=(2, 3)), 0.5, 3

    made.knows(SOLUTION)
    file = tmp_path / "tiny.py"
    file.write_text(SOLUTION + WRONG["transposed if square"])
    assert grade(made, file, server=server).points == 100
    with pytest.raises(ValueError, match="off names"):
        same(made.task("4.2", "More"), 1, "mixed", off={"squares": "unknown"})(lambda rng: [])


def test_after_a_time_out_a_function_is_not_called_again(graded):
    start = time.process_time()
    passed, messages = graded("def mixed(*a):\n    while True: pass")
    assert not passed["4.1"] and sum(passed.values()) == 4
    assert re.search(r"did not return within \d+ seconds\.", messages["4.1"])
    assert time.process_time() - start < 15


def test_of_two_mistakes_one_is_named(tmp_path, server):
    """The first check's wrong answers are those of one mistake; the other check has another."""
    made = Exercise(4, "Tiny", file="tiny.py")
    task = made.task("4.1", "Mixing")

    @same(task, 50, "mixed")
    def mixes(rng):
        for rows in (2, 3):
            yield rng.normal(size=4), rng.normal(size=(rows, 4)), 0.5, 3

    @same(task, 50, "judged")
    def judges(rng):
        yield from (0.2, 0.7, 0.9)

    made.knows(SOLUTION, MISTAKES)
    file = tmp_path / "tiny.py"
    other = "def judged(value):\n    return {'value': 3 * value - 0.1, 'word': 'none'}"
    file.write_text(SOLUTION + ONCE.format("factor = 1") + other)
    assert (
        grade(made, file, server=server)
        .tasks[0]
        .message.startswith("Your code leaves out the factor.")
    )


GRADER = """
import numpy as np
from botschool.grading import Exercise, same

exercise = Exercise(4, "Tiny", file="tiny.py")


@same(exercise.task("4.1", "Mixing"), 60, "mixed")
def mixes(rng):
    yield rng.normal(size=3), rng.normal(size=(2, 3)), 0.5, 3


@same(exercise.task("4.5", "Judging"), 40, "judged")
def judges(rng):
    yield from (0.2, 0.5, 0.7)
"""


@pytest.fixture
def course(tmp_path, monkeypatch):
    """A course of one exercise whose student leaves out the factor."""
    for folder, name, text in (
        ("exercises/ex04_tiny", "tiny.py", SOLUTION + ONCE.format("factor = 1")),
        ("exercises/ex04_tiny", "test_tiny.py", GRADER),
        ("exercises", "conftest.py", (ROOT / "exercises" / "conftest.py").read_text()),
        ("solutions/ex04_tiny", "tiny.py", SOLUTION),
    ):
        (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        (tmp_path / folder / name).write_text(text)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_explain_shows_all_calls_with_both_answers(course, capsys):
    explain_command("4.1", None)
    shown = capsys.readouterr().out
    assert "Task 4.1. Mixing" in shown and "✗ mixed(np.array(" in shown
    assert "returned  an array of shape (2, 3) (float64)" in shown and "expected  an array" in shown
    explain_command("4.5", None)
    assert "✗" not in capsys.readouterr().out
    with pytest.raises(BotschoolError, match="Name a task"):
        explain_command("4", None)
    undone = ONCE.format("raise NotImplementedError('task 4.1: mix')")
    (course / "exercises" / "ex04_tiny" / "tiny.py").write_text(SOLUTION + undone)
    explain_command("4.1", None)
    assert capsys.readouterr().out.count("not done yet") == 1


def test_pytest_collects_tasks_and_checks(course):
    command = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider", "-v", "exercises"]
    ran = subprocess.run(command, capture_output=True, text=True).stdout
    assert "4.5 Judging::judges (40 points) PASSED" in ran, ran
    assert "4.1 Mixing::mixes (60 points) FAILED" in ran
    assert "1 failed, 1 passed" in ran and "Traceback" not in ran
    ran = subprocess.run([*command, "-k", "4.5"], capture_output=True, text=True).stdout
    assert "1 passed, 1 deselected" in ran


PAID = '''"""A solution."""


def paid(robot, ways, effort):
    """The pay of a robot; effort counts only beside several ways."""
    ### BEGIN SOLUTION task 4.1: pay
    return {"ant": 2.0, "hopper": 1.0}[robot] * sum(ways) - effort * (len(ways) > 1)
    ### END SOLUTION
'''
FORGETFUL = """
_ours, _made = paid, {{}}


def paid(robot, ways, effort):
    ways = tuple(ways)
    return _made.setdefault({}, _ours(robot, ways, effort))
"""


@pytest.mark.parametrize(
    ("key", "points"),
    [("(robot, ways, effort)", 100), ("(ways, effort)", 0), ("(robot, ways)", 0)],
)
def test_a_cache_is_seen_where_an_argument_is_felt(tmp_path, server, key, points):
    """Both draws have the same texts, and the effort counts in none of the first inputs."""
    made = Exercise(4, "Tiny", file="tiny.py")

    @same(made.task("4.1", "Pay"), 100, "paid")
    def pays(rng):
        for many in (1, 1, 4):
            for robot in ("ant", "hopper"):
                yield robot, rng.uniform(size=many).tolist(), rng.uniform()

    made.knows(PAID)
    file = tmp_path / "tiny.py"
    file.write_text(PAID + FORGETFUL.format(key))
    assert grade(made, file, server=server).points == points
