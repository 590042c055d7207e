"""Tests of how a cause is looked for: in which calls, how long, and what is said."""

import numpy as np
import pytest

from botschool.grading import Exercise, same
from botschool.grading.judge import afresh, causes
from botschool.grading.judge import known as replay
from botschool.grading.judge.known import line_about
from botschool.grading.judge.looking import Failure, looked_at_again
from botschool.grading.run.kinds import with_kinds
from tiny_course import FILE

SOLUTION = '''"""A solution."""

import numpy as np


def turned(table):
    """Rows and columns exchanged, and the largest number."""
    ### BEGIN SOLUTION task 3.1: turn the table
    return {"table": table.T, "largest": float(np.max(table))}
    ### END SOLUTION
'''
WRONG = "import numpy as np\n\n\ndef turned(table):\n    {}\n"
SQUARES_STAY = "square = table.shape[0] == table.shape[1]\n    {}"
MISTAKE = f"""%% squares_stay loses 3.1
Leaves square tables as they are.
def turned(table):
    {SQUARES_STAY.format("return {'table': table if square else table.T, 'largest': table.max()}")}
"""


def declared(mistakes="", many=2, columns=(7,)):
    exercise = Exercise(3, "Three", FILE)

    @same(exercise.task("3.1", "Turned", seconds=5), 100, "turned")
    def turns(rng):
        for rows in range(2, 2 + many):
            yield rng.normal(size=(rows, *columns))

    exercise.knows(SOLUTION, mistakes)
    return exercise


def first_line(messages, body, exercise=None):
    (message,) = messages(WRONG.format(body), exercise or declared())
    return message.splitlines()[0]


@pytest.mark.slow
def test_a_mistake_that_shows_in_squares_only_is_named(messages):
    body = SQUARES_STAY.format("d = table if square else table.transpose()\n    ")
    body += 'return {"table": d, "largest": table.max()}'
    found = first_line(messages, body, declared(MISTAKE))
    assert found == line_about("Leaves square tables as they are.")


def test_no_cause_is_said_without_words(messages):
    """Numbers that suggest nothing, in a part that has a name."""
    body = 'return {"table": np.cos(91 * table.T) ** 3, "largest": table.max()}'
    assert first_line(messages, body, declared(many=6, columns=())).startswith("turned(")


@pytest.mark.slow
def test_what_stays_is_told_before_what_numbers_suggest(messages):
    """From the second call on, one is added."""
    body = "made.append(1)\n    "
    body += 'return {"table": table.T + (len(made) > 1), "largest": table.max()}\n\n\nmade = []'
    assert first_line(messages, body, declared(many=6)) == afresh.KEPT


def test_a_count_that_was_right_for_another_call_has_not_stayed(messages):
    exercise = Exercise(3, "Three", FILE)

    @same(exercise.task("3.1", "Counted", seconds=5), 100, "counted")
    def counts(rng):
        yield [1.0, 2.0, 3.0, 4.0], 1.5
        yield [5.0, 6.0, 7.0, 8.0, 9.0], 2.0

    body = "def counted(values, limit):\n    return sum(each {} limit for each in values)\n"
    begin, end = "    ### BEGIN SOLUTION task 3.1: count\n", "    ### END SOLUTION\n"
    line, code = body.format(">").splitlines(keepends=True)
    exercise.knows(line + begin + code + end, "")
    (message,) = messages(body.format(">="), exercise)
    assert "returned 3, but 2 was expected" in message
    assert "stays" not in message


class Chosen:
    """Gives the next of these answers, twice at a time."""

    def __init__(self, *answers):
        self.answers = [*answers]

    def twice(self, request):
        return {"answers": [self.answers.pop(0), self.answers.pop(0)], "arguments": []}

    def close(self):
        pass


@pytest.mark.parametrize(("answers", "told"), [((1, 1, 1, 2), True), ((1, 1, 1, 1), False)])
def test_chance_is_seen_in_one_of_five_answers(answers, told):
    failure = Failure("", request={"name": "f", "arguments": ()}, got=1)
    found = looked_at_again(failure, Chosen(*answers), lambda: Chosen(3, 3))
    assert ("gives another answer: by chance" in found) == told


ALL_WRONG = "return {'table': table, 'largest': 0.0}"
SQUARES_WRONG = SQUARES_STAY.format(
    "return {'table': table if square else table.T, 'largest': table.max()}"
)


@pytest.mark.parametrize(
    ("body", "limit", "more"),
    [(ALL_WRONG, 100.0, True), (ALL_WRONG, 1.0, False), (SQUARES_WRONG, 1.0, True)],
    ids=["quick", "slow", "wrong too seldom to be named"],
)
def test_more_calls_are_made_for_a_time(messages, monkeypatch, body, limit, more):
    """Each call takes a second."""
    asked, answered = [], causes.answered_by

    def timed(submission, call):
        done = answered(submission, call)
        call.took = 1.0
        return done

    def named(ours, calls, *_):
        asked.append(len(calls))
        return "named"

    monkeypatch.setattr(causes, "SPENT", limit)
    monkeypatch.setattr(causes, "answered_by", timed)
    monkeypatch.setattr(causes, "named", named)
    first_line(messages, body)
    assert (asked != [2]) == more


def test_the_first_mistake_that_explains_all_ends_the_search(messages, monkeypatch):
    tried, near = [], replay._near

    def counted(ours, texts, *more):
        tried.extend(texts)
        return near(ours, texts, *more)

    monkeypatch.setattr(replay, "_near", counted)
    other = "%% other_{0} loses 3.1\nAdds {0}.\ndef turned(table):\n    return table + {0}\n\n\n"
    known = "".join(map(other.format, range(20))) + MISTAKE
    found = first_line(messages, SQUARES_WRONG, declared(known))
    assert found == line_about("Leaves square tables as they are.")
    assert len(tried) <= replay.FEW


@pytest.mark.parametrize("held", [1j, np.array([1j])])
def test_kinds_are_those_of_all_variables(held):
    """A complex number of Python, and an array."""

    def squared(x):
        step = held  # noqa: F841 (held in a variable)
        return x * x

    answer, kinds = with_kinds(squared, 3.0)
    assert answer == 9.0 and "c" in kinds
    assert "c" not in with_kinds(lambda x: x * x, np.ones(3))[1]
