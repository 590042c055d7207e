"""Everyday slips and machines: a leftover line costs what depends on it."""

import json
import subprocess
import sys

import pytest

from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.trust import trust
from botschool.grading.judge.submission import grade
from botschool.grading.report.showing import show
from exports import notebook
from running import call, environment_of_command
from tiny_course import FILE, FOLDER, SOLUTION, make_course, submit

pytestmark = pytest.mark.slow

TYPES = "\n\ndef later(seeds: list[int]) -> dict:\n    return {}\n"


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    trust(root)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


def graded(course, tmp_path, text, **options):
    return grade(load_exercise(3, course), submit(tmp_path / "handed", text), **options)


def after_imports(line):
    return SOLUTION.replace("import numpy as np\n", f"import numpy as np\n{line}\n", 1)


@pytest.mark.parametrize(
    "line",
    [
        "import nowhere",
        "import nowhere.inner as inner, json",
        "from nowhere import (\n    first,\n    second as third)",
        "from numpy import no_such_name; import nowhere",
        "from helper_that_ends import *",
        "from nowhere import A\n\ndef other(a: A[int] | None) -> list[A]: ...",
    ],
)
def test_an_import_that_fails_costs_what_uses_it(course, tmp_path, line):
    file = submit(tmp_path / "handed", after_imports(line))
    (file.parent / "helper_that_ends.py").write_text("raise SystemExit(1)")
    result = grade(load_exercise(3, course), file)
    assert result.points == 100
    assert "cannot be loaded. Mend this first" in result.banner and ".py:" in result.banner


def test_a_task_that_uses_a_failed_import_names_it(course, tmp_path):
    text = after_imports("import nowhere as there").replace("2 * numbers", "there.two() * numbers")
    result = graded(course, tmp_path, text)
    assert [task.points for task in result.tasks] == [0, 40]
    assert "No module named 'nowhere'" in result.tasks[0].message
    assert "there.two()" in result.tasks[0].message  # the line that uses it


@pytest.mark.parametrize(
    "line, name",
    [
        ("list = [3, 1, 2]", "list"),
        ("float = 0.5", "float"),
        ("dict: object = {}", "dict"),
        ("for list in range(3):\n    pass", "list"),
        ("for number, list in enumerate('ab'):\n    pass", "list"),
        ("low, float = 1, 2", "float"),
        ("low = float = 0", "float"),
        ("if True:\n    float = 3", "float"),
        ("(float := 4)", "float"),
        ("float = 0\nfor x in [1, 2]:\n    if x > float:\n        float = x", "float"),
        ("float = float(3)\nfloat += 1\nassert float == 4", "float"),
    ],
)
def test_a_name_of_python_that_is_given_another_value_is_said_and_undone(
    course, tmp_path, line, name
):
    result = graded(course, tmp_path, after_imports(line) + TYPES)
    assert result.points == 100
    assert f"Python's name {name}" in result.banner and f"{FILE}:4" in result.banner


def test_in_a_notebook_too(course, tmp_path):
    file = tmp_path / "tiny.ipynb"
    file.write_bytes(notebook("float = 2.5\n", SOLUTION))
    result = grade(load_exercise(3, course), file)
    assert result.points == 100 and "line 1 of the cell 'float = 2.5'" in result.banner


@pytest.mark.parametrize(
    "use", ["dtype=float", "*[*map(float, [])]", "**{'dtype': float(0) or None}"]
)
def test_a_name_that_functions_hand_on_is_theirs_too(course, tmp_path, use):
    text = after_imports("float = 0.5").replace(
        "np.asarray(numbers)", f"np.asarray(numbers, {use})"
    )
    assert graded(course, tmp_path, text).points == 100


@pytest.mark.parametrize("kind, word", [("markdown", "Markdown"), ("raw", "raw")])
def test_a_function_in_a_cell_without_code_is_found(course, tmp_path, kind, word):
    document = json.loads(notebook(SOLUTION))
    document["cells"][-1]["cell_type"] = kind
    file = tmp_path / "tiny.ipynb"
    file.write_text(json.dumps(document))
    message = grade(load_exercise(3, course), file).tasks[0].message
    assert f"double cannot be read: it stands in a {word} cell: make it a code cell" in message


@pytest.mark.parametrize("kind, word", [("markdown", "Markdown"), ("raw", "raw")])
@pytest.mark.parametrize("lost", ["np", "WIDE"])
def test_an_import_or_a_constant_in_a_cell_without_code_is_found(
    course, tmp_path, kind, word, lost
):
    cells = ["import numpy as np", "WIDE = 2", SOLUTION.replace("import numpy as np", "")]
    document = json.loads(notebook(*(each.replace("2 *", "WIDE *") for each in cells)))
    at = next(
        c
        for c in document["cells"]
        if "".join(c["source"]).startswith(("import", "WIDE")) and lost in "".join(c["source"])
    )
    at["cell_type"] = kind
    file = tmp_path / "tiny.ipynb"
    file.write_text(json.dumps(document).replace(": np.ndarray", ""))
    message = grade(load_exercise(3, course), file).tasks[0].message
    assert f"{lost} cannot be read: it stands in a {word} cell" in message


@pytest.mark.parametrize(
    "code",
    [
        "from multiprocessing import Pool; Pool(2)",
        "import multiprocessing as m; m.Queue()",
        "from concurrent.futures import ProcessPoolExecutor as P; list(P(2).map(abs, [1]))",
        "import subprocess; subprocess.run(['true'])",
        "import os; os.fork()",
    ],
)
def test_a_refused_process_is_named(course, tmp_path, code):
    text = SOLUTION.replace("    numbers_of", f"    {code}\n    numbers_of", 1)
    message = graded(course, tmp_path, text).tasks[0].message
    assert "the grader lets your program start no other processes" in message


@pytest.mark.parametrize("columns", ["0", "00", ""])
@pytest.mark.parametrize("command", [("grade", "3"), ("hint", "3.1"), ("progress",), ("--help",)])
def test_a_terminal_of_no_width_shows_all(course, columns, command):
    _, out, _ = call(*command, env=environment_of_command() | {"COLUMNS": columns})
    assert len(out) > 50


@pytest.mark.parametrize("closed", [">&-", "2>&-", "<&-", ">&- 2>&- <&-"])
def test_closed_streams(course, closed):
    command = f'"{sys.executable}" -m botschool grade 3 --submission solutions {closed}'
    done = subprocess.run(
        ["sh", "-c", command], cwd=course, env=environment_of_command(), capture_output=True
    )
    assert done.returncode == 0 and b"Traceback" not in done.stderr


def test_a_home_that_cannot_be_written_names_the_way_out(tmp_path):
    surroundings = environment_of_command() | {"HOME": "/proc/1/none"}
    for name in ("BOTSCHOOL_COURSE", "XDG_CONFIG_HOME"):
        surroundings.pop(name, None)
    place = tmp_path / "my course"
    code, out, errors = call("course", str(place), "-e", "3", env=surroundings)
    way = f"export BOTSCHOOL_COURSE='{place}'"
    assert (code, errors) == (0, "") and way in out and "botschool start 3" in out
    for command in (("grade", "3.2"), ("trust", ".")):
        code, _, errors = call(*command, cwd=place, env=surroundings)
        assert code == 2 and way in errors
    named = surroundings | {"BOTSCHOOL_COURSE": str(place)}
    code, out, _ = call("grade", "3.2", cwd=place, env=named)
    assert code == 1 and "0 of 10 points" in out


@pytest.mark.parametrize("name", ["random.py", "types.py", "copy.py"])
def test_a_file_beside_the_program_hides_no_module_of_python(course, name):
    folder = course / "exercises" / FOLDER
    (folder / FILE).write_text(SOLUTION + "    import beside\n")
    (folder / "beside.py").write_text("print(1)")
    (folder / name).write_text("raise RuntimeError('not this one')")
    assert [path.name for path in show(3, root=course)] == ["picture.txt"]
