"""The students' copy as they hold it: every packed grader works, and no text names what is absent.

`make check-course` does the rest (tests/course/test_copy.py): solutions, mutants, pictures.
"""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
import typer

from botschool.cli.app import commands
from botschool.errors import BotschoolError
from botschool.grading.copies.release import MANIFEST, release
from botschool.grading.copies.skeleton import find_leaks
from botschool.grading.declare.exercise import exercise_numbers, load_exercise, missing_packages
from botschool.grading.declare.trust import trust
from botschool.grading.packed import is_packed, unpack_answers
from running import call, environment_of_command
from tiny_course import FILE, FOLDER, SOLUTION, make_course

ROOT = Path(__file__).parents[2]
NUMBERS = exercise_numbers(ROOT)
TEXTS = (".md", ".py", ".ini", ".yaml", "Makefile")
PLACE = re.compile(
    r"(?<![\w./~-])((?:lib|data|exercises|solutions|tests|docs|envs|tools)/[\w./-]*\w)"
)


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    if not (ROOT / "solutions").is_dir():
        pytest.skip("this is a student's copy itself")
    folder = tmp_path_factory.mktemp("released") / "copy"
    release(ROOT, folder)
    return folder


@pytest.fixture(scope="module")
def installed(tmp_path_factory):
    """A copy that uses botschool as installed: `botschool course` makes it, a wheel brings it."""
    folder = tmp_path_factory.mktemp("released") / "installed"
    release(ROOT, folder, compiled=False)
    return folder


@pytest.mark.slow
@pytest.mark.parametrize("arguments", [(), pytest.param(("--grade",), marks=pytest.mark.long)])
def test_progress_of_every_skeleton_is_nothing(copy, arguments):
    environment = environment_of_command(BOTSCHOOL_COURSE=str(copy), COLUMNS="80")
    code, out, errors = call("progress", *arguments, env=environment)
    rows = [line.split() for line in out.splitlines() if re.match(r" *\d+ +\w", line)]
    assert (code, errors) == (0, "")
    assert [int(row[0]) for row in rows[: len(NUMBERS)]] == NUMBERS
    assert f"0 of {100 * len(NUMBERS)} points" in out
    assert max(map(len, out.splitlines())) <= 80
    for number in NUMBERS:
        exercise = load_exercise(number, ROOT)
        lacks = arguments and missing_packages(exercise.extras)
        told = rf"0/{len(exercise.tasks)}  " + (
            f"Exercise {number} " if lacks else rf"{number}\.1 "
        )
        assert re.search(rf"^ *{number} .* 0 +{told}", out, re.MULTILINE), out


@pytest.mark.slow
@pytest.mark.parametrize("number", NUMBERS)
def test_packed_grader_declares_the_same_exercise(copy, number, command, monkeypatch):
    ours, packed = load_exercise(number, ROOT), load_exercise(number, copy)
    own = {"tasks": 0, "grader": 0}
    assert vars(packed) | own == vars(ours) | own
    for task, found in zip(ours.tasks, packed.tasks, strict=True):
        assert (found.id, found.title, found.max_points) == (task.id, task.title, task.max_points)
        assert [check[:2] for check in found.checks] == [check[:2] for check in task.checks]
        assert (found.picture is None) == (task.picture is None)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(copy))
    for task in ours.tasks:
        code, out, _ = command("hint", task.id)
        assert code == 0 and f"for task {task.id}, {task.title}" in out
    setup = ["sh", "tools/setup.sh", "extras", str(number)]
    done = subprocess.run(setup, cwd=copy, capture_output=True, text=True, check=True)
    assert tuple(done.stdout.split()) == ours.extras


def texts(copy):
    """path -> text of what students read: documents, the exercises' files, experiments."""
    for path in sorted(copy.rglob("*")):
        name = path.relative_to(copy).as_posix()
        source = name.startswith("lib/") and path.suffix == ".py"
        if path.name.endswith(TEXTS) and not source and not path.name.startswith("test_"):
            yield name, path.read_text(encoding="utf-8")


def absent(copy, name, text):
    """What a text names that the copy does not have: targets of make, files and folders, links."""
    targets = re.findall(r"^([\w%./-]+):", (copy / "Makefile").read_text(), re.MULTILINE)
    known = [re.compile(target.replace("%", r"\d+")) for target in targets]
    for target in re.findall(r"(?:[`']|^|PYTHON=\S+ |TORCH=\S+ )make ([a-z][\w-]*)", text, re.M):
        if re.search(rf"[`'=]\S* ?make {target}|^make {target}", text, re.MULTILINE) and not any(
            each.fullmatch(target) for each in known
        ):
            yield f"make {target}"
    for place in PLACE.findall(text):
        made = place in targets  # by make
        if not made and not (copy / place).exists() and not re.search(r"[A-Z]{3}", place):
            yield place
    if name.endswith(".md"):
        for link in re.findall(r"\]\(([^)#\s:]+)(?:#[^)]*)?\)", text):
            if not (copy / name).parent.joinpath(link).exists():
                yield link
    yield from re.findall(r"solution-ex\S*|SUBMISSION=solutions|CONTRIBUTING\S*", text)
    if name.endswith(".md"):  # a sentence may begin with the name
        parts = enumerate(text.split("```"))
        text = "```".join(
            p if i % 2 else re.sub(r"^botschool ", "", p, flags=re.M) for i, p in parts
        )
    yield from unknown_commands(text)


COMMAND = re.compile(r"(?:`|^[ #]*|'|; |or )botschool ((?:[\w./,:=+-]+|[ ](?=\S))+)", re.MULTILINE)
COMMANDS = typer.main.get_command(commands()).commands
FOR_INSTRUCTORS = {"release", "grade-all", "nbgrader", "skeletons"}


def unknown_commands(text):
    """Commands of botschool, in code and at the beginnings of lines, that it does not have."""
    for found in COMMAND.findall(text):
        name, *words = found.split()
        command = COMMANDS.get(name)
        if hasattr(command, "commands") and words and not words[0].startswith("-"):
            name, *words = words
            command = command.commands.get(name)
        if command is None or name in FOR_INSTRUCTORS:
            yield f"botschool {name}"
            continue
        options = {each for parameter in command.params for each in parameter.opts}
        options |= {each for parameter in command.params for each in parameter.secondary_opts}
        for word in words:
            if re.match(r"--?[a-z]", word) and word.partition("=")[0] not in {*options, "--help"}:
                yield f"botschool {name} {word}"


def test_no_text_names_what_the_copy_does_not_have(copy):
    found = {name: list(absent(copy, name, text)) for name, text in texts(copy)}
    assert len(found) > 60 and "exercises/README.md" in found
    assert not {name: what for name, what in found.items() if what}
    bad = "`make bench`, `make solution-ex3`, solutions/ex01_gymnasium, [x](y.md), make it\n"
    bad += "```\nbotschool walk 3\n```\n"
    bad += "`botschool es -f x.ini --quick`, `botschool rl fly`, a botschool of\n"
    assert list(absent(copy, "docs/x.md", bad)) == [
        "make bench", "make solution-ex3", "solutions/ex01_gymnasium", "y.md", "solution-ex3`,",
        "botschool walk", "botschool es --quick", "botschool fly",
    ]  # fmt: skip


def test_no_text_of_an_installed_copy_names_what_it_does_not_have(installed):
    found = {
        name: [what for what in absent(installed, name, text) if not what.startswith("lib/")]
        for name, text in texts(installed)
    }
    assert len(found) > 60 and "exercises/README.md" in found
    assert not {name: what for name, what in found.items() if what}
    names = {path.relative_to(installed).as_posix() for path in installed.rglob("*")}
    own = [name for name in names if name.startswith(("lib", "solutions"))]
    assert sorted(name for name in own if name.endswith(".py")) == [
        f"lib/walkthroughs/{name}.py"
        for name in ("crossentropy", "ppo", "ppo_picture", "regression", "shared")
    ]
    assert {"docs/replays/hopper_v0.html", "data/experiments/acrobot.ini"} <= names
    chapter = (installed / "docs" / "chapter.md").read_text()
    assert "regression.py" in chapter and "tests/" not in chapter and "| test |" not in chapter


@pytest.mark.slow
def test_what_a_wheel_gets_has_no_plain_solutions_graders_and_measures(tmp_path):
    """As tools/material.py puts it into a wheel."""
    subprocess.run([sys.executable, ROOT / "tools" / "material.py", tmp_path], check=True)
    assert not find_leaks(ROOT, (path for path in tmp_path.rglob("*") if path.is_file()))
    graders = [*tmp_path.glob("material/exercises/ex*/test_*.py")]
    measures = [*tmp_path.glob("labs/lab[0-9]*.py")]
    assert len(graders) == len(NUMBERS)
    assert len(measures) == len([*ROOT.glob("lib/botschool/labs/lab[0-9]*.py")]) > 0
    assert all(is_packed(path.read_text()) for path in (*graders, *measures))


@pytest.mark.slow
def test_answers_are_packed(tmp_path):
    """The real ones; a teacher may hold them back, and this stays so."""
    copy = tmp_path / "copy"
    release(ROOT, copy, {1, 2})
    release(ROOT, copy, {3})
    found = sorted(copy.glob("exercises/*/ANSWERS.packed"))
    assert [path.parent.name[:4] for path in found] == ["ex01", "ex02", "ex03"]
    for path in found:
        text = (ROOT / "solutions" / path.parent.name / "README.md").read_text(encoding="utf-8")
        assert unpack_answers(path.read_text(encoding="ascii")) == text
        assert not list(absent(copy, "docs/answers.md", text))
        assert not [line for line in text.splitlines() if line and line in path.read_text()]
    for options in ({"with_answers": False}, {}):
        release(ROOT, copy, {4}, **options)
        assert not list(copy.glob("exercises/*/ANSWERS.packed"))
    release(ROOT, copy, {4}, with_answers=True)
    assert len(list(copy.glob("exercises/*/ANSWERS.packed"))) == 4


# --- a copy that is brought up to date


@pytest.fixture
def course(tmp_path):
    """A small course of the exercises 3 and 4."""
    root = make_course(tmp_path / "course")
    trust(root)
    for top in ("exercises", "solutions"):
        shutil.copytree(root / top / FOLDER, root / top / "ex04_more")
    rows = "| 3 | [Tiny](ex03_tiny/README.md) |\n| 4 | [More](ex04_more/README.md) |\n"
    (root / "exercises" / "README.md").write_text(f"# Start\n\n{rows}")
    return root


def git(folder, *arguments):
    command = ["git", "-c", "user.name=x", "-c", "user.email=x@y", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True).stdout


def test_chosen_exercises_come_one_after_another(course, tmp_path):
    copy = tmp_path / "copy"
    release(course, copy, {3})
    assert [path.name for path in copy.glob("exercises/ex*")] == [FOLDER]
    assert "Tiny" in (copy / "README.md").read_text()
    assert "More" not in (copy / "README.md").read_text()
    release(course, copy, {4})
    assert sorted(path.name for path in copy.glob("exercises/ex*")) == [FOLDER, "ex04_more"]
    assert "(exercises/ex04_more/README.md)" in (copy / "README.md").read_text()
    with pytest.raises(BotschoolError, match="no exercise 7"):
        release(course, copy, {7})


@pytest.mark.skipif(not shutil.which("git"), reason="needs git")
def test_update_keeps_what_students_and_git_have(course, tmp_path):
    copy = tmp_path / "copy"
    copy.mkdir()
    git(copy, "init", "-q")
    release(course, copy)
    git(copy, "add", "-A")
    git(copy, "commit", "-qm", "released")
    mine, notes = copy / "exercises" / FOLDER / FILE, copy / "exercises" / FOLDER / "notes.txt"
    mine.write_text(SOLUTION)
    notes.write_text("mine")
    (course / "lib" / "code.py").write_text("x = 2\n")
    (course / "lib" / "new.py").write_text("y = 3\n")
    (course / "docs" / "guide.md").unlink()
    solution = course / "solutions" / FOLDER / FILE
    solution.write_text(SOLUTION.replace("Their sum.", "The sum of all."))
    done = release(course, copy)
    assert done.edited == [f"exercises/{FOLDER}/{FILE}"]
    assert mine.read_text() == SOLUTION and notes.read_text() == "mine"
    assert (copy / "lib" / "code.py").read_text() == "x = 2\n"
    assert (copy / "lib" / "new.py").is_file()
    changed = git(copy, "status", "--porcelain", "--untracked-files=all").split("\n")
    assert sorted(line[3:] for line in changed if line) == [
        MANIFEST,
        "docs/guide.md",
        f"exercises/{FOLDER}/notes.txt",
        f"exercises/{FOLDER}/test_{FILE}",
        f"exercises/{FOLDER}/{FILE}",
        "lib/code.py",
        "lib/new.py",
    ]  # fmt: skip  (the packed grader has the solution in it)
    again = release(course, copy)
    assert (again.written, again.edited) == (0, done.edited)


def test_update_writes_through_no_link(course, tmp_path):
    copy, elsewhere = tmp_path / "copy", tmp_path / "elsewhere"
    release(course, copy)
    shutil.move(copy / "lib", elsewhere)
    (copy / "lib").symlink_to(elsewhere)
    (course / "lib" / "code.py").write_text("x = 2\n")
    assert release(course, copy).edited == ["lib/code.py"]
    assert (elsewhere / "code.py").read_text() == "x = 1\n"


def test_update_removes_what_was_given_up_unless_edited(course, tmp_path):
    copy = tmp_path / "copy"
    (course / "lib" / "other.py").write_text("")
    release(course, copy)
    for name in ("code.py", "other.py"):
        (course / "lib" / name).unlink()
    (copy / "lib" / "other.py").write_text("mine")
    release(course, copy)
    assert [path.name for path in (copy / "lib").iterdir()] == ["other.py"]


def test_no_other_folder_is_taken_for_a_copy(course, tmp_path):
    other = tmp_path / "other"
    other.mkdir()
    (other / "thesis.txt").write_text("mine")
    with pytest.raises(BotschoolError, match="not empty"):
        release(course, other)
    (other / MANIFEST).write_text(json.dumps(["nothing"]))
    with pytest.raises(BotschoolError, match="damaged"):
        release(course, other)
    assert sorted(path.name for path in other.iterdir()) == [MANIFEST, "thesis.txt"]
