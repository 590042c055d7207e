"""The students' copy from nothing to the picture; tests/house/test_release.py is the quick form."""

import json
import os
import shutil
import socket
import subprocess
import sys
import time
import zipfile

import psutil
import pytest

import building
from botschool.grading.classes.exporting import export
from botschool.grading.copies import starting
from botschool.grading.copies.release import release
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.report.album import captioned, captions
from botschool.grading.report.showing import show
from browser import Browser, find_browser
from test_nbgrader import every_second, own_function, partly

pytestmark = pytest.mark.course

for_each_exercise = pytest.mark.parametrize("number", building.NUMBERS, ids="ex{:02d}".format)


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    folder = tmp_path_factory.mktemp("released") / "copy"
    release(building.ROOT, folder)
    return folder


def put(copy, number, text):
    one = building.source(number)
    file = copy / "exercises" / one.folder / one.file
    file.write_text(text, encoding="utf-8")
    return file


@for_each_exercise
def test_packed_grader_gives_the_solution_everything(grade, copy, number):
    exercise = load_exercise(number, copy)
    result = grade(exercise, put(copy, number, building.source(number).solution))
    assert result.points == 100, [task for task in result.tasks if task.message]


@for_each_exercise
def test_packed_grader_finds_a_mutant(grade, copy, number):
    mutant = next(case for case in building.cases(number) if case.loses)
    file = put(copy, number, mutant.submission)
    result = grade(load_exercise(number, copy), file)
    lost = {task.id for task in result.tasks if task.points < task.max_points}
    assert lost == set(mutant.loses), [
        (task.id, task.message) for task in result.tasks if task.message
    ]


@for_each_exercise
def test_finished_file_run_by_itself_makes_its_pictures(copy, number, capfd):
    """What the README promises `botschool show N` to make is there, under results/exNN."""
    put(copy, number, building.source(number).solution)
    made = show(number, root=copy)
    assert made and all(path.is_relative_to(copy / "results" / f"ex{number:02d}") for path in made)
    images = [path for path in made if path.suffix in (".png", ".mp4", ".html")]
    assert images and all(path.stat().st_size > 1000 for path in images)
    exercise = load_exercise(number, copy)
    shown = captioned(exercise, [path for path in made if path.parent.name[:2] == "ex"], copy)
    assert shown and {each.says for each in shown} <= set(captions(number, copy).values())
    outside = set(os.listdir(copy)) - set(os.listdir(building.ROOT)) - {".release.json", "results"}
    assert not outside


@pytest.mark.skipif(not find_browser(), reason="needs a Chromium")
def test_a_file_opens_as_a_notebook(copy, tmp_path):
    """In a real JupyterLab, in a browser: as cells; nothing is written beside the file."""
    pytest.importorskip("jupyterlab")
    pytest.importorskip("jupytext")
    file = put(copy, 1, building.source(1).skeleton)
    before = sorted(file.parent.iterdir())
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = starting.notebook_command(file, copy)
    options = ["--no-browser", "--IdentityProvider.token=", f"--port={port}"]
    env = starting.notebook_variables(copy) | {"HOME": str(tmp_path)}
    with open(tmp_path / "log", "w") as log:
        process = subprocess.Popen([*command, *options], env=env, stdout=log, stderr=log)
    browser = Browser(tmp_path / "profile")
    try:
        address = f"http://127.0.0.1:{port}" + command[-1].partition("=")[2]
        deadline = time.monotonic() + 300
        while not browser.run("document.querySelectorAll('.jp-Notebook .jp-CodeCell').length"):
            assert time.monotonic() < deadline, (tmp_path / "log").read_text()
            if not browser.run("!!document.querySelector('#jupyter-config-data')"):
                browser.call("Page.navigate", url=address)
            time.sleep(1)
    finally:
        browser.close()
        for one in [*psutil.Process(process.pid).children(recursive=True), process]:
            one.kill()
        process.wait()
    assert sorted(path for path in file.parent.iterdir() if path.name[0] != ".") == before


@pytest.mark.skipif(not shutil.which("make"), reason="needs make")
def test_from_nothing_to_the_first_points(copy):
    """`make test-ex1` sets up all it needs by itself."""
    put(copy, 1, building.source(1).solution)
    variables = {name: os.environ[name] for name in os.environ if name != "BOTSCHOOL_COURSE"}
    done = subprocess.run(
        ["make", "test-ex1"],
        cwd=copy,
        env=variables | {"PYTHON": sys.executable},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    assert "100 of 100 points" in done.stdout


# --- Platforms that grade by themselves give each exercise the points that `grade` gives.


FORGED = """
def {name}(*arguments, **options):
    import os

    content = '{{"score": 100, "max-score": 100, "tests": []}}'
    for folder in (".", "..", "../..", os.environ.get("AUTOGRADER", "/autograder")):
        for name in ("results/results.json", "results.json", "result.json", "grades.json"):
            try:
                with open(os.path.join(folder, name), "w") as file:
                    file.write(content)
            except OSError:
                pass
    print(content, flush=True)
    os._exit(0)
"""
"""Writes what platforms read, wherever it may lie, and ends the process."""
RUNNER = dict.fromkeys(
    ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL", "OWNER"), "x"
)
PYTHON = {"BOTSCHOOL_PYTHON": sys.executable}  # in place of the one that a platform sets up


def text_of(kind: str, source: building.Source) -> str:
    return {
        "skeleton": source.skeleton,
        "solution": source.solution,
        "half": partly(source.solution, every_second),
        "hostile": building.inserted(
            source.solution, FORGED.format(name=own_function(source.number))
        ),
    }[kind]


@pytest.fixture(scope="module")
def exported(tmp_path_factory):
    """Gives the folder of what an exercise needs on the platforms that bring their own course."""
    top = tmp_path_factory.mktemp("exported")

    def of(number):
        folder = top / f"ex{number:02d}"
        if not folder.exists():
            for platform in ("gradescope", "classroom50"):
                export(platform, [number], str(number), folder, building.ROOT, None)
            with zipfile.ZipFile(folder / f"gradescope-ex{number:02d}.zip") as archive:
                archive.extractall(folder / "source")
        return folder

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("BOTSCHOOL_GRADING_SEED", "a secret of tests")
        yield of


def ran(*command, cwd, **variables):
    """Runs a platform's script in an environment without our course."""
    kept = {key: value for key, value in os.environ.items() if not key.startswith("BOTSCHOOL")}
    done = subprocess.run(
        list(map(str, command)),
        cwd=cwd,
        env=kept | PYTHON | variables,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr


def by_gradescope(file, number, exported, copy, tmp_path):
    folder = exported(number)
    (folder / "submission").mkdir(exist_ok=True)
    shutil.copy(file, folder / "submission" / f"{file.stem}-1.py")
    ran("bash", folder / "source" / "run_autograder", cwd=folder, AUTOGRADER=str(folder))
    result = json.loads((folder / "results" / "results.json").read_text())
    points = {test["number"]: test["score"] for test in result["tests"]}
    assert result["score"] == sum(points.values())
    return points


def by_classroom50(file, number, exported, copy, tmp_path):
    home = tmp_path / "home"
    building.write(home / "exercises", number, file.read_text())
    script = exported(number) / "autograders" / f"ex{number:02d}" / "autograder.py"
    ran(sys.executable, script, cwd=home, **RUNNER)
    result = json.loads((home / "result.json").read_text())
    return {test["test-name"].split()[0]: test["score"] for test in result["tests"]}


def by_actions(file, number, exported, copy, tmp_path):
    put(copy, number, file.read_text())
    module = "botschool.grading.classes.platforms"
    command = [sys.executable, "-m", module, "actions", number, ".", tmp_path / "grades.json"]
    ran(*command, cwd=copy, BOTSCHOOL_COURSE=str(copy))
    (result,) = json.loads((tmp_path / "grades.json").read_text())
    return {task["id"]: task["points"] for task in result["tasks"]}


KINDS = ("skeleton", "solution", "half", "hostile")
PLATFORMS = (by_gradescope, by_classroom50, by_actions)
IN_TURN = [
    pytest.param(
        number, kind, PLATFORMS[(number + place) % len(PLATFORMS)], id=f"ex{number:02d}-{kind}"
    )
    for number in building.GRADED
    for place, kind in enumerate(KINDS)
]
"""Each exercise meets each platform, and so does each kind of file."""


@pytest.mark.parametrize(("number", "kind", "platform"), IN_TURN)
def test_points_are_those_of_grade(grade, exported, copy, tmp_path, number, kind, platform):
    file = building.write(tmp_path, number, text_of(kind, building.source(number)))
    expected = {task.id: task.points for task in grade(building.exercise(number), file).tasks}
    assert platform(file, number, exported, copy, tmp_path) == expected
