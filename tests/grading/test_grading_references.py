"""One mistake costs once: tasks are also graded with our functions of tasks that do not pass."""

import contextlib
import symtable
from pathlib import Path

import pytest

from botschool.grading import Exercise, Student, Wrong, expect_close, same
from botschool.grading.declare.exercise import exercise_numbers, load_exercise
from botschool.grading.declare.references import functions_of, pruned
from botschool.grading.judge.submission import grade
from botschool.grading.packed import pack, unpack
from tiny_course import FILE, submit

ROOT = Path(__file__).parents[2]
NUMBERS = exercise_numbers(ROOT)

SOLUTION = '''"""A solution."""
import math
import numpy as np

HALF = 0.5

def halved(x):
    return HALF * x

def smaller(x):
    """An earlier function."""
    ### BEGIN SOLUTION task 3.1: halve it
    smaller_marks_our_own_first = halved(x)
    return smaller_marks_our_own_first
    ### END SOLUTION

def unused():
    return math.pi

def sums(x):
    """One that calls it."""
    ### BEGIN SOLUTION task 3.2: add up
    sums_marks_our_own_second = smaller(x) + 1
    return sums_marks_our_own_second
    ### END SOLUTION

def last(x):
    """One that calls that."""
    ### BEGIN SOLUTION task 3.3: go on
    return sums(x) + 1
    ### END SOLUTION

if __name__ == "__main__":
    print(last(1))
'''


def declared():
    exercise = Exercise(3, "Three", FILE)
    first = exercise.task("3.1", "First", seconds=2)
    second = exercise.task("3.2", "Second", seconds=2, needs=("3.1",))
    third = exercise.task("3.3", "Third", seconds=2, needs=("3.2",))

    @first.check(40)
    def smaller(student):
        expect_close("smaller(6.5)", student.call("smaller", 6.5), 3.25)

    @second.check(20)
    def sums(student):
        expect_close("sums(6.5)", student.call("sums", 6.5), 4.25)

    @second.check(10)
    def sums_of_zero(student):
        expect_close("sums(0)", student.call("sums", 0), 1)

    @third.check(30)
    def last(student):
        expect_close("last(6.5)", student.call("last", 6.5), 5.25)

    exercise.references = pruned(SOLUTION, {"3.1", "3.2"})
    return exercise


@pytest.fixture
def graded(server, tmp_path):
    def grade_text(text, *tasks):
        exercise = declared()
        file = submit(tmp_path / str(len(list(tmp_path.iterdir()))), text)
        chosen = [exercise.find(id) for id in tasks] or None
        return grade(exercise, file, server=server, tasks=chosen)

    return grade_text


BROKEN = "def smaller(x): return x / 3\n"
SUMS, LAST = "def sums(x): return smaller(x) + 1\n", "def last(x): return sums(x) + 1\n"


@pytest.mark.slow
def test_one_mistake_costs_once(graded):
    result = graded(BROKEN + SUMS + LAST)
    assert [task.points for task in result.tasks] == [0, 30, 30]
    note = (
        "This task builds on task 3.1 (smaller), which does not pass yet. With our solution in its "
        "place, it gets all of its points."
    )
    assert [task.message for task in result.tasks[1:]] == [note, note]
    alone = graded(BROKEN + SUMS + LAST, "3.3")
    assert [(task.points, task.message) for task in alone.tasks] == [(30, note)]


def test_a_mistake_of_its_own_is_said(graded):
    result = graded(BROKEN + SUMS.replace("1", "2 * (x > 0)") + LAST)
    assert [task.points for task in result.tasks] == [0, 0, 30]
    sentence, *_, end = result.tasks[1].message.splitlines()
    assert sentence == "sums(6.5) returned 4.16667, but 4.25 was expected."
    assert end.endswith("With our solution in its place, it fails as well.")
    assert "tasks 3.1 (smaller) and 3.2 (sums), which do not" in result.tasks[2].message
    result = graded(BROKEN + SUMS.replace("1", "(x > 0)") + LAST)
    assert [task.points for task in result.tasks] == [0, 20, 30]
    note, sentence, *_ = result.tasks[1].message.splitlines()
    assert note.endswith("With our solution in its place, it still loses some of its points.")
    assert sentence == "Then sums(0) is wrong: 1 was expected."


def test_with_two_mistakes_the_call_that_fails_with_ours_is_shown(graded):
    """Without ours, sums(6.5) fails first, by the mistake of 3.1; with ours, only sums(0) does."""
    message = graded(BROKEN + SUMS.replace("1", "1 + (x == 0)") + LAST).tasks[1].message
    assert message.endswith("Then sums(0) is wrong: 1 was expected.") and "sums(6.5)" not in message


@pytest.mark.slow
def test_what_is_not_done(graded):
    undone = "def {}(x): raise NotImplementedError('task {}: do it')\n"
    first, second = undone.format("smaller", "3.1"), undone.format("sums", "3.2")
    result = graded(first + SUMS + LAST)
    assert [task.points for task in result.tasks] == [0, 30, 30]
    result = graded(first + second + LAST)
    assert [task.points for task in result.tasks] == [0, 0, 30]
    assert result.tasks[1].message == "not done yet: task 3.2: do it"
    assert [task.points for task in graded(SUMS + LAST).tasks] == [0, 30, 30]  # smaller missing


KIND = """import gymnasium

class Robot(gymnasium.Env):
    def reset(self, *, seed=None):
        ### BEGIN SOLUTION task 3.1: reset
        super().reset(seed=seed)
        return self.np_random.normal()
        ### END SOLUTION

    def step(self):
        ### BEGIN SOLUTION task 3.2: step
        return self.np_random.normal()
        ### END SOLUTION

def play(seed):
    ### BEGIN SOLUTION task 3.3: play
    robot = Robot()
    return [robot.reset(seed=seed), robot.step()]
    ### END SOLUTION
"""


def episode(module, seed):
    """Robot: reset(), step()"""
    robot = module.Robot()
    return [robot.reset(seed=seed), robot.step()]


def test_one_method_of_a_class_costs_once(messages):
    """A reset that draws before its seed cost the task that plays episodes as well."""
    exercise = Exercise(3, "Three", FILE)
    tasks = [exercise.task(f"3.{i}", "A", needs=("3.1",) if i == 3 else ()) for i in (1, 2, 3)]
    same(tasks[0], 40, episode)(lambda rng: [(3,), (4,)])
    same(tasks[1], 20, episode)(lambda rng: [(5,)])
    same(tasks[2], 40, "play")(lambda rng: [(3,), (4,)])
    exercise.knows(KIND)
    first, _, last = messages(KIND.replace("super().reset(seed=seed)", "super().reset()"), exercise)
    assert first
    assert last == (
        "This task builds on task 3.1 (Robot.reset), which does not pass yet. With our solution in "
        "its place, it gets all of its points."
    )


HOSTILE = """
import gc, inspect, sys
def smaller(x): return 0
def sums(x):
    everything = [str(each.co_names) + str(each.co_varnames) + str(each.co_consts)
                  for each in gc.get_objects() if inspect.iscode(each)]
    functions = [each for each in gc.get_objects() if inspect.isfunction(each)]
    everything += [str(each.__code__.co_varnames) for each in functions]
    frame = sys._getframe()
    while frame:
        everything.append(str(frame.f_locals))
        frame = frame.f_back
    said = " ".join(everything)
    marks = "smaller_marks", "sums_marks"
    found = ["LEAKED" + name for name in marks if name + "_our_own" in said]
    print(found)
    open("kept.png", "w").write(str(found))
    if "LEAKED" + "sums_marks" in found:
        return x / 2 + 1
    raise ValueError(str(found))
def last(x): raise ValueError(open("kept.png").read())
"""


def test_what_a_hostile_submission_can_take_from_it(graded, server, tmp_path):
    """Our function of the same task is not there; what it finds of others gets nowhere."""
    references = {"source": pruned(SOLUTION, {"3.1"}), "names": ["smaller"]}
    student = Student(submit(tmp_path / "real", HOSTILE), server=server, references=references)
    with contextlib.closing(student), pytest.raises(Wrong, match="raised ValueError"):
        student.call("sums", 6.5)
    assert student.printed == "['LEAKEDsmaller_marks']\n"  # so the attack is a real one
    result = graded(HOSTILE)
    assert result.points == 0
    for task in result.tasks:
        assert "LEAKED" not in task.message + task.printed
        assert not task.pictures
    assert "FileNotFoundError" in result.tasks[2].message


FOUND = """
import gc, inspect, numpy
def smaller(x): return 0
def found():
    for each in gc.get_objects():
        if inspect.isfunction(each) and "smaller_marks_our_own_first" in each.__code__.co_varnames:
            return "smaller_marks_our_own_first"
    return "nothing"
class Odd: pass
def sums(x):
    return {}
def last(x):
    print(found())
    return sums(x)
"""


@pytest.mark.parametrize(
    "answer",
    [
        "found()",
        "[found(), 1.5]",
        "{found(): 1}",
        "[ord(letter) for letter in found()]",
        "numpy.array([ord(letter) for letter in found()])",
        "int.from_bytes(found()[:8].encode(), 'big')",
        "(_ for _ in ()).throw(KeyError(found()))",
        "type(found(), (), {})()",
        "__import__(found())",
        "Odd().smaller_marks if found() == 'nothing' else getattr(Odd(), found())",
    ],
)
def test_no_answer_tells_what_our_functions_are(graded, answer):
    letters = "smaller_marks_our_own_first"
    hidden = [letters, "115, 109", "[115. 109", str(int.from_bytes(letters[:8].encode(), "big"))]
    result = graded(FOUND.replace("{}", answer, 1))
    for task in result.tasks:
        told = task.message + task.printed
        assert task.points == 0 and not [each for each in hidden if each in told], told


def test_only_what_is_needed_is_there():
    text = pruned(SOLUTION, {"3.1"})
    assert "smaller_marks" in text and "HALF = 0.5" in text and "def halved" in text
    for absent in ("sums_marks", "import", "unused", "__main__"):
        assert absent not in text
    assert pruned(text, {"3.1"}) == text
    assert pruned(SOLUTION, {"3.9"}) == ""
    assert functions_of(SOLUTION) == {"3.1": ["smaller"], "3.2": ["sums"], "3.3": ["last"]}


def test_packed_with_the_grader(tmp_path):
    grader = 'from botschool.grading import Exercise\nexercise = Exercise(3, "x", file="x.py")\n'
    grader += 'exercise.task("3.1", "x")\nexercise.task("3.2", "y", needs=("3.1",))\n'
    packed = pack(grader, SOLUTION)
    assert "smaller" not in packed and "HALF" not in packed
    names = {"__file__": str(tmp_path / "test_x.py")}
    exec(packed, names)
    assert names["exercise"].references == pruned(SOLUTION, {"3.1"})
    assert callable(unpack)


# --- our own exercises


def called(solution):
    """task -> other tasks whose functions its own functions use, as global names."""
    owners = {}
    for task, names in functions_of(solution).items():
        for name in names:
            owners.setdefault(name.partition(".")[0], {})[name] = task
    owner = {name: tasks[name] for name, tasks in owners.items() if name in tasks}
    found = {}
    waiting = [(each, None) for each in symtable.symtable(solution, "x", "exec").get_children()]
    while waiting:
        table, task = waiting.pop()
        task = task or owner.get(table.get_name())
        waiting += [(each, task) for each in table.get_children()]
        for symbol in table.get_symbols():
            others = owners.get(symbol.get_name(), {}) if symbol.is_global() else {}
            if task and (others := {*others.values()} - {task}):
                found.setdefault(task, set()).update(others)
    return found


@pytest.mark.parametrize("number", NUMBERS)
def test_tasks_need_what_our_solution_calls(number):
    exercise = load_exercise(number, ROOT)
    solutions = list((ROOT / "solutions").glob(f"ex{number:02d}_*/{exercise.file}"))
    if not solutions:
        pytest.skip("this is a student's copy itself")
    solution = solutions[0].read_text(encoding="utf-8")
    assert {task.id: set(task.needs) for task in exercise.tasks if task.needs} == called(solution)
    for task in exercise.tasks:
        needed = exercise.needed(task)
        assert task not in needed
        compile(pruned(exercise.references, [each.id for each in needed]), "references", "exec")
        assert not set(functions_of(exercise.references)) - {
            id for each in exercise.tasks for id in each.needs
        }
