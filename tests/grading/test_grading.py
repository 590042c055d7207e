"""Grading: submissions in their child process, skeletons, hints, and what is shown."""

import io
import json
import os
import stat
from pathlib import Path

import psutil
import pytest
from rich.console import Console

from botschool.errors import BotschoolError
from botschool.grading.copies.new import new_exercise
from botschool.grading.copies.skeleton import skeleton, write_skeletons
from botschool.grading.declare import exercise as exercises
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.trust import trust
from botschool.grading.judge.points import GraderFault, grade_task
from botschool.grading.judge.submission import Submission, grade
from botschool.grading.report.hints import next_hints, read_hints
from botschool.grading.report.screen import Screen
from botschool.grading.run import confined
from botschool.grading.run.confined import fork_server
from botschool.grading.run.student import Student
from tiny_course import FILE, FOLDER, HINTS, SOLUTION, make_course, submit


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def graded(course, tmp_path):
    """Grades a submission with this text."""

    def grade_text(text):
        return grade(load_exercise(3, course), submit(tmp_path / "one", text))

    return grade_text


@pytest.fixture
def student(tmp_path):
    made = []

    def make(text, seconds=5):
        made.append(Student(submit(tmp_path / f"student{len(made)}", text), seconds))
        return made[-1]

    yield make
    for each in made:
        each.close()


# --- points


@pytest.mark.slow
def test_solution_and_skeleton(graded, course, tmp_path):
    assert graded(SOLUTION).points == 100
    untouched = grade(load_exercise(3, course), course / "exercises" / FOLDER / FILE)
    assert [task.message for task in untouched.tasks] == [
        "not done yet: task 3.1: double the numbers",
        "not done yet: task 3.2: add the numbers up",
    ]


@pytest.mark.slow
def test_partial_credit_and_where_it_went_wrong(graded):
    result = graded("def double(x):\n    assert x.ndim == 1\n    return 2 * x\n")
    assert [task.points for task in result.tasks] == [40, 0]
    assert "raised AssertionError\n  tiny.py:2: assert x.ndim == 1" in result.tasks[0].message
    assert result.tasks[1].message == (
        "there is no function total in your file: its name must be as the exercise's file gives it."
    )


HOSTILE = {
    "exits": ("import sys\ndef double(x): sys.exit(0)", "raised SystemExit"),
    "ends": ("import os\ndef double(x): os._exit(0)", "program ended"),
    "equals everything": (
        "class E(list):\n    __eq__ = lambda *a: True\ndef double(x): return E()",
        "an empty list",
    ),
    "nan": ("def double(x): return x * float('nan')", "NaN"),
    "strings": ("def double(x): return [str(2 * v) for v in x]", "not an array of numbers"),
    "object": ("def double(x): return object()", "object of type object"),
    "broken": ("def double(x) return x", "Not graded: mend the file first"),
    "exits when loaded": ("raise SystemExit(0)", "Not graded: mend the file first"),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile(graded, kind):
    text, sentence = HOSTILE[kind]
    add = "\ndef total(x): return float(sum(x))\n" if text.startswith(("import", "class")) else ""
    result = graded(text + add)
    assert result.tasks[0].points == 0
    assert sentence in result.tasks[0].message
    assert result.tasks[1].points == (40 if add else 0)


@pytest.mark.slow
def test_time_is_bounded(graded):
    result = graded("def double(x):\n    while True: pass\ndef total(x): return float(sum(x))\n")
    assert "did not return within the task's 2 seconds" in result.tasks[0].message
    assert result.tasks[1].points == 40


@pytest.mark.slow
def test_nothing_is_left(graded, tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    (tmp_path / "temporary").mkdir()
    before = psutil.Process().children(recursive=True)  # multiprocessing's tracker, for one
    graded(
        "import os, threading, time\nos.mkdir('closed', 0)\nopen('x', 'w').close()\n"
        "threading.Thread(target=time.sleep, args=(1000,)).start()\ndef double(x): return x\n"
    )
    assert not list((tmp_path / "temporary").iterdir())
    assert psutil.Process().children(recursive=True) == before


# --- what a submission can reach


@pytest.mark.slow
def test_answers_are_out_of_reach(student, course):
    one = student("def read(path):\n    return open(path).read()\n")
    one.call("read", os.devnull)
    if one.missing:
        pytest.skip(f"this system cannot confine a submission's {', '.join(one.missing)}")
    for path in (
        course / "solutions" / FOLDER / FILE, course / "exercises" / FOLDER / "test_tiny.py",
        one._file, f"/proc/{os.getpid()}/environ", __file__, "/etc/shadow",
    ):  # fmt: skip
        with pytest.raises(Wrong, match="PermissionError"):
            one.call("read", str(path))
    with pytest.raises(Wrong, match="raised PermissionError"):
        student("import socket\ndef go(): socket.socket()").call("go")
    with pytest.raises(Wrong, match="raised PermissionError"):
        student("import os\ndef go(): os.fork()").call("go")


def test_graders_links_and_hidden_files_are_not_copied(tmp_path):
    file = submit(tmp_path / "own", SOLUTION)
    (tmp_path / "secret.txt").write_text("secret")
    for name in ("test_tiny.py", ".hidden", "helper.py", "data/test_numbers.npy"):
        place = file.parent / name
        place.parent.mkdir(exist_ok=True)
        place.write_text("")
    (file.parent / "link.txt").symlink_to(tmp_path / "secret.txt")
    (file.parent / "folder").symlink_to(tmp_path)
    os.mkfifo(file.parent / "pipe")
    names = [str(path.relative_to(file.parent)) for path in confined.submission_files(file)]
    assert names == ["data/test_numbers.npy", "helper.py", FILE]
    linked = submit(tmp_path / "linked", "")
    linked.unlink()
    linked.symlink_to(file)
    with pytest.raises(Wrong, match="is a link"):
        confined.submission_files(linked)


def test_scratch_files_that_are_not_there(student):
    one = student("def write():\n    open('best.txt', 'w').write('1')\n")
    one.call("write")
    assert one.scratch("best.txt").read_text() == "1"
    for name in ("absent.txt", "../../../../etc/passwd"):
        with pytest.raises(Wrong, match=r"write\(\) should have written the file"):
            one.scratch(name)


def test_limits_are_told(student):
    with pytest.raises(Wrong, match=r"while talk.* was running: it printed more than 16 MB"):
        student("def talk():\n    while True: print('x' * 100_000)\n", 20).call("talk")


# --- skeletons


def test_skeleton_replaces_every_region():
    text = skeleton(SOLUTION)
    assert text.count("raise NotImplementedError") == 2
    assert '    raise NotImplementedError("task 3.2: add the numbers up")' in text
    assert "SOLUTION" not in text and "np.sum" not in text
    assert skeleton(text) == text


@pytest.mark.parametrize(
    "text",
    [
        "### BEGIN SOLUTION task 3.1: x\n",
        "### END SOLUTION\n",
        "### BEGIN SOLUTION\n### END SOLUTION\n",
        "### BEGIN SOLUTION task 3.1: x\n### BEGIN SOLUTION task 3.2: x\n### END SOLUTION\n",
    ],
)
def test_damaged_regions_are_refused(text):
    with pytest.raises(ValueError, match=r"line|closed"):
        skeleton(text)


def test_an_edited_file_is_never_overwritten(course):
    file = course / "exercises" / FOLDER / FILE
    solution = course / "solutions" / FOLDER / FILE
    assert write_skeletons(course) == []
    file.write_text(file.read_text() + "# my work\n")
    mine = file.read_text()
    solution.write_text(SOLUTION.replace("twice as large", "two times as large"))
    assert write_skeletons(course) == [file]
    assert file.read_text() == mine
    assert write_skeletons(course) == [file]
    file.unlink()
    assert write_skeletons(course) == []
    assert "two times" in file.read_text()
    solution.write_text(SOLUTION)
    assert write_skeletons(course) == []
    assert file.read_text() == skeleton(SOLUTION)


# --- hints


def test_hints_are_read():
    hints = read_hints(HINTS)
    assert list(hints) == ["3.1", "3.2"]
    assert len(hints["3.1"]) == 2
    assert "```python\n# 1. not a hint" in hints["3.1"][1]


def test_one_more_hint_each_time(course):
    assert next_hints("3.1", course)[0] == ["Look at `*`."]
    assert [len(next_hints("3.1", course)[0]) for _ in range(3)] == [2, 2, 2]
    assert next_hints("3.2", course) == (["Look at `np.sum`."], 1, True)
    assert next_hints("3.2", course) == (["Look at `np.sum`."], 1, False)
    state = course / ".botschool" / "hints.json"
    assert json.loads(state.read_text()) == {"3.1": 2, "3.2": 1}
    assert (course / ".botschool" / ".gitignore").read_text() == "*\n"
    for damaged in ("{", "[1]", '{"3.2": "x"}', '{"3.2": -5}'):
        state.write_text(damaged)
        assert next_hints("3.2", course) == (["Look at `np.sum`."], 1, True)


# --- what is shown


def shown(action, width=80):
    console = Console(file=io.StringIO(), width=width, highlight=False)
    action(Screen(console))
    return console.file.getvalue()


@pytest.mark.slow
def test_report_fits_and_says_what_is_next(course):
    result = grade(load_exercise(3, course), course / "exercises" / FOLDER / FILE)

    def report(screen):
        screen.start(3, "Tiny", Path("tiny.py"))
        for task in result.tasks:
            screen.task(task)
        screen.end(result)

    text = shown(report)
    assert "0 of 100 points" in text
    assert "Next: task 3.1." in text and "botschool hint 3.1" in text
    assert len(text.splitlines()) < 10


@pytest.mark.slow
def test_students_text_is_no_markup(graded):
    result = graded(
        "print('[bold]\\x1b[2J[/nothing]')\ndef double(x): raise ValueError('[/]\\x07')\n"
    )
    text = shown(lambda screen: [screen.task(task) for task in result.tasks])
    assert "[bold]" in text and "\x1b" not in text and "\x07" not in text


def test_debugging_runs_here(course, capsys, monkeypatch):
    from botschool.grading.commands import grade_command

    (course / "exercises" / FOLDER / FILE).write_text(SOLUTION)
    assert grade_command("3.1", None, False, True) is False
    assert capsys.readouterr().out == "passed: doubles\npassed: doubles_many\n"


def test_a_single_task(course):
    exercise = load_exercise(3, course)
    with fork_server() as server:
        result = grade_task(exercise.find("3.2"), course / "solutions" / FOLDER / FILE, server)
    assert (result.points, result.max_points) == (40, 40)
    assert exercises.exercise_numbers(course) == [3]
    assert stat.S_IMODE((course / "exercises").stat().st_mode) & 0o700


# --- what can be loaded in part

PARTS = [
    "import numpy as np\nFACTOR = 2",
    "def double(x):\n    return FACTOR * x",
    "print(1 / 0)",
    "def total(x):\n    return float(np.sum(x))\n\n\ndef broken(:\n    pass",
]


@pytest.mark.slow
@pytest.mark.parametrize("parts", [PARTS[:3], PARTS[:2] + PARTS[3:], PARTS])
def test_a_script_and_a_notebook_that_fail_in_part_are_judged_alike(course, tmp_path, parts):
    exercise = load_exercise(3, course)
    script = submit(tmp_path / "script", "# %%\n" + "\n# %%\n".join(parts) + "\n")
    as_script = grade(exercise, script)
    with (
        fork_server() as server,
        Submission(tmp_path / "script" / FOLDER / FILE, server, parts, FILE) as notebook,
    ):
        as_notebook = [notebook.grade(task) for task in exercise.tasks]
    assert [task.points for task in as_script.tasks] == [task.points for task in as_notebook]
    assert [task.points for task in as_script.tasks] == [60, 40 if PARTS[3] in parts else 0]
    if PARTS[3] not in parts:
        assert as_script.banner.startswith(
            "Your file cannot be loaded. Mend this first:\n  tiny.py:8\n    print(1 / 0)\n"
            "  ZeroDivisionError: division by zero\n"
        )
        assert "The notebook cannot be loaded. Mend this first:" in notebook.banner
        assert "line 1 of the cell 'print(1 / 0)'" in notebook.banner
    else:
        assert "def broken(:\n               ^\n  SyntaxError: " in as_script.banner
        assert "\nLeft out: broken." in as_script.banner
        assert (
            "The notebook is not Python yet. Mend this first:\n  line 5 of the cell 'def total"
            in (notebook.banner)
        )


@pytest.mark.slow
def test_a_fault_of_the_grader_is_no_zero(course, tmp_path):
    exercise = load_exercise(3, course)
    task, file = exercise.tasks[0], submit(tmp_path / "one", SOLUTION)
    faults = {
        "before anything was asked": lambda student: [][0],
        "a name that is not there": lambda student: (student.call("double", 1), nowhere),  # noqa: F821
    }
    for check in faults.values():
        task.checks[0] = (40, "check", check)
        with pytest.raises(GraderFault, match=r"task 3\.1 has a fault.*test_grading\.py line"):
            grade(exercise, file)
    task.checks[0] = (40, "check", lambda student: student.call("double", 1)[0])
    result = grade(exercise, file)
    assert result.tasks[0].points == 20
    assert "cannot be judged (TypeError" in result.tasks[0].message


@pytest.mark.slow
def test_a_new_exercise_grades(tmp_path, server):
    for name in ("exercises", "solutions"):
        (tmp_path / name).mkdir()
    solution, _, _, empty, _ = new_exercise(tmp_path, 16, "Largest values")
    trust(tmp_path)
    exercise = load_exercise(16, tmp_path)
    assert grade(exercise, empty, server=server).points == 0
    assert grade(exercise, solution, server=server).points == 100
    with pytest.raises(BotschoolError, match="already"):
        new_exercise(tmp_path, 16, "Another")
