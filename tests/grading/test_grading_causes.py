"""What is said of a wrong answer: a known mistake, what repeated calls show, a detector, a call."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from botschool.grading import Exercise, expect, expect_close, same
from botschool.grading.declare.alike import distance, fits, weight
from botschool.grading.declare.mistakes import read_cases
from botschool.grading.judge.repeated import KEPT
from botschool.grading.judge.sentence import TOLD, difference, line_about
from botschool.grading.packed import pack
from tiny_course import FILE

pytestmark = pytest.mark.slow

SOLUTION = '''"""A solution."""
import numpy as np


def spread(values):
    """The deviation."""
    ### BEGIN SOLUTION task 3.1: the spread of the values
    spread_marks_our_own_first = np.std(values, ddof=1)
    return float(spread_marks_our_own_first)
    ### END SOLUTION


def walk(step, many):
    """A loop."""
    ### BEGIN SOLUTION task 3.2: walk
    return [step(i) for i in range(many)]
    ### END SOLUTION


if __name__ == "__main__":
    print(spread([1, 2]))
'''
MISTAKES = '''"""Wrong solutions."""


%% by_n loses 3.1
Divides the sum by n instead of n - 1.
-     spread_marks_our_own_first = np.std(values, ddof=1)
+     spread_marks_our_own_first = np.std(values)


%% half_range loses 3.1
Gives half of the distance from the smallest to the largest value.
def spread(values):
    return float(np.ptp(values)) / 2


%% from_one loses 3.2
Counts the steps from 1.
def walk(step, many):
    return [step(i) for i in range(1, many + 1)]
'''
BY_N_LINE = line_about("Divides the sum by n instead of n - 1.")
RIGHT = "import numpy as np\ndef walk(step, many): return [step(i) for i in range(many)]\n"
BY_N = "def spread(x): return float((sum((np.array(x) - np.mean(x)) ** 2) / len(x)) ** 0.5)\n"
"""Another way to write the first mistake."""
INPUTS = ((1.0, 2.0, 4.0), (3.0, 9.0, 1.0, 2.0))
FIVE = (1.0, 2.0, 3.0, 4.0, 9.0)


def steps(module, many, factor):
    """A driver."""
    return module.walk(lambda i: factor * i, many)


def declared(inputs=INPUTS, mistakes=MISTAKES):
    exercise = Exercise(3, "Three", FILE)

    @exercise.task("3.1", "First", seconds=5).check(40)
    def spreads(student):
        for values in inputs:
            wanted = np.std(values, ddof=1)
            expect_close("spread(...)", student.call("spread", list(values)), wanted)

    @exercise.task("3.2", "Second", seconds=5).check(60)
    def walks(student):
        for many, factor in ((5, 1.5), (7, 2.5)):
            wanted = [factor * i for i in range(many)]
            expect(student.run(steps, many, factor) == wanted, f"walk(step, {many}): not the steps")

    exercise.knows(SOLUTION, mistakes)
    return exercise


@pytest.fixture
def first(messages):
    """The message on the first task."""
    return lambda text, exercise: messages(text, exercise)[0]


# --- known mistakes


def test_a_known_mistake_leads_the_message(messages):
    message, second = messages(RIGHT + BY_N, declared())
    lines = message.splitlines()
    assert lines[0] == BY_N_LINE
    assert lines[1].startswith("spread([1.0, 2.0, 4.0]) returned 1.24722, but 1.52753 was expected")
    assert second == ""


def test_so_does_one_that_a_driver_meets(messages):
    right = BY_N.replace("len(x)", "(len(x) - 1)")
    message, second = messages(
        RIGHT.replace("range(many)", "range(1, 1 + many)") + right, declared()
    )
    assert message == "" and second.startswith(line_about("Counts the steps from 1."))


@pytest.mark.parametrize(
    ("body", "inputs"),
    [
        ("float(np.std(x, ddof=1 if len(x) > 3 else 0))", INPUTS),
        ("float(np.std(x)) if len(x) < 4 else 0.0", INPUTS),
        ("float(np.std(x))", INPUTS[:1]),
        ("float(np.std(x))", INPUTS[:1] * 3),
    ],
    ids=["the other is right", "the other is wrong otherwise", "only one", "equal calls"],
)
def test_one_input_is_not_enough(first, body, inputs):
    assert TOLD not in first(f"{RIGHT}def spread(x): return {body}\n", declared(inputs))


@pytest.mark.parametrize(
    ("inputs", "named"),
    [((*INPUTS, FIVE), True), ((*INPUTS, (2.0,) * 5), False), ((INPUTS[1], FIVE), False)],
    ids=["wrong there, too", "right there", "a single answer proves nothing"],
)
def test_where_an_answer_raises_the_mistake_must_be_wrong(first, inputs, named):
    raising = "\n    if len(x) == 5: raise ValueError('five')\n    return float"
    text = RIGHT + BY_N.replace("return float", raising)
    assert first(text, declared(inputs)).startswith(TOLD) == named


@pytest.mark.parametrize("said", ["five", "six"])
def test_a_mistake_that_raises_the_same_is_proof(first, said):
    case = (
        "\n\n%% five loses 3.1\nTakes five values for too many.\ndef spread(values):\n"
        '    if len(values) == 5:\n        raise ValueError("five")\n'
        "    return float(np.std(values, ddof=int(len(values) > 3)))\n"
    )
    text = f"{RIGHT}def spread(x):\n    if len(x) > 4:\n        raise ValueError({said!r})\n"
    text += "    return float(np.std(x, ddof=0 if len(x) < 4 else 1))\n"
    message = first(text, declared((*INPUTS, FIVE), MISTAKES + case))
    assert (line_about("Takes five values for too many.") in message) == (said == "five")


def test_a_function_that_is_not_done_hides_no_mistake_of_another(first):
    exercise = declared()

    @exercise.tasks[0].check(1)
    def walks_too(student):
        expect(student.run(steps, 3, 1.5) == [0, 1.5, 3], "walk: not the steps")

    undone = "import numpy as np\ndef walk(step, many): raise NotImplementedError('task 3.2')\n"
    assert first(undone + BY_N, exercise).startswith(TOLD)


def test_of_two_mistakes_that_of_the_first_check_is_named(first):
    exercise = declared()

    @exercise.tasks[0].check(1)
    def of_five(student):
        expect_close("spread(...)", student.call("spread", [*FIVE]), np.std(FIVE, ddof=1))

    other = BY_N.replace("return ", "return 7.0 if len(x) == 5 else ")
    assert first(RIGHT + other, exercise).startswith(BY_N_LINE)


def test_a_mistake_that_never_ends_hides_no_other(first):
    endless = "\n\n%% endless loses 3.1\nNever ends.\ndef spread(values):\n    while True: pass\n"
    head, rest = MISTAKES.split("\n\n%% by_n", 1)
    text = f"{head}{endless}\n\n%% by_n{rest}"
    assert first(RIGHT + BY_N, declared(mistakes=text)).startswith(BY_N_LINE)


def test_a_mistake_that_fits_no_more_is_left_out(first):
    text = MISTAKES.replace("-     spread_marks", "-     another_marks", 1)
    with pytest.raises(ValueError, match="must hold these lines exactly once"):
        read_cases(3, text)[0].of(SOLUTION)
    assert TOLD not in first(RIGHT + BY_N, declared(mistakes=text))
    half = "def spread(x): return (max(x) - min(x)) / 2\n"
    assert "half of the distance" in first(RIGHT + half, declared(mistakes=text))


def saved(module, values):
    """A driver."""
    import os

    os.makedirs("saved", exist_ok=True)
    module.spread(values)
    return sorted(os.listdir("saved"))


def test_files_of_one_mistake_do_not_hide_another(first):
    ours = SOLUTION.replace(
        "    return float(", '    open("saved/sum", "w").close()\n    return float('
    )
    head = '-     open("saved/sum", "w").close()\n+     open('
    cases = "%% each loses 3.1\nWrites a file of its own for each value.\n"
    cases += f'{head}f"saved/sum{{values[0]}}", "w").close()\n'
    cases += "%% total loses 3.1\nGives it another name.\n"
    cases += f'{head}"saved/" + "total", "w").close()\n'
    exercise = Exercise(3, "Three", FILE)

    @exercise.task("3.1", "First", seconds=5).check(100)
    def saves(student):
        for values in ([1.5, 2.0], [2.5, 1.0], [0.5, 3.0], [4.0, 1.0]):
            expect(student.run(saved, values) == ["sum"], "save(...): not this file")

    exercise.knows(ours, cases)
    message = first(ours.replace("saved/sum", "saved/total"), exercise)
    assert message.startswith(line_about("Gives it another name."))


GRADER = '''"""A grader."""
import numpy as np
from botschool.grading import Exercise, expect_close
exercise = Exercise(3, "Three", "three.py")
first = exercise.task("3.1", "First")
@first.check(100)
def spreads(student):
    for values in ((1.0, 2.0, 4.0), (3.0, 9.0, 1.0, 2.0)):
        expect_close("spread(...)", student.call("spread", list(values)), np.std(values, ddof=1))
'''


def test_a_packed_grader_knows_them_and_shows_nothing(first, tmp_path):
    packed = pack(GRADER, SOLUTION, MISTAKES)
    for text in ("marks_our_own", "divided by n", "np.std", "ddof"):
        assert text not in packed
    names = {"__file__": str(tmp_path / "test_three.py")}
    exec(packed, names)
    assert first(RIGHT + BY_N, names["exercise"]).startswith(BY_N_LINE)


# --- a function that compares tables


TURNED = '''"""A solution."""
import numpy as np


def turned(table):
    """Rows and columns exchanged, and the largest number."""
    ### BEGIN SOLUTION task 3.1: turn the table
    return {"table": table.T, "largest": float(np.max(table))}
    ### END SOLUTION
'''
SQUARES = (
    "square = table.shape[0] == table.shape[1]\n    table = table if square else table.T\n    "
)
SQUARES += 'return {"table": table, "largest": table.max()}'
STAY = "%% stay loses 3.1\nLeaves square tables as they are.\ndef turned(table):\n    " + SQUARES


def tables(mistakes="", many=6, columns=()):
    exercise = Exercise(3, "Three", FILE)

    @same(exercise.task("3.1", "Turned", seconds=5), 100, "turned")
    def turns(rng):
        for rows in range(2, 2 + many):
            yield rng.normal(size=(rows, *columns))

    exercise.knows(TURNED, mistakes)
    return exercise


def turning(body):
    return f"import numpy as np\n\n\ndef turned(table):\n    {body}\n"


def test_a_mistake_that_shows_in_squares_only_is_named(first):
    message = first(turning(SQUARES), tables(STAY, many=2, columns=(7,)))
    assert message.startswith(line_about("Leaves square tables as they are."))


def test_no_cause_is_said_without_words(first):
    """Numbers that suggest nothing, in a part that has a name."""
    body = 'return {"table": np.cos(91 * table.T) ** 3, "largest": table.max()}'
    assert first(turning(body), tables()).startswith("turned(")


# --- repeated calls


def test_what_stays_is_told_before_what_numbers_suggest(first):
    """From the second call on, one is added."""
    body = "kept.append(1)\n    "
    body += 'return {"table": table.T + (len(kept) > 1), "largest": table.max()}\n\n\nkept = []'
    assert first(turning(body), tables()).startswith(KEPT)


def test_what_is_right_by_chance_has_not_stayed(first):
    chance = "import os, random\ndef spread(x):\n    right = float(np.std(x, ddof=1))\n"
    chance += "    if len(x) == 4 and os.path.exists('asked'): right += random.random()\n"
    chance += "    open('asked', 'w').close()\n    return right\n"
    message = first(RIGHT + chance, declared(mistakes=""))
    assert "spread(" in message and KEPT not in message


def test_what_two_calls_tell(first):
    def of(body):
        return first(f"{RIGHT}import random\ndef spread(x):\n    {body}\n", declared(mistakes=""))

    assert "gives another answer" in of("return random.random()")
    assert "It changes its argument number 1 in place" in of("x[0] += 1\n    return x[0] ** 3")
    steady = of("return x[0] ** 3")
    assert "in place" not in steady and "another answer" not in steady


# --- detectors and small calls


@pytest.mark.parametrize(
    ("inputs", "said"), [(INPUTS, True), (((1.0, 4.0),), False), (((1.0, 4.0),) * 2, False)]
)
def test_a_cause_is_guessed_from_two_calls(first, inputs, said):
    text = RIGHT + "def spread(x): return -float(np.std(x, ddof=1))\n"
    assert ("Only the sign" in first(text, declared(inputs, ""))) == said


def test_a_call_that_is_too_long_is_made_smaller(first):
    """To one row for which the answer differs from ours, with few digits."""
    costs = "import numpy as np\ndef cost(rate, table): return rate * np.abs(table).sum(axis=1)\n"
    exercise = Exercise(3, "Three", FILE)
    table = np.random.default_rng(1).uniform(0, 1, (30, 4))
    table[20, 2] = -0.51234567

    @exercise.task("3.1", "First", seconds=5).check(100)
    def is_the_sum(student):
        wanted = 2 * np.abs(table).sum(axis=1)
        expect_close("cost(2, table)", student.call("cost", 2, table), wanted)

    exercise.knows(costs)
    message = first(costs.replace("np.abs(table)", "table"), exercise)
    assert "cost(2, np.array([[" in message
    assert "-0.512" in message and "-0.5123" not in message
    assert message.count("expected") == 1


numbers = st.one_of(st.booleans(), st.integers(), st.floats(), st.text(max_size=3), st.none())
arrays = st.integers(0, 3).map(np.ones) | st.just(np.ones((2, 2))) | st.just(np.array("text"))
answers = st.recursive(
    numbers | arrays,
    lambda parts: st.lists(parts, max_size=3) | st.dictionaries(st.sampled_from("ab"), parts),
    max_leaves=6,
)


@settings(max_examples=60, deadline=None, derandomize=True)
@given(answers, answers)
def test_any_two_answers_can_be_told_apart(got, right):
    """Rows of dicts were taken for numbers, and the whole submission was not graded."""
    assert difference("f(1)", got, right).startswith("f(1)")


def test_answers_are_compared_part_by_part():
    one = {"a": [1.0, 2], "b": [np.eye(2), None, "x"]}
    assert distance(one, {"b": [[[1, 0], [0, 1]], None, "x"], "a": np.array([1.0, 2])}) == 0
    assert distance(1.0, 1 + 1e-7) < 1e-6 < distance([1e6, 1.0], [1e6, 10.0])
    for other in (None, "x", [1.0], [[1.0]], {"a": 1.0}, np.nan, [1.0, "x"]):
        assert distance(1.0, other) == np.inf
    assert fits(2.0, 2.0 + 1e-7, 1.0) and not fits(2.0, 2.1, 1.0)
    assert not fits(1 + 2e-6, 1 + 1e-6, 1.0)  # nearer to each other than ours, but not the same
    assert not fits(np.array([0, 0]), np.zeros(2), np.array([0.25, 0.75]))  # one cuts fractions
    assert weight(2.0, 2.0, 1.0) == 1 and weight(2.0, 2.0, 2.0) == 0
    assert weight(True, True, False) == 0.5 and weight([1, 0], [1, 0], [0, 0]) == 0.5
