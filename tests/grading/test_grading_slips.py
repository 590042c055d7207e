"""A slip of ours is named where no known mistake fits."""

import pytest

from botschool.grading import Exercise, expect, expect_close
from botschool.grading.judge import known as replay
from botschool.grading.judge.evidence import may_be_true
from botschool.grading.judge.sentences import Variation
from tiny_course import FILE

BOUNDS = '''"""A solution."""
def bounds(values, low, high):
    """Each value between low and high, then how many there are, then the sum of those below."""
    ### BEGIN SOLUTION task 3.1: keep
    hidden, below = [], 0
    for value in values:
        if low <= value < high:
            hidden.append(value)
        if value < low:
            below += value
    many = len(hidden)
    return {"kept": hidden, "many": many, "below": float(below)}
    ### END SOLUTION
'''
SLIPS = {
    "`<` and `<=` are taken for each other: `value < low`": BOUNDS.replace(
        "value < low", "value <= low"
    ),
    "something should be added to it: `below`": BOUNDS.replace("below += value", "below = value"),
    "anew in each pass": BOUNDS.replace(
        "        if low", "        hidden, below = [], 0\n        if low"
    ),
    "The last pass of a loop is left out": BOUNDS.replace("in values:", "in values[:-1]:"),
    "`low` is used where `high` belongs": "def bounds(values, low, high):\n"
    "    below = float(sum(v for v in values if v < high))\n"
    "    kept = [v for v in values if low <= v < high]\n"
    "    return {'kept': kept, 'many': len(kept), 'below': below}\n",
}


def bounded():
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def cuts(student):
        for values in ([0.5, 1.5, 3.0, 2.0, -4.0, 1.0], [1.0, 2.5, 1.25, 2.0, 0.25, -1.5]):
            answer = student.call("bounds", values, 1.0, 2.0)
            kept = [value for value in values if 1 <= value < 2]
            below = sum(value for value in values if value < 1)
            wanted = {"kept": kept, "many": len(kept), "below": below}
            expect(answer == wanted, "bounds(...): not these")

    exercise.knows(BOUNDS)
    return exercise


@pytest.mark.parametrize("said", list(SLIPS))
def test_a_slip_is_named(messages, said):
    (told,) = messages(SLIPS[said], bounded())
    if said.startswith("`low`"):  # the other way round
        said = "`high` is used where `low` belongs"
    assert told.startswith(replay.VARIED) and said in told.splitlines()[0]


def test_a_slip_quotes_only_what_the_text_says():
    found = list(replay.variations(BOUNDS, "3.1"))
    assert len({each.text for each in found}) == len(found) > 30
    assert any("`value < low`" in each.what for each in found) and BOUNDS not in found
    assert not [each.what for each in found if "hidden" in each.what]
    assert not list(replay.variations(BOUNDS, "3.2"))
    for each in found:
        compile(each.text, "a slip", "exec")


@pytest.mark.slow
def test_a_slip_that_never_ends_stops_nothing(messages):
    """Without its step this loop never ends; the slip after it is found all the same."""
    ours = BOUNDS.replace(
        "    for value in values:\n",
        "    at = 0\n    while at < len(values):\n        value = values[at]\n        at += 1\n",
    )
    exercise = bounded()
    exercise.knows(ours)
    (told,) = messages(SLIPS["something should be added to it: `below`"], exercise)
    assert "should be added to it" in told.splitlines()[0]


@pytest.mark.slow
def test_other_answers_are_no_slip(messages):
    for end in ("{'kept': [], 'many': 3, 'below': 0.25}", "{}"):
        text = f"def bounds(values, low, high):\n    return {end}\n"
        assert replay.VARIED not in messages(text, bounded())[0]


@pytest.mark.slow
def test_a_slip_in_a_right_solution_of_another_style_is_named(messages):
    """The slip changes a part that our own solution does not have."""
    style = (
        "\n%% by_masks\nArrays and masks.\n"
        "def bounds(values, low, high):\n"
        "    import numpy as np\n\n"
        "    values = np.asarray(values)\n"
        "    kept = values[(values >= low) & (values < high)]\n"
        "    below = np.minimum(values - low, 0).sum() + low * (values < low).sum()\n"
        "    return {'kept': kept.tolist(), 'many': len(kept), 'below': float(below)}\n"
    )
    wrong = style.split("masks.\n")[1].replace("np.minimum(values - low, 0)", "(values - low)")
    exercise = bounded()
    assert replay.VARIED not in messages(wrong, exercise)[0]
    exercise.knows(BOUNDS, style)
    (told,) = messages(wrong, exercise)
    assert told.startswith(f"{replay.VARIED} A limit is left out")  # nobody else has its `below`


ENDS = '''"""A solution."""
def long(values, stopped, limit):
    """How many values come before the first one that is stopped, limit at most."""
    ### BEGIN SOLUTION task 3.1: keep
    many = 0
    while many < len(values) and not (many >= limit or stopped[many]):
        many += 1
    return {"many": many, "sum": float(sum(values[:many]))}
    ### END SOLUTION
'''


@pytest.mark.slow
@pytest.mark.parametrize("asks", [False, True])
def test_a_condition_that_is_there_is_not_said_to_be_left_out(messages, asks):
    """Who asks for the limit, but sets it to another number before, has not left it out."""
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def ends(student):
        for values in ([0.5, 1.5, 3.0, 2.5], [1.25, 2.5, 1.75, 2.25, 0.25]):
            for stopped, many in ((False, 2), (True, 0)):
                answer = student.call("long", values, [stopped] * len(values), 2)
                right = {"many": many, "sum": float(sum(values[:many]))}
                expect(answer == right, "long(...): not these")

    exercise.knows(ENDS)
    wrong = ENDS.replace("many >= limit or ", "")
    if asks:
        wrong = ENDS.replace("    many = 0", "    many, limit = 0, max(limit, 9)")
    (told,) = messages(wrong, exercise)
    assert ("One of several conditions is left out: `many >= limit`" in told) is not asks


ENTRY = '''"""A solution."""
def entry(values, number):
    """The entry with this number, from 1."""
    ### BEGIN SOLUTION task 3.1: entry
    kept = values[:number]
    return float(kept[number - 1])
    ### END SOLUTION
'''


def test_exceptions_alone_prove_no_slip(messages):
    """`kept[number]` raises the same, as any other code that looks for too much."""
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def numbers(student):
        for number in (1, 2, 3, 4, 5):
            values = [0.5, 1.5, -3.0, 2.5, 4.25]
            expect_close("entry(...)", student.call("entry", values, number), values[number - 1])

    exercise.knows(ENTRY)
    (told,) = messages("def entry(values, number):\n    return [][0]\n", exercise)
    assert "IndexError" in told and replay.VARIED not in told


DOUBLED = "def told(x):\n    first = 2 * x\n    second = first + 1\n    return second\n"


def test_a_vague_slip_is_named_only_where_the_function_is_written_alike():
    without, other = DOUBLED.replace("2 * ", ""), "def told(values):\n    return 1 + values\n"
    for what, elsewhere in (
        ("A factor is left out.", False),
        ("The first pass of a loop is left out.", False),
        ("Two steps are done in the wrong order: `first`.", False),
        ("A factor is left out: `scale`.", True),
    ):
        slip = Variation(what, without, function="told")
        assert may_be_true(slip, without.replace("second", "end"))
        assert may_be_true(slip, other) == elsewhere
        assert may_be_true(slip, "no Python (") == elsewhere


def test_a_step_that_is_there_is_not_said_to_be_left_out():
    slip = Variation("A step is left out: `table[:, 1:]`.", DOUBLED, function="told")
    assert may_be_true(slip, "def told(table):\n    table[:, 1] = 3\n")
    for sign in ("=", "+="):
        assert not may_be_true(slip, f"def told(table):\n    table[:, 1:] {sign} 3\n")


def test_no_slip_is_named_for_an_answer_that_never_changes(messages):
    ours = (
        "def told(x):\n    ### BEGIN SOLUTION task 3.1: told\n"
        "    return 0.75 * x + 8.5 if x > 1 else 3.25\n    ### END SOLUTION\n"
    )
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=5)

    @first.check(100)
    def many(student):
        for x in (0.5, 1.25, 7.5, 2.25, 9.5):
            expect_close("told(...)", student.call("told", x), 0.75 * x + 8.5 if x > 1 else 3.25)

    exercise.knows(ours)
    assert replay.VARIED not in messages("def told(x):\n    return 3.25\n", exercise)[0]
