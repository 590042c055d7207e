"""A known mistake is named where a submission answers exactly as it does, and nowhere else."""

from functools import partial

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool.grading import Exercise, expect, expect_close
from botschool.grading.declare.mistakes import Known, read_cases
from botschool.grading.judge import causes
from botschool.grading.judge import known as replay
from botschool.grading.judge.alike import distance, fits, weight
from botschool.grading.judge.known import TOLD, line_about
from botschool.grading.judge.likeness import likest
from botschool.grading.judge.smallest import _smaller, difference, smallest_case
from botschool.grading.packed import pack
from botschool.grading.run.student import Student
from tiny_course import FILE

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
Gives half of the distance from the smallest to the largest value is returned.
def spread(values):
    return float(np.ptp(values)) / 2


%% from_one loses 3.2
Counts the steps from 1.
def walk(step, many):
    return [step(i) for i in range(1, many + 1)]
'''
RIGHT = "import numpy as np\ndef walk(step, many): return [step(i) for i in range(many)]\n"
BY_N = "def spread(x): return float((sum((np.array(x) - np.mean(x)) ** 2) / len(x)) ** 0.5)\n"
"""Another way to write the first mistake."""


def steps(module, many, factor):
    """A driver."""
    return module.walk(lambda i: factor * i, many)


def declared(inputs=((1.0, 2.0, 4.0), (3.0, 9.0, 1.0, 2.0)), mistakes=MISTAKES):
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)
    second = exercise.task("3.2", "Second", seconds=5)

    @first.check(40)
    def spreads(student):
        for values in inputs:
            expect_close(
                "spread(...)", student.call("spread", list(values)), np.std(values, ddof=1)
            )

    @second.check(60)
    def walks(student):
        for many, factor in ((5, 1.5), (7, 2.5)):
            found = student.run(steps, many, factor)
            expect(found == [factor * i for i in range(many)], f"walk(step, {many}): not the steps")

    exercise.knows(SOLUTION, mistakes)
    return exercise


@pytest.fixture
def messages(messages):
    return lambda text, exercise=None: messages(text, exercise or declared())


@pytest.mark.slow
def test_a_known_mistake_leads_the_message(messages):
    first, second = messages(RIGHT + BY_N)
    lines = first.splitlines()
    assert lines[0] == line_about("Divides the sum by n instead of n - 1.")
    assert lines[1].startswith("spread([1.0, 2.0, 4.0]) returned 1.24722, but 1.52753 was expected")
    assert second == ""


def test_so_does_one_that_a_driver_meets(messages):
    text = RIGHT.replace("range(many)", "range(1, 1 + many)") + BY_N.replace(
        "len(x)", "(len(x) - 1)"
    )
    first, second = messages(text)
    assert first == "" and second.startswith(line_about("Counts the steps from 1."))


@pytest.mark.slow
def test_one_input_is_not_enough(messages):
    """Of the first input by_n's value, and a right one of the second: two mistakes, or chance."""
    once = "def spread(x): return float(np.std(x, ddof=1 if len(x) > 3 else 0))\n"
    assert TOLD not in messages(RIGHT + once)[0]
    other = "def spread(x): return float(np.std(x)) if len(x) < 4 else 0.0\n"
    assert TOLD not in messages(RIGHT + other)[0]
    single = declared(inputs=((1.0, 2.0, 4.0),))
    assert TOLD not in messages(RIGHT + BY_N, single)[0]
    same = declared(inputs=((1.0, 2.0, 4.0),) * 3)
    assert TOLD not in messages(RIGHT + BY_N, same)[0]


@pytest.mark.slow
def test_where_an_answer_raises_the_mistake_must_be_wrong(messages):
    """Two wrong answers prove it; the third call raises, and by_n is wrong there, too."""
    inputs = ((1.0, 2.0, 4.0), (3.0, 9.0, 1.0, 2.0), (1.0, 2.0, 3.0, 4.0, 9.0))
    text = RIGHT + BY_N.replace(
        "return float", "\n    if len(x) == 5: raise ValueError('five')\n    return float"
    )
    assert messages(text, declared(inputs))[0].startswith(TOLD)
    same = (*inputs[:2], (2.0,) * 5)  # by_n is right there
    assert TOLD not in messages(text, declared(same))[0]
    assert TOLD not in messages(text, declared(inputs[1:]))[0], "a single answer proves nothing"


@pytest.mark.slow
def test_a_mistake_that_raises_the_same_is_proof(messages):
    raising = (
        MISTAKES
        + """

%% no_root_of_five loses 3.1
Takes five values for too many.
def spread(values):
    if len(values) == 5:
        raise ValueError("five")
    return float(np.std(values)) if len(values) == 3 else float(np.std(values, ddof=1))
"""
    )
    inputs = ((1.0, 2.0, 4.0), (3.0, 9.0, 1.0, 2.0), (1.0, 2.0, 3.0, 4.0, 9.0))
    text = (
        RIGHT
        + """
def spread(x):
    if len(x) > 4:
        raise ValueError({said!r})
    return float(np.std(x, ddof=0 if len(x) < 4 else 1))
"""
    )
    told = line_about("Takes five values for too many.")
    assert messages(text.format(said="five"), declared(inputs, raising))[0].startswith(told)
    assert TOLD not in messages(text.format(said="six"), declared(inputs, raising))[0]
    assert TOLD not in messages(text.format(said="five"), declared(inputs[1:], raising))[0]


def test_a_function_that_is_not_done_hides_no_mistake_of_another(messages):
    """Task 3.1 has two functions here; one of them is not written yet."""
    exercise = declared()
    first = exercise.tasks[0]

    @first.check(1)
    def walks_too(student):
        expect(student.run(steps, 3, 1.5) == [0, 1.5, 3], "walk: not the steps")

    undone = "import numpy as np\ndef walk(step, many): raise NotImplementedError('task 3.2')\n"
    assert messages(undone + BY_N, exercise)[0].startswith(TOLD)


def test_mistakes_are_tried_on_a_call_that_takes_little_time():
    """A long call may be as short a text; mistakes would be cut short there."""
    long, quick = b"a", b"abcd"
    calls = [
        replay.Call(long, 1.0, seconds=0.4, got=2.0),
        replay.Call(quick, 1.0, seconds=0.01, got=2.0),
        replay.Call(b"ab", 1.0, seconds=0.01, got=1.0),  # a right answer tells nothing
    ]
    assert replay._telling(calls).request == quick
    assert replay._telling(calls[::2]).request == long


def test_mistakes_that_are_like_the_submission_are_tried_first():
    """Those that add the same words, or take the same away."""
    solution = "def f(x):\n    return np.sort(x)[::-1].copy()\n"
    made = [
        ("squares", solution.replace("np.sort(x)", "np.sort(x) ** 2")),
        ("rises", solution.replace("[::-1]", "")),
        ("by hand", solution.replace("np.sort(x)[::-1].copy()", "sorted(x, key=abs)")),
    ]
    for text, first in (
        ("def f(numbers):\n    return np.sort(numbers).copy()\n", "rises"),
        ("def f(x):\n    y = np.sort(x) ** 2\n    return y[::-1].copy()\n", "squares"),
        ("def f(x):\n    return np.array(sorted(x, key=abs))\n", "by hand"),
        (solution, "squares"),
    ):
        assert likest(made, solution, text)[0][0] == first


def test_right_answers_start_no_trial(messages, monkeypatch):
    monkeypatch.setattr(causes, "calls_of", None)
    right = RIGHT + BY_N.replace("len(x)", "(len(x) - 1)")
    assert messages(right) == ["", ""]
    with pytest.raises(UserWarning, match="is not callable"):
        messages(RIGHT + BY_N)


@pytest.mark.slow
@pytest.mark.parametrize(("when", "told"), [("True", True), ("len(values) > 3", False)])
def test_time_is_limited(messages, monkeypatch, when, told):
    """A mistake that never ends costs little; after a first answer that fits, all the time."""
    monkeypatch.setattr(replay, "SECONDS", 0.5)
    monkeypatch.setattr(replay, "likest", lambda made, *_: [*made])
    endless = (
        "\n\n%% endless loses 3.1\nIt never ends.\ndef spread(values):\n"
        f"    while {when}: pass\n    return float(np.std(values))\n"
    )
    by_n, rest = MISTAKES.split("\n\n%% half", 1)
    head, by_n = by_n.split("\n\n%% by_n", 1)
    text = f"{head}{endless}\n\n%% by_n{by_n}\n\n%% half{rest}"
    assert [case.name for case in read_cases(3, text)][:2] == ["endless", "by_n"]
    first, _ = messages(RIGHT + BY_N, declared(mistakes=text))
    assert first.startswith(TOLD) == told


def test_mistakes_that_import_something_come_last():
    slow = "%% slow loses 3.1\nIt asks a library.\nimport statistics\n\n"
    names = [case.name for case in Known(3, SOLUTION, slow + MISTAKES).of("3.1")]
    assert names == ["by_n", "half_range", "slow"]


def test_no_time_limit_cuts_the_import_of_a_package_short(messages, monkeypatch):
    """An import that was cut short crashed the child, and the mistake was not named."""
    timed = []

    def near(ours, texts, *_):
        timed.extend(texts)
        return [True] * len(texts)

    monkeypatch.setattr(replay, "_near", near)
    library = "%% library loses 3.1\nIt asks a library.\nimport torch\n\n"
    first, _ = messages(RIGHT + BY_N, declared(mistakes=library + MISTAKES))
    assert first.startswith(TOLD)
    assert timed and not any("import torch" in text for text in timed)


@pytest.mark.slow
def test_a_mistake_that_fits_no_more_is_left_out(messages):
    text = MISTAKES.replace("-     spread_marks", "-     another_marks", 1)
    with pytest.raises(ValueError, match="must hold these lines exactly once"):
        read_cases(3, text)[0].of(SOLUTION)
    assert TOLD not in messages(RIGHT + BY_N, declared(mistakes=text))[0]
    half = "def spread(x): return (max(x) - min(x)) / 2\n"
    assert "half of the distance" in messages(RIGHT + half, declared(mistakes=text))[0]


def test_an_array_is_no_proof_of_an_exception():
    call = replay.Call(b"", np.arange(9.0), got={"raised": "ValueError", "text": "no"})
    assert call.agrees(np.zeros(9)) and call.proof(np.zeros(9)) == 0
    assert call.agrees(dict(call.got)) and call.proof(dict(call.got)) == 1


FILES = """import os
def spread(x):
    many = len(os.listdir())
    open(f"{many}.txt", "w").close()
    return {"folder": many, "spread": float(np.std(x))}
"""


@pytest.mark.slow
def test_a_call_to_try_shows_what_it_answers_in_a_new_process(messages, monkeypatch):
    """The name of a folder that others were in was told, though a new process has the right one."""
    exercise = Exercise(3, "Three", FILE)

    @exercise.task("3.1", "First").check(1)
    def spreads(student):
        for values in ([1.0, 2.0, 4.0] * 20, [3.0, 9.0, 1.0, 2.0] * 20):
            found = student.call("spread", np.array(values))
            expect_close("spread(...)", found["spread"], np.std(values, ddof=1))

    exercise.knows(RIGHT + FILES.replace("(x))}", "(x, ddof=1))}"), "")
    monkeypatch.setattr(replay, "variations", lambda *_: iter(()))
    (first,) = messages(RIGHT + FILES, exercise)
    assert "spread is 0" in first and "folder" not in first


BY_CHANCE = """import os
def spread(x):
    right = float(np.std(x, ddof=1))
    noise = int.from_bytes(os.urandom(2), "big") / 2**17
    return right + noise if len(x) == 4 and random() else right


def random():
    if not os.path.exists("asked"):
        open("asked", "w").close()
        return False
    return True
"""


@pytest.mark.slow
def test_a_random_answer_is_not_called_kept(messages, monkeypatch):
    """It was right in a new process, but wrong in another way each time."""
    monkeypatch.setattr(replay, "variations", lambda *_: iter(()))
    inputs = ((3.0, 9.0, 1.0, 2.0), (3.0, 9.0, 1.0, 4.0))
    first, _ = messages(RIGHT + BY_CHANCE, declared(inputs, mistakes=""))
    assert "spread(...)" in first


numbers = st.one_of(st.booleans(), st.integers(), st.floats(), st.text(max_size=3), st.none())
arrays = st.integers(0, 3).map(np.ones) | st.just(np.ones((2, 2))) | st.just(np.array("text"))
answers = st.recursive(
    numbers | arrays,
    lambda parts: st.lists(parts, max_size=3) | st.dictionaries(st.sampled_from("ab"), parts),
    max_leaves=6,
)


def test_answers_of_uneven_arrays_are_shown(server, tmp_path):
    """hidden_activations of exercise 13 returns a list of arrays with different shapes."""
    ours = "import numpy as np\ndef f(x): return [np.ones((2, 3)), np.ones((2, 1)) * len(x)]\n"
    files = [tmp_path / "ours.py", tmp_path / "own.py"]
    for file, text in zip(files, (ours, ours.replace("* len", "+ len")), strict=True):
        file.write_text(text)
    found = Student(files[1], 5, server=server)
    request = {"name": "f", "arguments": [np.arange(6.0)], "options": {}}
    told, call = smallest_case(request, found, partial(Student, files[0], 5, server=server))
    found.close()
    assert call["arguments"][0].tolist() == [0.0]
    assert told == "f(np.array([0.0]))"


def test_a_pair_of_numbers_is_not_cut():
    pair = {"name": "f", "arguments": [np.array([1.0, 2.0])], "options": {}}
    row = {"name": "f", "arguments": [np.arange(5.0)], "options": {}}
    table = {"name": "f", "arguments": [np.ones((2, 3))], "options": {}}
    assert [bool([*_smaller(each)]) for each in (pair, row, table)] == [False, True, True]


def test_runs_of_different_lengths_are_not_cut():
    """The first steps of two runs may have no step in common."""
    for lengths in ((5, 7), (5, 5)):
        runs = [{"steps": np.arange(n), "best": np.ones(n)} for n in lengths]
        for groups in ({"a": runs}, {"a": runs[:1], "b": runs[1:]}):
            call = {"name": "f", "arguments": [groups, 4], "options": {}}
            assert bool([*_smaller(call)]) == (lengths == (5, 5))


def test_an_array_that_cuts_fractions_fits_only_another_one():
    ours, cut = np.array([0.25, 0.75]), np.array([0, 0])
    assert fits(cut, np.array([0, 0]), ours)
    assert not fits(cut, np.zeros(2), ours)
    assert fits(np.array([1, 2]), np.array([1.0, 2.0]), np.array([3.0, 4.0]))


@pytest.mark.slow
@given(answers, answers)
def test_any_two_answers_can_be_told_apart(got, right):
    """Rows of dicts were taken for numbers, and the whole submission was not graded."""
    assert difference("f(1)", got, right).startswith("f(1)")


def test_a_slip_of_ours_costs_no_points(messages, monkeypatch):
    def slips(*_):
        raise KeyError("a place that we forgot")

    monkeypatch.setattr(causes, "named", slips)
    with pytest.warns(UserWarning, match="a place that we forgot"):
        first, _ = messages(RIGHT + BY_N)
    assert first.startswith("spread(")


COSTS = "import numpy as np\ndef cost(rate, table): return rate * np.abs(table).sum(axis=1)\n"


def test_a_failure_without_a_call_has_no_smaller_one():
    assert smallest_case({}, None, None) is None


def test_a_call_that_is_too_long_is_made_smaller(messages):
    """To one row for which the answer differs from ours, with few digits and without what fits."""
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)
    table = np.random.default_rng(1).uniform(0, 1, (30, 4))
    table[20, 2] = -0.51234567

    @first.check(100)
    def costs(student):
        wanted = 2 * np.abs(table).sum(axis=1)
        expect_close("cost(2, table)", student.call("cost", 2, table), wanted)

    without_abs = COSTS.replace("np.abs(table)", "table")
    exercise.knows(COSTS)
    (told,) = messages(without_abs, exercise)
    assert "cost(2, np.array([[" in told
    assert "-0.512" in told and "-0.5123" not in told
    assert told.count("expected") == 1


@pytest.mark.slow
def test_a_cause_is_guessed_from_two_calls(messages, monkeypatch):
    monkeypatch.setattr(replay, "variations", lambda *_: iter(()))
    text = RIGHT + "def spread(x): return -float(np.std(x, ddof=1))\n"
    sign = "Only the sign"
    assert sign in messages(text, declared(mistakes=""))[0]
    assert sign not in messages(text, declared(inputs=((1.0, 4.0),), mistakes=""))[0]
    assert sign not in messages(text, declared(inputs=((1.0, 4.0),) * 2, mistakes=""))[0]


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


def test_a_packed_grader_knows_them_and_shows_nothing(messages, tmp_path):
    packed = pack(GRADER, SOLUTION, MISTAKES)
    for text in ("marks_our_own", "divided by n", "np.std", "ddof"):
        assert text not in packed
    names = {"__file__": str(tmp_path / "test_three.py")}
    exec(packed, names)
    (first,) = messages(BY_N.replace("np.", "__import__('numpy')."), names["exercise"])
    assert first.startswith(line_about("Divides the sum by n instead of n - 1."))


def test_answers_are_compared_part_by_part():
    one = {"a": [1.0, 2], "b": [np.eye(2), None, "x"]}
    assert distance(one, {"b": [[[1, 0], [0, 1]], None, "x"], "a": np.array([1.0, 2])}) == 0
    assert distance(1.0, 1 + 1e-7) < 1e-6 < distance([1e6, 1.0], [1e6, 10.0])
    for other in (None, "x", [1.0], [[1.0]], {"a": 1.0}, np.nan, [1.0, "x"]):
        assert distance(1.0, other) == np.inf
    assert distance([np.nan, np.inf], np.array([np.nan, np.inf])) == 0
    assert fits(2.0, 2.0 + 1e-7, 1.0) and not fits(2.0, 2.1, 1.0)
    assert not fits(1 + 2e-6, 1 + 1e-6, 1.0)  # nearer to each other than ours, but not the same
    assert weight(2.0, 2.0, 1.0) == 1 and weight(2.0, 2.0, 2.0) == 0
    assert weight(True, True, False) == 0.5 and weight([1, 0], [1, 0], [0, 0]) == 0.5


SAVED = '''"""A solution."""
def save(values, folder):
    """Write the sum."""
    ### BEGIN SOLUTION task 3.1: save
    name = "sum"
    with open(f"{folder}/{name}", "w") as file:
        file.write(str(sum(values)))
    ### END SOLUTION
'''
NAMES = '''"""Wrong solutions."""
%% one_file_each loses 3.1
There is a file for each value.
-     name = "sum"
+     name = f"sum{values[0]}"
%% total loses 3.1
Gives the file another name.
-     name = "sum"
+     name = "total"
'''


def listed(module, values):
    """A driver."""
    import os

    os.makedirs("saved", exist_ok=True)
    module.save(values, "saved")
    return sorted(os.listdir("saved"))


def test_files_of_one_mistake_do_not_hide_another(messages, monkeypatch):
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def saves(student):
        for values in ([1.5, 2.0], [2.5, 1.0], [0.5], [4.0, 1.0]):
            expect(student.run(listed, values) == ["sum"], "save(...): not this file")

    exercise.knows(SAVED, NAMES)
    monkeypatch.setattr(replay, "_near", lambda ours, texts, *_: [True] * len(texts))
    (told,) = messages(SAVED.replace('"sum"', '"total"'), exercise)
    assert told.splitlines()[0] == line_about("Gives the file another name.")
