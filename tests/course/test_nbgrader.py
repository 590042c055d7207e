"""The course as notebooks in nbgrader: the same points as for scripts, whatever is handed in."""

import csv
import html
import json
import os
import re
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from copy import deepcopy
from pathlib import Path

import numpy as np
import pytest

import building
from botschool.errors import BotschoolError
from botschool.grading.copies.preprocessors import task_of
from botschool.grading.copies.release import release
from botschool.grading.copies.skeleton import find_leaks
from botschool.grading.declare.state import VARIABLE
from botschool.grading.nbgrader import make_course
from botschool.grading.notebook import grade_cell
from botschool.grading.run.cells import Unreadable, definitions, plain_python, scripts, whole
from botschool.sandbox.parts import run_parts
from direct import Direct, DirectOurs

REGION = re.compile(
    r"^( *)### BEGIN SOLUTION (task (\d+\.\d+): [^\n]+)\n(.*?)^ *### END SOLUTION\n?",
    re.MULTILINE | re.DOTALL,
)
TEST_3_1 = "test-3-1_the-initial-population"
EXIT = "def {name}(*arguments, **options):\n    import os\n\n    os._exit(0)\n"
ENDINGS = [  # of a kernel, or of whoever runs the cell
    "import os\nos._exit(0)",
    "import sys\nsys.exit(0)",
    "while True:\n    pass",
    "def grade_cell(task):\n    return 100.0\n\nimport botschool.grading.notebook\n"
    "botschool.grading.notebook.grade_cell = grade_cell",
    "%matplotlib inline\n!ls\nrank?",
    "this is no Python",
]


def partly(text: str, done) -> str:
    """A solution's text with the regions of the tasks that are not done emptied."""

    def fill(found: re.Match) -> str:
        stub = f'{found[1]}raise NotImplementedError("{found[2]}")\n'
        return found[4] if done(found[3]) else stub

    return REGION.sub(fill, text + "\n").rstrip("\n") + "\n"


def every_second(task: str) -> bool:
    return int(task.partition(".")[2]) % 2 == 1


def own_function(number: int) -> str:
    """A function that students write and that no other one of theirs calls."""
    one = building.source(number)
    names = [name for names in one.functions.values() for name in names]
    return next(name for name in names if name not in one.used_by_others)


class Course:
    """A course folder, and what is done in it."""

    def __init__(self, folder: Path, number: int = 0) -> None:
        """number: of the exercise that is graded in it, if it is only one."""
        self.folder, self.number = folder, number
        self.edited = make_course(building.ROOT, folder)

    def nbgrader(self, *arguments: str) -> str:
        done = subprocess.run(
            [sys.executable, "-m", "nbgrader", *arguments],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            start_new_session=True,
            timeout=900,
            text=True,
        )
        assert done.returncode == 0, done.stdout[-4000:]
        return done.stdout

    def notebook(self, place: str, number: int) -> dict:
        name = Path(building.source(number).file).with_suffix(".ipynb").name
        return json.loads((self.folder / place / f"ex{number:02d}" / name).read_text())

    def path(self, place: str, number: int) -> Path:
        name = Path(building.source(number).file).with_suffix(".ipynb").name
        return self.folder / place / f"ex{number:02d}" / name

    def solved(self, number: int, done) -> dict:
        """The released notebook with some tasks done."""
        answers = {cell["id"]: source(cell) for cell in self.notebook("source", number)["cells"]}
        nb = self.notebook("release", number)
        for cell in nb["cells"]:
            if cell["id"].startswith("task-"):
                cell["source"] = partly(answers[cell["id"]], done).rstrip("\n")
        return nb

    def submit(self, student: str, number: int, nb: dict | str) -> Path:
        path = self.path(f"submitted/{student}", number)
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(nb if isinstance(nb, str) else json.dumps(nb))
        return path

    def points(self, student: str, number: int) -> dict[str, float]:
        from nbgrader.api import Gradebook

        with Gradebook(f"sqlite:///{self.folder / 'gradebook.db'}") as gradebook:
            submission = gradebook.find_submission(f"ex{number:02d}", student)
            grades = [grade for notebook in submission.notebooks for grade in notebook.grades]
            assert not any(grade.needs_manual_grade for grade in grades)
            return {task_of(grade.name): grade.score for grade in grades}


def source(cell: dict) -> str:
    return "".join(cell["source"])


def code(text: str, **metadata) -> dict:
    return {
        "cell_type": "code",
        "id": f"own-{abs(hash(text))}",
        "metadata": metadata,
        "source": text,
        "outputs": [],
        "execution_count": None,
    }


def tampered(nb: dict) -> dict:
    """A notebook with cells that end its kernel, false grades, and marks that are not ours."""
    nb = deepcopy(nb)
    tests = [cell for cell in nb["cells"] if cell["id"].startswith("test-")]
    answers = [cell for cell in nb["cells"] if cell["id"].startswith("task-")]
    tests[0]["source"] = "1000.0"
    tests[0]["metadata"]["nbgrader"]["points"] = 1000
    for cell in tests[1:2]:  # a small exercise may have a single task
        cell["metadata"]["nbgrader"].update(grade_id="mine", schema_version=99)
    for cell in tests[2:3]:
        cell["metadata"] = {}
    for cell in tests[3:4]:
        nb["cells"].remove(cell)
    answers[0]["metadata"]["nbgrader"].update(grade=True, points=500, grade_id=7)
    for cell in answers[1:2]:
        cell["metadata"] = {"nbgrader": ["strange"]}
    nb["metadata"] = {"kernelspec": {"name": "bash", "display_name": "x"}, "language": 5}
    marks = {"grade": True, "grade_id": TEST_3_1, "points": 50, "solution": False}
    nb["cells"][2:2] = [code("50.0", nbgrader={**marks, "locked": True, "schema_version": 3})]
    nb["cells"][2:2] = [code(text) for text in ENDINGS]
    return nb


@pytest.fixture(scope="module")
def course(tmp_path_factory) -> Course:
    return Course(tmp_path_factory.mktemp("nbgrader"))


@pytest.fixture
def script_points(grade, tmp_path) -> Callable[[int, str], dict[str, float]]:
    """Gives the points of each task that a text gets as a file."""

    def call(number, text):
        result = grade(building.exercise(number), building.write(tmp_path, number, text))
        return {task.id: float(task.points) for task in result.tasks}

    return call


# ------------------------------------------------------------------- notebooks
def test_source_notebooks_are_whole_and_stay_the_same(course):
    import nbformat

    for number in building.GRADED:
        nb = nbformat.read(course.path("source", number), as_version=4)
        nbformat.validate(nb)
        ids = [cell.id for cell in nb.cells]
        assert len(set(ids)) == len(ids)
        marks = [cell.metadata.nbgrader for cell in nb.cells if "nbgrader" in cell.metadata]
        assert all(mark.schema_version == 3 for mark in marks)
        assert sum(mark.points for mark in marks if mark.grade) == 100
        tasks = [task.id.replace(".", "-") for task in building.exercise(number).tasks]
        named = [mark.grade_id.partition("_") for mark in marks if mark.grade]
        assert [each[0] for each in named] == [f"test-{task}" for task in tasks]
        assert all(title for *_, title in named)
    before = {number: course.path("source", number).read_bytes() for number in building.GRADED}
    assert make_course(building.ROOT, course.folder) == []
    for number, notebook in before.items():
        assert course.path("source", number).read_bytes() == notebook


def test_edited_notebooks_and_configuration_are_left_alone(tmp_path):
    made = Course(tmp_path)
    path = made.path("source", 3)
    path.write_text(path.read_text().replace("Evolution", "Revolution"))
    (tmp_path / "nbgrader_config.py").write_text("mine")
    assert make_course(building.ROOT, tmp_path) == [path]
    assert "Revolution" in path.read_text()
    assert (tmp_path / "nbgrader_config.py").read_text() == "mine"


def test_a_course_without_solutions_makes_no_notebooks(tmp_path):
    (tmp_path / "exercises").mkdir()
    with pytest.raises(BotschoolError, match="no solutions"):
        make_course(tmp_path, tmp_path / "out")


# ------------------------------------------------------------------- cells
def test_lines_of_ipython_and_of_test_cells_become_plain():
    text = "%matplotlib inline\nx = 1\n!ls\nfiles = !ls\nx?\nif x:\n    %time y = 2\n"
    plain = plain_python(text)
    assert len(plain.split("\n")) == len(text.split("\n"))
    names = {}
    exec(plain, names)
    assert names["x"] == 1 and "y" not in names
    assert plain_python("%%bash\nrm -rf /") == "# %%bash\n# rm -rf /"
    assert plain_python("%%time\nx = 2").endswith("\nx = 2")
    given = "# points\nfrom botschool.grading.notebook import grade_cell\n\ngrade_cell('3.1')"
    assert plain_python(given) == "# points\npass\n\npass"
    assert plain_python("a = (7\n  % 4)") == "a = (7\n  % 4)"


def test_definitions_keep_what_functions_use_and_nothing_that_runs():
    cells = [
        "import os; os._exit(0)\nRATE = 0.5; OTHER = os.getpid()",
        "SCALE = RATE * 2\ntable = {}\ntable['a'] = 1\nresult = [\n    os.abort(),\n]; AGAIN = 3",
        "no python at all",
        "def f(x, result=AGAIN):\n    y = 1\n    return table['a'] * SCALE * x\n\nf(os.abort())",
        "class C:\n    rate = RATE\nfor _ in range(10**9):\n    f(1)",
    ]
    script = definitions(cells)
    assert script.left_out == [[3, 1, 4, "SyntaxError: invalid syntax", []]]
    names = {}
    run_parts(script.text, "here.py", names)
    assert names["f"](3) == 3.0 and names["C"].rate == 0.5
    assert not {"OTHER", "result", "_"} & set(names)
    line = next(n for n, text in enumerate(script.text.split("\n")) if "def f" in text)
    assert script.places[line] == [4, 1]
    everything = whole(cells)
    assert everything.text.count("os.abort") == 2
    assert len(everything.places) == everything.text.count("\n")


def test_hostile_texts_end_in_a_sentence():
    deep = "(" * 100_000
    for text in (deep, "-" * 900_000 + "1", "\0", "\ud800", "x = '''"):
        with suppress(Unreadable):
            everything, _ = scripts(["def f():\n    return 1", text])
            assert everything.text.startswith("def f")
    with pytest.raises(Unreadable, match="megabyte"):
        scripts(["x = 1\n" * 300_000])


def test_grade_cell_says_what_is_missing(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(building.ROOT))
    assert grade_cell("3.1") == 0.0
    said = capsys.readouterr()
    assert "save the notebook there" in said.out and said.err == ""
    assert grade_cell("nonsense") == 0.0
    assert "is not a task" in capsys.readouterr().out


# ------------------------------------------------------------------- nbgrader
@pytest.mark.course
def test_a_hostile_notebook_gets_the_points_of_its_other_tasks(course, script_points):
    course.nbgrader("generate_assignment", "ex03", "--force")
    released = course.notebook("release", 3)
    assert "BEGIN SOLUTION" not in json.dumps(released)
    text = "\n".join(source(cell) for cell in released["cells"] if cell["cell_type"] == "code")
    for task in re.findall(r"raise NotImplementedError.*", building.source(3).skeleton):
        assert task in text
    for name, nb in (("mallory", tampered(course.solved(3, every_second))), ("oscar", "{")):
        course.submit(name, 3, nb)
    course.nbgrader("autograde", "ex03")
    expected = script_points(3, partly(building.source(3).solution, every_second))
    assert sum(expected.values()) > 0
    assert course.points("mallory", 3) == expected
    assert set(course.points("oscar", 3).values()) == {0.0}


RECORDED = """def rank(fitness):
    recorded = {table!r}
    return np.array(recorded.get(np.asarray(fitness, float).tobytes().hex(), [0]))
"""


class Recorder(Direct):
    """Our solution; keeps its ranks."""

    def __init__(self, text):
        super().__init__(text)
        self.table = {}

    def call(self, name, fitness):
        answer = super().call(name, fitness)
        self.table[np.asarray(fitness, float).tobytes().hex()] = answer.tolist()
        return answer


def recorded_ranks() -> str:
    """A cell with the answers of task 3.2 to all questions that a student at home is asked."""
    exercise, solution = building.exercise(3), building.source(3).solution
    exercise.ours, recorder = DirectOurs(solution), Recorder(solution)
    for _, _, check in exercise.find("3.2").checks:
        check(recorder)
    return RECORDED.format(table=recorder.table)


@pytest.mark.course
def test_recorded_answers_get_points_at_home_and_none_by_autograde(tmp_path, monkeypatch):
    """Autograde draws its seeds from the course's secret, however nbgrader runs the test cells."""
    monkeypatch.delenv(VARIABLE, raising=False)
    course = Course(tmp_path / "course", 3)
    course.nbgrader("generate_assignment", "ex03")
    nb = course.solved(3, lambda task: task == "3.1")
    for cell in nb["cells"]:
        if cell["id"] == "task-3-2":
            cell["source"] = recorded_ranks()
    path = course.submit("mallory", 3, nb)
    home = tmp_path / "home"  # where there are no solutions
    release(building.ROOT, home)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(home))
    monkeypatch.chdir(path.parent)
    assert grade_cell("3.2") == 10
    monkeypatch.setenv("NBGRADER_EXECUTION", "autograde")
    assert grade_cell("3.2") == 0
    monkeypatch.delenv("BOTSCHOOL_COURSE")
    monkeypatch.delenv("NBGRADER_EXECUTION")
    course.nbgrader("autograde", "ex03")
    points = course.points("mallory", 3)
    assert points["3.1"] == 15 and points["3.2"] == 0


def handed_in(folder: Path, number: int) -> Course:
    """A course in which four students have handed in an exercise, graded."""
    course, name = Course(folder, number), f"ex{number:02d}"
    course.nbgrader("generate_assignment", name)
    for student in DONE:
        nb = course.solved(number, DONE[student])
        if student == "hostile":
            nb = tampered(nb)
            nb["cells"].insert(-1, code(EXIT.format(name=own_function(number))))
        place = course.submit(student, number, nb).parent
        (place / building.source(number).file).write_text("# mine\n")
        (place / "more").mkdir()
        (place / "more" / "notes.txt").write_text("mine")
        (place / "link.txt").symlink_to(course.path("source", number))
    course.nbgrader("autograde", name)
    course.nbgrader("generate_feedback", name)
    return course


@pytest.fixture(scope="module", params=building.GRADED, ids="ex{:02d}".format)
def graded(request, tmp_path_factory) -> Course:
    """The graded course of each exercise: the tests of one come one after another."""
    return handed_in(tmp_path_factory.mktemp("course"), request.param)


@pytest.fixture(scope="module")
def third(tmp_path_factory) -> Course:
    """That of exercise 3."""
    return handed_in(tmp_path_factory.mktemp("third"), 3)


DONE = {
    "skeleton": lambda task: False,
    "solution": lambda task: True,
    "half": every_second,
    "hostile": lambda task: True,
}


@pytest.mark.course
@pytest.mark.parametrize("student", DONE)
def test_points_are_those_of_the_script(graded, script_points, student):
    number = graded.number
    text = partly(building.source(number).solution, DONE[student])
    if student == "hostile":
        text = building.inserted(text, EXIT.format(name=own_function(number)))
    expected = script_points(number, text)
    assert graded.points(student, number) == expected
    total = {"skeleton": (0, 0), "solution": (100, 100)}.get(student, (1, 99))
    assert total[0] <= sum(expected.values()) <= total[1]


@pytest.mark.course
def test_points_are_exported(third):
    third.nbgrader("export")
    with open(third.folder / "grades.csv") as file:
        rows = {row["student_id"]: row for row in csv.DictReader(file)}
    assert rows.keys() == DONE.keys()
    for student, row in rows.items():
        points = float(sum(third.points(student, 3).values()))
        assert (row["assignment"], float(row["max_score"])) == ("ex03", 100)
        assert float(row["score"]) == points


@pytest.mark.course
def test_files_stay_and_nothing_hidden_is_shown(graded, tmp_path):
    number = graded.number
    for student in DONE:
        folder = graded.folder / "autograded" / student / f"ex{number:02d}"
        assert (folder / building.source(number).file).read_text() == "# mine\n"
        assert (folder / "more" / "notes.txt").read_text() == "mine"
        assert not (folder / "link.txt").exists()
    page = graded.path("feedback/skeleton", number).with_suffix(".html").read_text()
    feedback = html.unescape(re.sub(r"<[^>]*>", "", page))
    assert "not done yet" in feedback
    released = "\n".join(source(cell) for cell in graded.notebook("release", number)["cells"])
    for text in (feedback, released):
        (tmp_path / "shown.txt").write_text(text)
        assert find_leaks(building.ROOT, [tmp_path / "shown.txt"]) == []


@pytest.mark.course
def test_released_notebooks_are_the_skeletons(graded):
    number = graded.number
    cells = graded.notebook("release", number)["cells"]
    given = [source(cell) for cell in cells if not cell["id"].startswith("test-")]
    answers = [text for text in given if "NotImplementedError(" in text]
    assert answers and all(text in building.source(number).skeleton for text in answers)


@pytest.mark.course
def test_test_cells_work_in_a_kernel(third, script_points, tmp_path, monkeypatch):
    import nbformat
    from nbclient import NotebookClient

    monkeypatch.setenv("BOTSCHOOL_COURSE", str(building.ROOT))
    number = 3
    expected = script_points(number, partly(building.source(number).solution, every_second))
    nb = third.solved(number, every_second)
    place = tmp_path / third.path("release", number).name
    place.write_text(json.dumps(nb))
    for cell in nb["cells"]:
        if cell["id"] == "task-3-2":  # not saved
            cell["source"] = "def rank(fitness):\n    return [0, 1, 2]"
    nb["cells"] = [cell for cell in nb["cells"] if "__main__" not in source(cell)]
    ran = nbformat.reads(json.dumps(nb), as_version=4)
    NotebookClient(ran, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    tests = {task_of(each.id): each.outputs for each in ran.cells if each.id.startswith("test-")}
    for task, points in expected.items():
        *streams, result = tests[task]
        assert result.data["text/plain"] == repr(points)
        assert {stream.name for stream in streams} == {"stdout"}
        said = "".join(stream.text for stream in streams)
        assert f"Task {task}." in said
        assert ("code that is not saved" in said) == (task != "3.1")


def test_the_command_says_what_to_do_next(tmp_path):
    done = subprocess.run(
        [sys.executable, "-m", "botschool", "nbgrader", str(tmp_path / "here")],
        cwd=building.ROOT,
        capture_output=True,
        text=True,
        env=os.environ | {"COLUMNS": "100"},
    )
    assert done.returncode == 0 and "generate_assignment ex03" in done.stdout
