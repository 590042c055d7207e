"""What the grader says to learners: where their mistake is, and what it looks like."""

import re

import numpy as np
import pytest

from botschool.grading import (
    Exercise,
    Wrong,
    expect_array,
    expect_close,
    expect_fields,
)
from botschool.grading.declare.checks import Mismatch
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.trust import trust
from botschool.grading.declare.values import apart, pasted
from botschool.grading.judge.repeated import same
from botschool.grading.judge.submission import EVERYTHING, SYNTAX, grade
from tiny_course import FILE, SOLUTION, make_course, submit


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    root = make_course(tmp_path_factory.mktemp("course") / "course")
    trust(root)
    return root


@pytest.fixture
def graded(course, server, tmp_path, monkeypatch):
    """Grades a submission with this text in the tiny exercise, or another one."""
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(course))

    def grade_text(text, exercise=None):
        file = submit(tmp_path / str(len(list(tmp_path.iterdir()))), text)
        return grade(exercise or load_exercise(3, course), file, server=server)

    return grade_text


def asking(check, **options):
    """An exercise of one task with this check."""
    exercise = Exercise(3, "One", FILE)
    exercise.task("3.1", "One", **options).check(10)(check)
    return exercise


def said(graded, text, check, **options):
    return graded(text, asking(check, **options)).tasks[0].message


# --- the file


@pytest.mark.slow
def test_no_python_is_said_once_with_line_and_caret(graded):
    result = graded("import numpy as np\n\n\ndef double(x)\n    return 2 * x\n")
    assert result.banner == (
        "Your file is not Python yet. Mend this first:\n  tiny.py:4\n    def double(x)\n"
        "                 ^\n  SyntaxError: expected ':'"
    )
    assert [task.message for task in result.tasks] == [
        "Not graded: mend the file first, as said above."
    ] * 2
    assert result.to_json()["banner"] == result.banner


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ("import nunpy as np", "ModuleNotFoundError: No module named 'nunpy'. Did you mean numpy?"),
        ("from math import sqr", "Did you mean sqrt?"),
        ("valeu = 1\nprint(value)", "NameError: name 'value' is not defined"),
        ("class A:\nx = 1", "IndentationError: expected an indented block"),
        pytest.param(
            "import time\nwhile True: time.perf_counter()",
            "It was at tiny.py:2: while True",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_what_keeps_a_file_from_loading(graded, line, words, monkeypatch):
    monkeypatch.setattr("botschool.grading.run.loading.LOADING_SECONDS", 1)
    assert words in graded(line).banner


HEAD = "def double(numbers: np.ndarray) -> np.ndarray:"
LAST = "    return twice_as_large_as_before"
BROKEN = {
    "bracket": ("float(np", "float((np", [60, 0], "SyntaxError: .*never closed"),
    "colon": (HEAD, HEAD[:-1], [0, 40], ":6 is not Python .SyntaxError: expected ':'"),
    "text": (LAST, f"    x = '''one\n\n{LAST}", [0, 40], "unterminated triple-quoted"),
    "margin": (LAST, f"    x = (2\nof x\n{LAST}", [0, 40], ":11 is not Python"),
    "indentation": ("    return float", "  x = 1\n    return float", [60, 0], "IndentationError"),
    "loop": (LAST, f"    break\n{LAST}", [0, 40], "'break' outside loop"),
    "decorator": (HEAD, f"@staticmethod(\n{HEAD}", [60, 40], ""),
    "line between": ("def total", ">>> double(2)\ndef total", [60, 40], ""),
}


@pytest.mark.slow
@pytest.mark.parametrize("cells", [False, True])
@pytest.mark.parametrize(("right", "wrong", "points", "said"), BROKEN.values(), ids=BROKEN)
def test_a_syntax_error_costs_the_function_where_it_stands(
    graded, monkeypatch, right, wrong, points, said, cells
):
    assert right in SOLUTION
    text = SOLUTION.replace(right, wrong)
    result = graded(text.replace("def total", "# %%\ndef total") if cells else text)
    assert [task.points for task in result.tasks] == points
    assert result.banner.startswith("Your file is not Python yet. Mend this first:\n  tiny.py:")
    if said:
        message = result.tasks[points.index(0)].message
        assert re.search(f"cannot be read: tiny.py.*{said}.*: mend this line first", message)
    monkeypatch.setenv(SYNTAX, EVERYTHING)
    strict = graded(text)
    assert strict.points == 0 and "tiny.py:" in strict.banner


def test_beside_a_syntax_error_statements_of_several_lines_are_kept(graded):
    above = (
        "TABLE = [\n2,\n]\ntry:\n    import nothing\nexcept ImportError:\n    F = TABLE[0]\n\n\n"
    )
    above += "@(\nlambda function: function\n)\n"
    text = SOLUTION.replace("def double", above + "def double").replace(" 2 *", " F *")
    assert [task.points for task in graded(text + "\n\ndef broken(\n").tasks] == [60, 40]


# --- functions


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("def doubled(x): pass", "there is no function double in your file; there is doubled"),
        ("def Double(x): pass", "there is Double: give it the name double again"),
        ("def f(x):\n    def double(y): pass", "there is one at tiny.py:2, but it is indented"),
        ("", "there is no function double in your file: its name must be"),
        ("def double(): pass", "cannot be called like this: double() takes 0 positional"),
        ("def double(x, y): pass", "Yours is double(x, y): take the parameters"),
    ],
)
def test_functions_that_are_not_there_or_take_something_else(graded, text, words):
    message = graded(text + "\n").tasks[0].message
    assert words in message
    assert len(message.splitlines()) <= 2, "said once, though two checks fail"


def test_exceptions_come_with_the_own_line(graded):
    text = "import numpy as np\ndef double(x):\n    y = np.zeros(3)\n    return y.dott(x)\n"
    message = graded(text).tasks[0].message
    assert (
        "raised AttributeError: 'numpy.ndarray' object has no attribute 'dott'. Did you mean dot?"
        in message
    )
    assert "\n  tiny.py:4: return y.dott(x)" in message
    assert message.count("AttributeError") == 1, "said once, though two checks fail"


@pytest.mark.parametrize(
    ("body", "words"),
    [
        ("np.ones((2, 3)) @ np.ones((2, 3))", "print .shape of both"),
        ("np.ones(2) + np.ones(3)", "print .shape of both"),
        ("print() + 1", "Something is None"),
        ("[a for a, b, c, d in [range(5)]]", "print it"),
        ("[a for a, b in [range(5)] if env.step(0)]", "step returns"),
        ("[1, 2] * 0.5", "A list is not an array"),
        ("np.zeros(3 / 1)", "whole number"),
        ("np.array([[1], [1, 2]])", "the same length"),
    ],
)
def test_what_an_exception_mostly_means(graded, body, words):
    text = f"import numpy as np\ndef double(x): return {body}\n"
    message = said(graded, text, lambda student: student.call("double", 1))
    assert words in message.splitlines()[-1]


@pytest.mark.slow
@pytest.mark.parametrize(
    "body", ["while True: pass", "time.sleep(99)", "np.ones(9**8).sum() + g(x)"]
)
def test_where_an_endless_loop_was(graded, body):
    text = f"import time\nimport numpy as np\ndef g(x):\n    {body}\ndef double(x):\n    g(x)\n"
    message = said(graded, text, lambda student: student.call("double", 1), seconds=0.5)
    if "g(x)" in body:
        assert "RecursionError" in message or "It was at tiny.py:4" in message
    else:
        assert f"It was at tiny.py:4: {body}\n  called from tiny.py:6: g(x)" in message


def test_what_cannot_be_sent_is_explained(graded):
    for body, words in (("zip(x)", "list(...) makes a list"), ("print", "parentheses call it"),
                        ("...", "write your own code"), ("{1}", "no order")):  # fmt: skip
        text = f"def double(x): return {body}\n"
        assert words in said(graded, text, lambda student: student.call("double", [1]))


# --- comparisons


def wrong(value, wanted, **options):
    with pytest.raises(Wrong) as caught:
        expect_close("f(1)", value, wanted, **options)
    return str(caught.value)


@pytest.mark.parametrize(
    ("value", "wanted"),
    [(5.0, np.inf), (-1e300, -np.inf), (3.0, np.nan), ([1.0, 5.0], [1.0, np.inf]),
     ([5.0, 2.0], [np.inf, 1.0]), (np.float32([3.5, 9.5]), [np.inf, 24.6]),
     ([np.inf, 2.0], [np.inf, 1.0])],
)  # fmt: skip
def test_no_number_is_near_infinity_or_nan(value, wanted):
    assert "expected" in wrong(value, wanted)


def test_types_and_shapes_are_said():
    assert wrong([1, 2], np.zeros(3)) == (
        "f(1) returned a list of 2 numbers, but 3 numbers were expected."
    )
    assert "an array of shape (1, 3) (int64), but a" in wrong(np.ones((1, 3), int), np.zeros(3))
    assert "returned None, but a single number is needed: does it end without" in wrong(None, 3)
    assert "the text '3'" in wrong("3", 3) and "a dict with the keys ['a']" in wrong({"a": 1}, 3)
    assert (
        "list of 2 lists, the first of which is a list of 2 numbers (shape (2, 2)), but 2 numbers "
        "were" in wrong([[1, 2], [3, 4]], [1.0, 2.0])
    )
    assert "but 1 number was expected." in wrong([1, 2], [1.0])
    assert "a list of 8 numbers that starts [0, 1, 2, 3]...; at [7] it" in wrong(
        [*range(7), 8], range(8)
    )
    assert "a list of 2 texts, which is not an array" in wrong(["a", "b"], [1.0, 2.0])
    with pytest.raises(Wrong, match=r"NaN at \[1\] \(1 of 2 .*0 / 0"):
        expect_array("f(1)", [1.0, float("nan")], (2,))
    with pytest.raises(Wrong, match=r"infinity\. It may come from a division by 0"):
        expect_array("f(1)", float("inf"), ())
    with pytest.raises(Wrong, match=r"without 'best' \(it has 'Best': rename that\)"):
        expect_fields("f(1)", {"Best": 1}, "best")


def test_numbers_have_the_digits_in_which_they_differ():
    assert wrong(1 / 3, 1 / 3 + 1e-8) == "f(1) returned 0.33333333, but 0.33333334 was expected."
    assert wrong(0.5, 0.25) == "f(1) returned 0.5, but 0.25 was expected."
    assert "returned [1., 2.0000001], but [1, 2] was" in wrong([1, 2.0000001], [1.0, 2.0])
    assert "returned [1, 3], but [1, 2] was" in wrong([1.0, 3.0], [1.0, 2.0])
    assert wrong(False, True) == "f(1) returned False, but True was expected."
    many = np.arange(20.0)
    assert "at [7] it is 7.000001, but 7 was expected (1 of 20 numbers differ)" in wrong(
        many + 1e-6 * (many == 7), many
    )
    for one, other in ((1.0, 1.0 + 2**-52), (1e300, 1.1e300), (0.0, 1e-300)):
        first, second = apart(one, other)
        assert first != second and (float(first), float(second)) == (one, other)


def test_a_call_can_be_pasted():
    arguments = ([1.5, "a"], {"x": np.arange(3)}, np.array([[0.1, 2]], dtype=np.float32), None)
    text = pasted("f", arguments, {"seed": 3})
    taken = eval(text, {"np": np, "f": lambda *a, seed: (a, seed)})
    assert taken[1] == 3 and same(list(taken[0]), list(arguments))
    assert taken[0][2].dtype == np.float32
    assert pasted("f", (np.zeros(1000),), {}) == "" and pasted("f", ("x" * 500,), {}) == ""


def test_the_cause_stands_above_the_call(graded):
    message = graded("def double(x): return -2 * x\n").tasks[0].message
    cause, call = message.splitlines()
    assert cause == "Only the sign is wrong: it is reversed."
    assert call.startswith("double(")


def test_a_right_answer_may_not_change_what_it_is_given(graded):
    """Neither an array nor a list; a copy may be changed."""
    result = graded("def double(x):\n    x *= 2\n    return x\n").tasks[0]
    assert result.points == 0
    assert result.message.startswith("double([")
    assert "changed its argument number 1 in place" in result.message
    assert (
        not graded("def double(x):\n    x = x.copy()\n    x *= 2\n    return x\n").tasks[0].message
    )


# --- the two ends of an episode


def test_single_precision_is_accepted_where_numbers_are_fractions():
    wanted = np.array([0.1, -2.3, 1e-7])
    expect_close("f()", wanted.astype(np.float32), wanted)
    with pytest.raises(Mismatch):
        expect_close("f()", wanted * (1 + 5e-8), wanted)
    with pytest.raises(Mismatch):
        expect_close("f()", (wanted * 1.0001).astype(np.float32), wanted)
    with pytest.raises(Mismatch):
        expect_close("f()", [1_000_001, 3], [1_000_000, 3])
