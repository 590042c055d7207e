"""Ways to read, keep or fake something from within a submission: each was open once."""

import csv
import errno
import json
import os
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import pytest

from botschool.grading.classes import batch
from botschool.grading.classes.commands import grade_all_command
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.state import secret_for_others
from botschool.grading.judge.submission import grade
from botschool.grading.notebook import grade_cell
from botschool.sandbox import SandboxError
from botschool.sandbox.inside import read_inside
from running import call, environment_of_command, one_sentence, start
from tiny_course import FILE, FOLDER, SOLUTION, make_course, submit

pytestmark = pytest.mark.slow

SECRET = "precious = 'of somebody else'"
AS_ROOT = pytest.mark.skipif(os.geteuid() != 0, reason="only root gives files to others")


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def precious(tmp_path):
    """A file of somebody else, in a folder of his."""
    path = tmp_path / "neighbour" / "private" / "precious.py"
    path.parent.mkdir(parents=True)
    path.write_text(f"{SECRET}\n")
    return path


# --- lines of files that are not the submission's
def raising(name):
    """A submission whose exception says that it was raised in another file of its folder."""
    return f"""
import os
HERE = os.path.dirname(__file__)
exec(compile("def double(x): raise ValueError(1)", HERE + {name!r}, "exec"))
"""


def unreadable(name):
    """A submission that says of itself that it is no Python, in another file of its folder."""
    return f"""
import os
raise SyntaxError("invalid", (os.path.dirname(__file__) + {name!r}, 1, 1, "text"))
"""


@pytest.mark.parametrize("says", [raising, unreadable])
@pytest.mark.parametrize("way", ["folder", "folders", "file", "parent", "up and down", "hidden"])
def test_no_line_of_another_file_is_shown(course, tmp_path, precious, way, says):
    name = {
        "folder": "/link/precious.py",
        "folders": "/below/link/private/precious.py",
        "file": "/precious.py",
        "parent": "/../../../neighbour/private/precious.py",
        "up and down": "/link/../precious.py",
        "hidden": "/.hidden.py",
    }[way]
    file = submit(tmp_path / "one", says(name))
    (file.parent / "link").symlink_to(precious.parent)
    (file.parent / "below").mkdir()
    (file.parent / "below" / "link").symlink_to(precious.parent.parent)
    (file.parent / "precious.py").symlink_to(precious)
    (file.parent / ".hidden.py").symlink_to(precious)
    result = grade(load_exercise(3, course), file)
    assert "ValueError: 1" in str(result) or "SyntaxError: invalid" in str(result)
    assert SECRET not in str(result)


def test_lines_of_own_files_in_folders_are_shown(course, tmp_path):
    file = submit(tmp_path / "one", "from own.helper import double\n")
    (file.parent / "own").mkdir()
    (file.parent / "own" / "helper.py").write_text("def double(x):\n    return 1 / 0\n")
    assert "own/helper.py:2: return 1 / 0" in str(grade(load_exercise(3, course), file).tasks[0])


def test_a_folder_that_becomes_a_link_leads_nowhere(tmp_path, precious):
    top = tmp_path / "top"
    (top / "inner").mkdir(parents=True)
    (top / "inner" / "precious.py").write_text("own\n")
    assert read_inside(top, "inner/precious.py", 100) == b"own\n"
    (top / "inner").rename(top / "other")
    (top / "inner").symlink_to(precious.parent)
    for name in ("inner/precious.py", "../neighbour/private/precious.py", str(precious), "\0", ""):
        with pytest.raises(OSError):
            read_inside(top, name, 100)
    os.mkfifo(top / "pipe")
    for name in ("pipe", "other"):
        with pytest.raises(OSError):
            read_inside(top, name, 100)


@AS_ROOT
def test_a_hard_link_to_a_file_of_another_user_is_left_out(course, tmp_path, precious):
    file = submit(tmp_path / "one", f"{raising('/taken.py')}\nprint(os.listdir())")
    os.link(precious, file.parent / "taken.py")
    os.chown(precious, 1234, 1234)
    result = grade(load_exercise(3, course), file)
    assert "raised ValueError" in result.tasks[0].message
    assert SECRET not in str(result) and "taken.py'" not in result.tasks[0].printed
    file.unlink()
    os.link(precious, file)
    assert "another user's file" in str(grade(load_exercise(3, course), file))


# --- answers that were recorded
RECORDED = """
import json, os
import numpy as np
TABLE = {table!r}

def looked_up(numbers):
    return TABLE.get(np.asarray(numbers).tobytes().hex(), 0)

def double(numbers):
    found = looked_up(numbers)
    return np.array(found) if found else found

def total(numbers):
    return looked_up(numbers)
"""


def recorded(course, secret="", work=""):
    """A submission of the answers that the solution gives to a student at home.

    secret, work: else those of a submission that is graded under a secret.
    """
    exercise, table = load_exercise(3, course), {}
    exercise.secret, exercise.work = secret, work

    class Recorder:
        said = ""

        def call(self, name, numbers):
            answer = 2 * numbers if name == "double" else float(numbers.sum())
            table[numbers.tobytes().hex()] = np.asarray(answer).tolist()
            return answer

    for task in exercise.tasks:
        for _, _, check in task.checks:
            check(Recorder())
    return RECORDED.format(table=table)


def points(*arguments, **options):
    _, out, errors = call("grade", "3", "--json", *arguments, **options)
    return json.loads(out)["points"] if out else errors


def test_a_table_of_recorded_answers_gets_no_points_from_others(course, tmp_path, monkeypatch):
    monkeypatch.delenv("BOTSCHOOL_GRADING_SEED", raising=False)
    text = recorded(course)
    file = submit(tmp_path / "class" / "anna", text)
    (course / "exercises" / FOLDER / FILE).write_text(text)
    assert points() == 100  # at home
    assert points("--submission", tmp_path / "class" / "anna") == 0
    assert points("--submission", "solutions", cwd=course) == 100
    assert points("--submission", "solutions", cwd=tmp_path) == 100
    # the same as grade-all's
    secret = (course / ".botschool" / "secret").read_text().strip()
    assert secret_for_others(course)[0] == secret
    _, out, _ = call("grade", "3", "--submission", file.parent)
    assert "Grading seeds follow from the secret in" in " ".join(out.split())


def test_equal_submissions_have_equal_seeds_and_others_have_others(course, monkeypatch):
    exercise = load_exercise(3, course)
    at_home = exercise.seed(1)
    exercise.work = "a digest"
    assert exercise.seed(1) == at_home  # the same each time, for a student who looks for a fault
    monkeypatch.setenv("BOTSCHOOL_GRADING_SEED", "some secret of ours")
    one = exercise.seed(1)
    assert exercise.seed(1) == one != at_home
    exercise.work = "another digest"
    assert exercise.seed(1) != one


def test_grade_cell_draws_from_the_secret_where_an_instructor_grades(
    course, tmp_path, monkeypatch, capsys
):
    monkeypatch.delenv("BOTSCHOOL_GRADING_SEED", raising=False)
    monkeypatch.chdir(tmp_path)
    cells = [{"cell_type": "code", "source": recorded(course)}]
    (tmp_path / "tiny.ipynb").write_text(json.dumps({"cells": cells}))
    assert grade_cell("3.1") == 0
    (course / "solutions").rename(course / "away")  # as in the students' copy
    assert grade_cell("3.1") == 60
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    assert grade_cell("3.1") == 0


# --- neighbours
READING = """
from pathlib import Path

def double(x):
    for path in {known!r}:
        try:
            print("LEAKED", Path(path).read_text())
        except OSError:
            continue
    import tomllib
    return Path(tomllib.__file__).read_text() and 2 * x  # what all may read can be read
"""


@pytest.fixture
def top():
    """A folder that submissions may read, as they may course/data: among the packages."""
    folder = Path(tempfile.mkdtemp(prefix="class-", dir=sys.prefix))
    yield folder
    shutil.rmtree(folder)


@pytest.mark.parametrize("inside", ["exercises", "."])
def test_a_class_in_a_readable_folder_is_closed_to_its_members(course, top, inside, monkeypatch):
    """Nor can its grades be read, nor what others have as temporary files."""
    monkeypatch.setenv("TMPDIR", str(top / "temporary"))
    (top / "temporary" / "botschool-of-another").mkdir(parents=True)
    (top / "temporary" / "botschool-of-another" / "copy.py").write_text(SECRET)
    submit(top / "class" / "bert" / inside, f"{SECRET}\n{SOLUTION}")
    (top / "grades" / "feedback").mkdir(parents=True)
    (top / "grades" / "feedback" / "old.html").write_text(SECRET)
    known = [str(path) for path in top.rglob("*") if path.is_file()]
    submit(top / "class" / "anna" / inside, READING.format(known=known))
    _, _, errors = call("grade-all", top / "class", "-o", top / "grades", "-w", "1")
    assert not errors
    page = (top / "grades" / "feedback" / "anna.html").read_text()
    page, _, _ = page.partition('<details class="work"')  # her own program follows
    assert "60 of 60" in page and "LEAKED" not in page and SECRET not in page
    shutil.rmtree(top / "grades")  # which only grade-all knows
    _, out, _ = call("grade", "3", "--submission", top / "class" / "anna" / inside)
    assert "60 of 60" in out and "LEAKED" not in out


# --- courses without trust
@pytest.fixture
def handed_in(tmp_path, monkeypatch):
    """A submission that is a whole course, with a grader of its own; nothing names it."""
    monkeypatch.delenv("BOTSCHOOL_COURSE", raising=False)
    monkeypatch.setenv("XDG_CONFIG_HOME", str(tmp_path / "config"))
    monkeypatch.setenv("HOME", str(tmp_path))
    root = make_course(tmp_path / "anna")
    grader = next(root.glob("exercises/*/test_*.py"))
    grader.write_text(f"open({str(tmp_path / 'was_here')!r}, 'w')\n{grader.read_text()}")
    return root


@pytest.mark.parametrize(
    "arguments",
    [
        ["grade", "3"], ["grade", "3", "--submission", "."], ["grade", "3.1", "--debug"],
        ["progress"], ["progress", "--grade"], ["watch", "3"], ["show", "3"], ["start", "3"],
        ["reset", "3"], ["hint", "3.1"], ["show", "3", "--answers"], ["grade-all", "solutions"],
        ["release", "../copy"], ["nbgrader", "../notebooks"],
    ],
    ids=" ".join,
)  # fmt: skip
def test_a_grader_runs_only_from_a_course_that_the_user_trusts(handed_in, tmp_path, arguments):
    code, _, errors = call(*arguments, cwd=handed_in)
    one_sentence(code, errors, f"botschool trust {handed_in}")
    assert not (tmp_path / "was_here").exists()


def test_no_program_of_a_repositorys_settings_runs(handed_in, tmp_path):
    """git runs what core.fsmonitor names, also for `git ls-files`, with which release begins."""
    shutil.rmtree(handed_in / ".git")
    subprocess.run(["git", "init", "-q", handed_in], check=True)
    hook = ["config", "core.fsmonitor", f"touch {tmp_path / 'hook_was_here'}; false"]
    subprocess.run(["git", "-C", handed_in, *hook], check=True)
    assert call("release", tmp_path / "copy", cwd=handed_in)[0] == 2
    assert not (tmp_path / "hook_was_here").exists()


def test_modules_in_the_present_folder_are_not_imported(course, tmp_path, monkeypatch):
    """As they would be by python -m botschool, which looks there first."""
    for name in ("typer", "rich", "numpy", "gymnasium", "json"):
        (tmp_path / f"{name}.py").write_text(f"open({str(tmp_path / 'was_here')!r}, 'w')\n")
    submit(tmp_path, SOLUTION)
    assert call("grade", "3", "--submission", ".", cwd=tmp_path)[0] == 0
    assert not (tmp_path / "was_here").exists()


# --- what killed processes leave
@pytest.mark.parametrize("command", ["grade-all", "grade"])
def test_the_next_grading_sweeps_what_a_killed_one_has_left(course, tmp_path, command):
    for name in ("anna", "bert"):
        submit(tmp_path / "class" / name, "def double(x):\n    while True: pass\n")
    temporary = tmp_path / "tmp"
    temporary.mkdir()
    others = temporary / "botschool-others"
    others.mkdir()
    end = {
        "grade-all": ["grade-all", tmp_path / "class", "-w", 2, "-o", tmp_path / "grades"],
        "grade": ["grade", 3, "--submission", tmp_path / "class" / "anna"],
    }[command]
    environment = environment_of_command(TMPDIR=str(temporary))

    def left():
        return [path for path in temporary.iterdir() if path != others]

    process = start(*end, env=environment)
    while not list(temporary.rglob("tiny.py")):
        assert process.poll() is None
        time.sleep(0.05)
    living = left()
    assert call("grade", "3", env=environment)[0] == 1  # beside a grading that goes on
    assert left() == living
    process.kill()
    process.communicate()
    assert left() == living
    code, _, errors = call("grade", "3", env=environment)
    assert code == 1, errors
    assert left() == [] and others.is_dir()


# --- faults of the instructor's machine
def rows(output):
    with open(output / "grades.csv", encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


@pytest.mark.parametrize(
    "fault",
    [
        OSError(errno.ENOSPC, "disk full"), OSError(errno.ENOMEM, "no memory"),
        OSError(errno.EAGAIN, "no process"), SandboxError("The child did not start."),
    ],
    ids=["disk", "memory", "process", "sandbox"],
)  # fmt: skip
def test_what_could_not_be_graded_is_an_empty_cell_and_no_part_of_an_average(
    course, tmp_path, monkeypatch, capsys, fault
):
    submit(tmp_path / "class" / "anna", SOLUTION)
    submit(tmp_path / "class" / "bert", f"# bert\n{SOLUTION}")
    (tmp_path / "class" / "carl").mkdir()
    real = batch.interpreter

    def interpreter(module, *arguments):
        if "anna" not in arguments[1]:
            return real(module, *arguments)
        error = f"OSError({fault.errno}, 'short')" if isinstance(fault, OSError) else "None"
        return [sys.executable, "-c", FAULTY.format(error=error), *arguments]

    monkeypatch.setattr(batch, "interpreter", interpreter)
    assert not grade_all_command(tmp_path / "class", tmp_path / "o", "3", 2, False)
    anna, bert, carl = rows(tmp_path / "o")
    assert [anna[key] for key in ("total", "exercise 3", "3.1", "3.2")] == [""] * 4
    assert anna["notes"] and (bert["total"], carl["total"]) == ("100", "0")
    out = " ".join(capsys.readouterr().out.split())
    assert "3 submissions, 50.0 of 100 points on average, 1 not graded and not counted." in out
    page = (tmp_path / "o" / "feedback" / "anna.html").read_text()
    assert "&ndash; <small>of 100" in page and ">0 <small>" not in page
    monkeypatch.setattr(batch, "interpreter", real)
    assert grade_all_command(tmp_path / "class", tmp_path / "o", "3", 2, False)
    assert [row["total"] for row in rows(tmp_path / "o")] == ["100", "100", "0"]


FAULTY = """
import sys
from botschool.grading.classes import batch
from botschool.sandbox import SandboxError, server, scratch

def fail(*arguments, **options):
    raise {error} or SandboxError("The child did not start.")

scratch.Scratch.__init__ = fail if {error} else scratch.Scratch.__init__
server.ForkServer.__init__ = server.ForkServer.__init__ if {error} else fail
batch.main()
"""


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_what_the_instructor_may_not_read_is_not_graded(course, tmp_path):
    file = submit(tmp_path / "class" / "anna", SOLUTION)
    file.chmod(0)
    assert call("grade-all", tmp_path / "class", "-o", tmp_path / "o")[0] == 1
    assert rows(tmp_path / "o")[0]["total"] == ""
