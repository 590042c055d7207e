"""Platforms that grade by themselves: what is exported gives the points that `grade` gives."""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from datetime import datetime, timezone

import pytest
import yaml

from botschool.errors import BotschoolError
from botschool.grading.classes.platforms import classroom50, graded, gradescope, markdown
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.trust import trust
from botschool.grading.nbgrader import make_course as make_nbgrader_course
from botschool.grading.notebook import NotGraded, grade_cell
from exports import notebook
from running import call, one_sentence
from tiny_course import FILE, FOLDER, SOLUTION, make_course

HOSTILE = """
import os, sys

def double(numbers):
    for name in ("results/results.json", "../results/results.json", "result.json", "grades.json"):
        try:
            with open(name, "w") as file:
                file.write('{"score": 100}')
        except OSError:
            pass
    print('{"score": 100, "tests": []}')
    os._exit(0)

def total(numbers):
    return float(sum(numbers))
"""
TEXTS = {
    "skeleton": (skeleton(SOLUTION), 0),
    "solution": (SOLUTION, 100),
    "half": (SOLUTION.replace("return twice", "return -twice"), 40),
    "hostile": (HOSTILE, 40),
}
RUNNER = {
    "CLASSROOM": "robots", "ASSIGNMENT": "ex03", "SUBMISSION_TAG": "submit/1", "OWNER": "ada",
    "COMMIT_URL": "https://x/c", "RELEASE_URL": "https://x/r", "ASSIGNMENT_TYPE": "individual",
}  # fmt: skip


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    trust(root)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def points_of_grade(course, tmp_path):
    def points(text):
        folder = tmp_path / "own"
        folder.mkdir(exist_ok=True)
        (folder / FILE).write_text(text)
        found = json.loads(call("grade", "3", "--json", "--submission", folder)[1])
        return {task["id"]: task["points"] for task in found["tasks"]}

    return points


def ran(command, cwd, **environment):
    """Runs a script as a platform does; this Python stands for the one that it installs."""
    environment = os.environ | {"BOTSCHOOL_PYTHON": sys.executable} | environment
    environment.pop("BOTSCHOOL_COURSE", None)
    done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


@pytest.mark.slow
@pytest.mark.parametrize("kind", TEXTS)
def test_points_are_those_of_grade_on_every_platform(course, tmp_path, points_of_grade, kind):
    text, total = TEXTS[kind]
    expected = points_of_grade(text)
    assert sum(expected.values()) == total
    out = tmp_path / "out"
    for platform in ("gradescope", "classroom50"):
        assert call("export", platform, "-e", "3", "-o", out)[0] == 0

    base = tmp_path / "autograder"
    (base / "submission").mkdir(parents=True)
    (base / "results").mkdir()
    (base / "submission" / f"Tiny ({total}).py").write_text(text)
    with zipfile.ZipFile(out / "gradescope-ex03.zip") as archive:
        archive.extractall(base / "source")
    code, said = ran(["bash", base / "source" / "run_autograder"], base, AUTOGRADER=str(base))
    assert code == 0, said
    result = json.loads((base / "results" / "results.json").read_text())
    assert {test["number"]: test["score"] for test in result["tests"]} == expected
    assert result["score"] == total and "Graded: Tiny" in result["output"]
    assert {test["status"] for test in result["tests"]} <= {"passed", "failed"}

    home = tmp_path / "repository"
    (home / FOLDER).mkdir(parents=True)
    (home / FOLDER / FILE).write_text(text)
    script = out / "autograders" / "ex03" / "autograder.py"
    code, said = ran([sys.executable, script], home, **RUNNER)
    assert code == 0, said
    result = json.loads((home / "result.json").read_text())
    assert {t["test-name"].split()[0]: t["score"] for t in result["tests"]} == expected
    assert (result["score"], result["max-score"]) == (total, 100)
    assert result["schema"] == "classroom50/result/v1" and result["owner"] == "ada"
    assert f"{total} of 100 points" in (home / "release-body.md").read_text()

    copy = tmp_path / "copy"  # where a student works
    assert call("release", copy)[0] == 0
    (copy / "exercises" / FOLDER / FILE).write_text(text)
    summary = tmp_path / "summary.md"
    command = [sys.executable, "-m", "botschool.grading.classes.platforms", "actions", "all", ".",
               "grades.json"]  # fmt: skip
    environment = os.environ | {"GITHUB_STEP_SUMMARY": str(summary), "BOTSCHOOL_COURSE": str(copy)}
    assert subprocess.run(command, cwd=copy, env=environment).returncode == 0
    (found,) = json.loads((copy / "grades.json").read_text())
    assert {task["id"]: task["points"] for task in found["tasks"]} == expected
    assert summary.read_text().count("## Exercise 3") == (kind != "skeleton")


@pytest.mark.slow
def test_what_is_exported(course, tmp_path):
    out = tmp_path / "out"
    code, text, _ = call("export", "gradescope", "-o", out)
    assert code == 0 and "secret" in text
    with zipfile.ZipFile(out / "gradescope-ex03.zip") as archive:
        names = set(archive.namelist())
        grader = archive.read(f"course/exercises/{FOLDER}/test_tiny.py").decode()
        modes = {i.filename: i.external_attr >> 16 & 0o777 for i in archive.infolist()}
        archive.extractall(out / "there")
    assert {"setup.sh", "run_autograder", "course/.botschool/secret"} <= names
    assert not any("solution" in name for name in names) and "numbers.sum()" not in grader
    assert (
        modes["run_autograder"] == 0o755 and (out / "gradescope-ex03.zip").stat().st_mode & 63 == 0
    )
    for script in ("setup.sh", "run_autograder"):
        assert subprocess.run(["bash", "-n", out / "there" / script]).returncode == 0
    assert call("export", "actions", "-e", "3", "-o", out)[0] == 0
    workflow = yaml.safe_load((out / ".github" / "workflows" / "botschool.yml").read_text())
    steps = workflow["jobs"]["grade"]["steps"]
    assert "actions 3 . grades.json" in steps[3]["run"] and steps[2]["run"] == "make build"
    assert steps[3]["env"]["BOTSCHOOL_GRADING_SEED"] == "${{ secrets.BOTSCHOOL_GRADING_SEED }}"
    for arguments, sentence in (
        (("gradescope",), "exists already"), (("moodle",), "is not a platform"),
        (("actions", "-e", "3.1"), "names a task"), (("gradescope", "--wheel", "x"), "--wheel x"),
    ):  # fmt: skip
        code, _, errors = call("export", *arguments, "-o", out)
        one_sentence(code, errors, sentence)


HERE, MINOR = sys.version_info[:2], sys.version_info[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tags", "words"),
    [
        (f"cp3{MINOR}-cp3{MINOR}-manylinux_2_28_x86_64", ""),
        ("cp310-abi3-linux_x86_64", ""),
        (f"cp3{MINOR + 1}-abi3-linux_x86_64", f"for Python 3.{MINOR + 1} and later: choose"),
        ("cp39-cp39-linux_aarch64", "for Python 3.9: choose"),
    ],
)
def test_a_wheel_is_installed_where_the_image_has_its_python(course, tmp_path, tags, words):
    wheel = tmp_path / f"botschool-1.0-{tags}.whl"
    wheel.write_bytes(b"wheel")
    assert call("export", "gradescope", "-o", tmp_path / "out", "--wheel", wheel)[0] == 0
    with zipfile.ZipFile(tmp_path / "out" / "gradescope-ex03.zip") as archive:
        assert archive.read(wheel.name) == b"wheel"
        archive.extract("setup.sh", tmp_path)
    setup = (tmp_path / "setup.sh").read_text()
    assert f'pip install "$base/source/{wheel.name}"' in setup and "g++" not in setup
    commands = tmp_path / "bin"  # of an image: all that setup.sh calls
    commands.mkdir()
    (commands / "python3").write_text(
        f'#!/bin/sh\n[ "$1" = -c ] && exec {sys.executable} "$@"\nmkdir -p .venv/bin\n'
        "printf '#!/bin/sh\\necho installed' >.venv/bin/python; chmod +x .venv/bin/python\n"
    )
    (commands / "apt-get").write_text("#!/bin/sh\n")
    for each in commands.iterdir():
        each.chmod(0o755)
    (tmp_path / "source" / "course").mkdir(parents=True)
    done = subprocess.run(
        ["bash", tmp_path / "setup.sh"], capture_output=True, text=True,
        env={"PATH": f"{commands}:{os.environ['PATH']}", "AUTOGRADER": str(tmp_path)},
    )  # fmt: skip
    assert (done.returncode == 0) == (not words), done.stderr
    assert words in done.stderr if words else done.stdout == "installed\n"


@pytest.mark.parametrize(
    "tags", ["py3-none-any", "cp311-cp311-win_amd64", "cp312-abi3-macosx_11_0_arm64"]
)
def test_a_wheel_for_another_system_is_refused(course, tmp_path, tags):
    wheel = tmp_path / f"botschool-1.0-{tags}.whl"
    wheel.write_bytes(b"wheel")
    code, _, errors = call("export", "gradescope", "-o", tmp_path / "out", "--wheel", wheel)
    one_sentence(code, errors, "needs a wheel of botschool for Linux")


def test_nothing_handed_in_is_zero_and_a_fault_of_the_machine_is_not(course, tmp_path, monkeypatch):
    (tmp_path / "empty").mkdir()
    result = graded(3, tmp_path / "empty")
    assert result["points"] == 0 and "There is no tiny.py" in gradescope(result, 1)["output"]
    grader = course / "exercises" / FOLDER / "test_tiny.py"
    grader.write_text(
        grader.read_text() + "\nexercise.require = lambda tasks: (_ for _ in ()).throw("
        "__import__('botschool.errors').errors.BotschoolError('no torch'))\n"
    )
    with pytest.raises(BotschoolError, match="no torch"):
        graded(3, tmp_path / "empty")
    module = "botschool.grading.classes.platforms"
    code, said = subprocess.getstatusoutput(
        f"{sys.executable} -m {module} gradescope 3 {tmp_path / 'empty'} {tmp_path / 'r.json'}"
    )
    assert code == 1 and "Not graded: no torch" in said and not (tmp_path / "r.json").exists()


@pytest.mark.slow
def test_a_notebook_finds_its_grader_where_a_student_sits(course, tmp_path, monkeypatch):
    assert make_nbgrader_course(course, tmp_path / "teaching") == []
    assert make_nbgrader_course(course, tmp_path / "teaching") == []  # nothing seems edited
    home = tmp_path / "home"
    shutil.copytree(tmp_path / "teaching" / "source" / "ex03", home)
    grader = (home / "exercises" / FOLDER / "test_tiny.py").read_text()
    assert "unpack(" in grader and "numbers.sum()" not in grader
    (home / "tiny.ipynb").write_bytes(notebook(SOLUTION))
    monkeypatch.delenv("BOTSCHOOL_COURSE")
    monkeypatch.chdir(home)
    with pytest.raises(NotGraded, match="botschool trust"):
        grade_cell("3.1")
    trust(home)
    assert grade_cell("3.1") == 60
    code, out, _ = call("hint", "3.1", cwd=home)
    assert code == 0 and "Look at *" in out
    assert (home / "exercises" / FOLDER / "README.md").is_file()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.chdir(tmp_path / "elsewhere")
    with pytest.raises(NotGraded, match="no course here"):
        grade_cell("3.1")


def test_the_contracts_of_platforms():
    result = {
        "exercise": 3, "title": "A *b*", "points": 5, "max_points": 10, "problem": "", "banner": "",
        "notes": ["<script>"], "missing": [],
        "tasks": [{"id": "3.1", "title": "T|", "points": 5, "max_points": 10, "message": "# no"}],
    }  # fmt: skip
    found = classroom50(result, RUNNER, datetime(2026, 11, 20, 12, tzinfo=timezone.utc))
    assert found["datetime"] == "2026-11-20T12:00:00Z" and found["review"] == "https://x/c"
    assert found["tests"][0]["passed"] is False
    with pytest.raises(BotschoolError, match="CLASSROOM is not set"):
        classroom50(result, {}, datetime.now(timezone.utc))
    text = markdown([result])
    assert "A \\*b\\*" in text and "    <script>" in text and "    # no" in text and "T\\|" in text
