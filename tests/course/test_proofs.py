"""Prove what every exercise promises: skeleton 0 points, solution 100, mutants lose what they name.

`-k "ex03 and clones"` runs one; `make check-course ONLY="ex03 and clones"` does so, too.
"""

import ast
import re

import pytest

import building
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.copies.release import release, released_files
from botschool.grading.copies.skeleton import find_leaks, pairs
from botschool.grading.declare.mistakes import THIS
from botschool.grading.judge.sentence import TOLD, line_about
from botschool.grading.report.hints import read_hints
from direct import lost

MUTANTS = building.wrong()
SECONDS = 30
"""Processor seconds of a task in this process."""
WRONG, RIGHT = 7, 3
"""Wrong and right answers to an exercise that are graded confined; all others in this process."""
NAMED = 8
"""So many mutants of an exercise, at least, get a message that names the mistake."""
STOCHASTIC = re.compile(r"\b(margin|20 seeds|twenty seeds)\b", re.IGNORECASE)
for_each_exercise = pytest.mark.parametrize("number", building.NUMBERS, ids="ex{:02d}".format)


def text_of(number, name):
    folder = building.ROOT / "exercises" / building.source(number).folder
    return (folder / name).read_text(encoding="utf-8")


@pytest.mark.course
@for_each_exercise
def test_skeleton_gets_nothing(grade, number, tmp_path):
    file = building.write(tmp_path, number, building.source(number).skeleton)
    result = grade(building.exercise(number), file)
    assert result.points == 0
    for task in result.tasks:
        assert task.message.startswith("not done yet"), task


@pytest.mark.course
@for_each_exercise
def test_solution_gets_everything(grade, number, tmp_path):
    file = building.write(tmp_path, number, building.source(number).solution)
    result = grade(building.exercise(number), file)
    assert result.points == 100, [task for task in result.tasks if task.message]
    assert not any(task.message for task in result.tasks)


@pytest.mark.course
@for_each_exercise
def test_committed_skeleton_is_the_generators(number):
    one = building.source(number)
    assert text_of(number, one.file) == one.skeleton


@pytest.mark.course
def test_every_skeleton_belongs_to_a_solution():
    made = {path for _, path in pairs(building.ROOT)}
    for folder in (building.ROOT / "exercises").glob("ex[0-9][0-9]_*"):
        files = {path for path in folder.glob("*.py") if not path.name.startswith("test_")}
        assert files - made == {folder / "pictures.py"}


@pytest.mark.course
@for_each_exercise
def test_points_and_tasks(number):
    loaded, one = building.exercise(number), building.source(number)
    assert loaded.number == number
    assert sum(task.max_points for task in loaded.tasks) == 100
    assert all(task.max_points > 0 for task in loaded.tasks)
    assert [task.id for task in loaded.tasks] == [
        f"{number}.{i + 1}" for i in range(len(loaded.tasks))
    ]
    assert set(one.functions) == {task.id for task in loaded.tasks}


@pytest.mark.course
@for_each_exercise
def test_hints_for_every_task(number):
    hints = read_hints(text_of(number, "README.md"))
    assert list(hints) == [task.id for task in building.exercise(number).tasks]
    for task, found in hints.items():
        assert 2 <= len(found) <= 4, f"task {task} has {len(found)} hints"
        assert all(len(hint) > 20 for hint in found)


@pytest.mark.course
@for_each_exercise
def test_text_names_tasks_and_times(number):
    text = text_of(number, "README.md")
    for task in building.exercise(number).tasks:
        lines = [
            line for line in text.splitlines() if re.search(rf"\b{re.escape(task.id)}\b", line)
        ]
        assert lines, f"README.md does not name task {task.id}"
        assert any(re.search(r"\d+ *min", line) for line in lines), f"no time for task {task.id}"
    assert f"`botschool grade {number}`" in text
    assert not re.search(r"\bmake (test|notebook)", text), "students type botschool, not make"
    assert "\n## To go on\n" in text and "[section 13." in text.partition("\n## To go on\n")[2]
    for alt in re.findall(r"!\[([^\]]*)\]", text):
        assert alt.count("(") == alt.count(")") and len(alt.split()) > 3, f"alt text: {alt}"
    assert f"botschool show {number}`" in text
    assert (building.ROOT / "solutions" / building.source(number).folder / "README.md").is_file()


@pytest.mark.course
@for_each_exercise
def test_margins_are_stated(number):
    """Where a threshold decides on something learnt, the grader's docstring gives the margin."""
    folder = building.ROOT / "exercises" / building.source(number).folder
    text = next(folder.glob("test_*.py")).read_text(encoding="utf-8")
    docstring = ast.get_docstring(ast.parse(text)) or ""
    if "Nothing is a matter of luck" in docstring:
        assert "stochastic" not in text.lower()
    elif re.search(r"stochastic|threshold", text, re.IGNORECASE):
        assert STOCHASTIC.search(docstring), "state the margin over 20 seeds"


@for_each_exercise
def test_there_are_mutants(number):
    own = [case for case in MUTANTS if case.number == number]
    assert len({case.submission for case in own}) == len({case.name for case in own}) == len(own)
    for case in own:  # what "the code" does, or never does
        assert re.match(r"[A-Z][a-z-]*s |Never |A colon ", case.what), case
    assert sum(case.says is not None for case in own) >= NAMED


def test_a_change_reaches_what_uses_it():
    """The function itself, and those that call it, also by another function."""
    one = building.source(8)
    assert one.reached(one.solution) == set()
    found = one.reached(building.inserted(one.solution, "def utilities(fitness): ..."))
    assert {"8.2", "8.6", "8.8"} <= found and not {"8.1", "8.7"} & found


@pytest.mark.course
@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("mutant", MUTANTS, ids=str)
def test_mutant_loses_what_it_names(here, mutant):
    """And no other quick task that it can reach, in this process."""
    if mutant.needs_a_process:
        pytest.skip("it is graded confined")
    exercise = here(mutant.number)
    long = building.long_tasks(mutant.number)
    tasks = [task for task in mutant.tasks(exercise) if task.id not in long]
    why = lost(exercise, mutant.submission, tasks, SECONDS)
    assert tuple(why) == mutant.loses, why


@pytest.mark.course
@pytest.mark.parametrize("mutant", building.confined(MUTANTS, WRONG), ids=str)
def test_mutant_is_graded_confined(grade, mutant, tmp_path):
    """It loses the same, and a message that is to name the mistake does."""
    file = building.write(tmp_path, mutant.number, mutant.submission)
    exercise = building.exercise(mutant.number)
    result = grade(exercise, file, mutant.tasks(exercise))
    lost = [task for task in result.tasks if task.points < task.max_points]
    messages = {task.id: task.message for task in result.tasks if task.message}
    assert tuple(task.id for task in lost) == mutant.loses, messages
    assert all(task.message for task in lost)
    lines = {line for text in messages.values() for line in text.splitlines() if TOLD in line}
    assert lines <= {line_about(mutant.what)}, "the sentence of another mistake is said"
    if mutant.says and not lines:
        said = f"{result.banner}\n{lost[0].message}"
        assert mutant.says != THIS, said
        assert re.search(mutant.says, said), said


@pytest.mark.course
def test_graded_apart_alike(grade, tmp_path):
    """Many at a time in processes of their own, and here: the same points and messages."""
    jobs, here = [], {}
    for number in building.GRADED[:2]:
        for name in ("skeleton", "solution"):
            file = building.write(tmp_path / name, number, getattr(building.source(number), name))
            jobs.append(Job(number, file))
            here[jobs[-1]] = grade(building.exercise(number), file).to_json()
    grades = Grades(tmp_path)
    grades._root = building.ROOT  # its exercises, but a cache of our own
    for job, result in grades.of(jobs, 2).items():
        tasks = [{**task} for task in result["tasks"]]
        for task in tasks:
            del task["printed"], task["graded"]
        assert {**here[job], "tasks": tasks} == here[job]
        assert result["points"] == here[job]["points"]


@pytest.mark.course
def test_release_tells_no_answers(tmp_path):
    release(building.ROOT, tmp_path / "copy")
    files = [path for path in (tmp_path / "copy").rglob("*") if path.is_file()]
    assert not find_leaks(building.ROOT, files)
    names = {path.relative_to(tmp_path / "copy").as_posix() for path in files}
    for needed in ("Makefile", "tools/setup.sh", "pyproject.toml", "constraints.txt", "README.md",
                   "LICENSE", "lib/CMakeLists.txt", "lib/botschool/cli/app.py"):  # fmt: skip
        assert needed in names
    assert not [name for name in names if re.search(r"solutions/|tests/|mutants|\.git/", name)]
    for number in building.NUMBERS:
        one = building.source(number)
        place = tmp_path / "copy" / "exercises" / one.folder / one.file
        assert place.read_text(encoding="utf-8") == one.skeleton


@pytest.mark.course
def test_leaks_are_found(tmp_path):
    """The whole solution, or a part of it in another file, does not get through."""
    assert released_files(building.ROOT)
    for number in building.GRADED:
        solution = building.source(number).solution
        place = tmp_path / f"{number}.py"
        place.write_text("\n".join("    " + line for line in solution.splitlines()[30:]))
        assert find_leaks(building.ROOT, [place])


# --- Prove that right answers in other styles than the solution's get all points.

ALTERNATIVES = building.right()


def redefined(text):
    """The functions and classes that a text defines."""
    kinds = (ast.FunctionDef, ast.ClassDef)
    return {node.name for node in ast.parse(text).body if isinstance(node, kinds)}


@pytest.mark.course
@pytest.mark.parametrize("number", building.GRADED, ids="ex{:02d}".format)
def test_three_that_write_everything_anew(number):
    codes = [case.code for case in ALTERNATIVES if case.number == number]
    assert len(set(codes)) >= 3
    anew = set().union(*map(redefined, codes))
    for task, names in building.source(number).functions.items():
        assert anew & set(names), f"no alternative writes {' or '.join(names)} of task {task}"


@pytest.mark.course
@pytest.mark.usefixtures("elsewhere")
@pytest.mark.parametrize("alternative", ALTERNATIVES, ids=str)
def test_alternative_gets_everything(here, alternative):
    """Of all quick tasks, in this process."""
    exercise = here(alternative.number)
    long = building.long_tasks(alternative.number)
    tasks = [task for task in exercise.tasks if task.id not in long]
    assert not lost(exercise, alternative.submission, tasks, SECONDS)


@pytest.mark.course
@pytest.mark.parametrize("alternative", building.confined(ALTERNATIVES, RIGHT), ids=str)
def test_alternative_gets_everything_confined(grade, alternative, tmp_path):
    file = building.write(tmp_path, alternative.number, alternative.submission)
    result = grade(building.exercise(alternative.number), file)
    assert result.points == 100, [(task.id, task.message) for task in result.tasks if task.message]
    assert not any(task.message for task in result.tasks)


# --- Exercise 10's solution and the package envs/balance_bot are the same environment.


PACKAGE = building.ROOT / "envs" / "balance_bot" / "balance_bot"
METHODS = ("observe", "reset", "drive", "reward", "fallen", "step", "render", "close", "__init__")


def parts_of(source, file):
    """name -> code of the methods of BalanceBotEnv and the constants, without docstrings."""
    found = {}
    for node in ast.parse(source, file).body:
        if isinstance(node, ast.Assign):
            found[node.targets[0].id] = ast.unparse(node.value)
        if isinstance(node, ast.ClassDef) and node.name == "BalanceBotEnv":
            for method in node.body:
                if isinstance(method, ast.FunctionDef):
                    has_docstring = ast.get_docstring(method) is not None
                    method.body = method.body[has_docstring:]
                    found[method.name] = ast.unparse(method)
    return found


@pytest.fixture(scope="module")
def both():
    solved = parts_of(building.source(10).solution, "the solution")
    return solved, parts_of((PACKAGE / "env.py").read_text(encoding="utf-8"), "env.py")


@pytest.mark.parametrize("name", [*METHODS, "FASTEST", "TIME_STEP", "LOWEST"])
def test_code_agrees(both, name):
    solved, packaged = both
    assert solved[name] == packaged[name]


def test_robot_agrees():
    robot = building.ROOT / "data" / "robots" / "balance_bot.urdf"
    assert robot.read_bytes() == (PACKAGE / "balance_bot.urdf").read_bytes()
