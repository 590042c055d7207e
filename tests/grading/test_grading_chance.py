"""Sentences on mistakes do not fit by chance, and quote only what a learner knows."""

import ast
import contextlib
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from botschool.grading import Exercise, Wrong, expect_close
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.judge.evidence import holds, quoted
from botschool.grading.judge.sentences import Quotes
from botschool.grading.judge.variations import variations
from tiny_course import FILE


@pytest.fixture
def message(messages):
    """The message on the only task of an exercise."""
    return lambda text, exercise: messages(text, exercise)[0]


ROOT = Path(__file__).parents[2]


def written(body):
    """A solution with a function of this body."""
    lines = "\n".join(f"    {line}" for line in body.splitlines())
    return (
        f"# It asks for `speed`, and for the angle after it; then `seen` and `done`.\n"
        f"def told(speed, angle):\n    ### BEGIN SOLUTION task 3.1: told\n{lines}\n"
        "    ### END SOLUTION\n"
    )


def slipped(body):
    """Sentences and texts of the slips in a function of this body."""
    return [(each.what, each.text) for each in variations(written(body), "3.1")]


RECORDED = """seen, done = [0.0], []
while len(done) < speed:
    done.append(angle * len(done))
    seen.append(float(len(seen)))
return {"seen": seen, "done": done}"""


def test_a_name_for_another_must_stand_there():
    """A loop that counted neither of two lists was told that one was taken for the other."""
    slip = next(each for each in variations(written(RECORDED), "3.1") if "`seen` is" in each.what)
    assert slip.shown == "len(seen)" and slip.shown in slip.text
    names = quoted(slip.what)
    assert names == {"seen", "done"}
    assert holds("def told(a, b):\n    return a if len(seen) > b else 0", slip.shown, names)
    assert not holds("for step in range(1, speed):\n    seen.append(1)", slip.shown, names)
    assert holds("high = [v for v in values if v < high]", "_ < high", {"high", "low"})


def test_signs_are_not_reversed_in_several_places():
    found = slipped("first = abs(speed)\nsecond = first * angle\nreturn [first, second]")
    assert [text for _, text in found if "-abs(speed)" in text]
    assert not [text for _, text in found if "-abs(speed)" in text and "-(first" in text]


def test_a_sum_for_a_product_is_told_by_its_place():
    assert any("`+` stands where `*`" in what for what, _ in slipped("return speed * angle"))
    hidden = slipped("hidden = speed - 1\nreturn hidden * hidden")
    assert not any("`+` stands where `*`" in what for what, _ in hidden)


def test_a_wrong_number_is_shown():
    assert "A number is half of what it should be: 0.85 is used." in dict(slipped("return 1.7"))


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "said"), [(1.0, False), (2.5, True)])
def test_a_limit_near_the_right_one_is_no_slip(message, factor, said):
    """Yes and no are the same for many limits; other answers are those of a single number."""
    ours = (
        "def told(x):\n    ### BEGIN SOLUTION task 3.1: told\n"
        "    return factor * 12 if factor * x > 12 else 0\n    ### END SOLUTION\n"
    ).replace("factor", str(factor))
    if factor == 1.0:
        ours = ours.replace("1.0 * 12 if 1.0 * x", "1 if x")
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def limits(student):
        for x in (5.5, 11.25, 11.5, 11.75, 11.8, 11.9, 20.0, 30.5, 41.0):
            wanted = (
                (1 if x > 12 else 0) if factor == 1 else (factor * 12 if factor * x > 12 else 0)
            )
            expect_close("told(...)", student.call("told", x), wanted)

    exercise.knows(ours)
    told = message(ours.replace("12", "11"), exercise)
    assert ("A number is one less" in told) == said


@pytest.mark.parametrize(
    ("part", "own", "other"),
    [
        ("speed", True, True),
        ("after", True, False),  # a word of the text, not a name
        ("speed + angle", True, True),
        ("3 * speed", True, False),
        ("2 + speed", True, False),
        ("2 * speed", True, True),
        ("hidden", False, False),
    ],
)
def test_other_styles_are_quoted_as_far_as_the_text_has_them(part, own, other):
    text = '# The 3 angles after `2 * speed`.\ndef told(speed, angle):\n    """Of after."""\n'
    node = ast.parse(part).body[0].value
    quoted = [bool(Quotes(text, style).quoted(node)) for style in (True, False)]
    assert quoted == [own, other]


@pytest.mark.parametrize(
    ("means", "told"),
    [
        ((0, 0), ""),
        ((-900, 0, 0), ""),
        ((0, -900, 0), ""),
        ((0, -900, -900), r"means are .0, -900, -900."),
        ((-900, -900), r"means are .-900, -900."),
    ],
)
def test_a_third_seed_decides_about_a_training_with_an_unlucky_one(monkeypatch, means, told):
    """In task 3.7."""
    load_exercise(3, ROOT)
    grader, trained = sys.modules["grader_3"], []

    class Robot:
        nbiases, nweights = 2, 3

        def __init__(self, environment):
            pass

        def evaluate(self, *_, **__):
            return np.array([means[len(trained) - 1]])

    class Student:
        def run(self, *_, said, robot):
            self.said = said
            trained.append(np.eye(5)[len(trained)])
            self.rewired = SimpleNamespace(nearest=lambda parameters: parameters)
            return trained[-1]

    monkeypatch.setattr("botschool.course.evaluation.Robot", Robot)
    with pytest.raises(Wrong, match=told) if told else contextlib.nullcontext():
        grader.expect_trained(Student(), "Pendulum-v1", 22, -600)
    assert len(trained) == len(means)
