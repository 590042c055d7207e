"""Each exercise declares the packages that its grader and its solution import."""

import ast
import os
import re
import shutil
import subprocess
import sys
from importlib.metadata import distribution, packages_distributions
from pathlib import Path

import pytest

from botschool import _core
from botschool.grading.declare.exercise import load_exercise

tomllib = pytest.importorskip("tomllib")
ROOT = Path(__file__).parents[2]
NUMBERS = sorted(int(path.name[2:4]) for path in (ROOT / "solutions").glob("ex[0-9][0-9]_*"))
OWN = {"botschool", "balance_bot", "pip"}
"""Ours, what exercise 10 builds, and what stands in for tomllib in Python 3.10."""
BROUGHT = {
    "PIL", "imageio_ffmpeg", "pygame", "nbformat", "nbconvert", "traitlets", "IPython", "pandas",
}  # fmt: skip
"""What matplotlib, imageio[ffmpeg], gymnasium[classic-control], nbgrader and notebooks are made of,
and what a program asks for by name (pandas)."""
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def plain(requirement: str) -> str:
    return re.split(r"[^\w.-]", requirement)[0].lower().replace("_", "-")


def declared(extras: tuple[str, ...]) -> set[str]:
    """The names of the packages that the project needs with these extras."""
    lists = [PROJECT["dependencies"]]
    lists += [PROJECT["optional-dependencies"][extra] for extra in extras]
    return {plain(each) for requirements in lists for each in requirements}


def imported(path: Path) -> set[str]:
    """The top-level names that a file imports, wherever it does."""
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names |= {each.name for each in node.names}
        elif isinstance(node, ast.ImportFrom) and not node.level:
            names.add(node.module)
    return {name.split(".")[0] for name in names} - set(sys.stdlib_module_names) - OWN


def missing(names: set[str], extras: tuple[str, ...]) -> set[str]:
    distributions, have = packages_distributions(), declared(extras)
    return {
        name
        for name in names
        if not have & {plain(each) for each in distributions.get(name, [name])}
    }


@pytest.mark.parametrize("number", NUMBERS)
def test_an_exercise_declares_what_it_imports(number):
    (solution,) = (ROOT / "solutions").glob(f"ex{number:02d}_*")
    (folder,) = (ROOT / "exercises").glob(f"ex{number:02d}_*")
    names = set()
    for path in (*solution.glob("*.py"), *folder.glob("*.py")):
        names |= imported(path)
    assert not missing(names - BROUGHT, load_exercise(number, ROOT).extras)


def test_the_library_imports_only_what_the_project_declares():
    """A package that comes with another one today, as click came with typer, may not tomorrow."""
    names = {each for path in ROOT.glob("lib/botschool/**/*.py") for each in imported(path)}
    extras = tuple(PROJECT["optional-dependencies"])
    assert missing(names - BROUGHT, extras) == set()


def test_a_missing_extra_is_found():
    assert missing({"stable_baselines3", "numpy"}, ("pybullet",)) == {"stable_baselines3"}


@pytest.fixture(scope="module")
def fresh(tmp_path_factory):
    """Return a Python of an environment that holds botschool and what some extras declare."""
    made = {}

    def python(extras: tuple[str, ...]) -> Path:
        if extras not in made:
            made[extras] = environment(tmp_path_factory.mktemp("environment"), extras)
        return made[extras]

    return python


def environment(folder: Path, extras: tuple[str, ...]) -> Path:
    uv = Path(sys.executable).with_name("uv")
    if not uv.is_file():
        pytest.skip("needs uv")
    lists = [PROJECT["dependencies"]]
    lists += [PROJECT["optional-dependencies"][extra] for extra in extras]
    wanted = [each for requirements in lists for each in requirements]
    python, options = (
        folder / "bin" / "python",
        os.environ | {"UV_INDEX_STRATEGY": "unsafe-best-match"},
    )
    subprocess.run([uv, "venv", "-q", "--python", sys.executable, folder], check=True)
    command = [uv, "pip", "install", "-q", "--python", python, "-c", ROOT / "constraints.txt"]
    subprocess.run([*command, *wanted], check=True, env=options)
    ask = [python, "-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]
    packages = Path(subprocess.run(ask, check=True, capture_output=True, text=True).stdout.strip())
    shutil.copytree(ROOT / "lib" / "botschool", packages / "botschool")
    for library in Path(_core.__file__).parent.glob("*.so"):
        shutil.copy(library, packages / "botschool")
    metadata = Path(str(distribution("botschool").locate_file("")))
    for each in metadata.glob("botschool-*.dist-info"):
        shutil.copytree(each, packages / each.name)
    return python


@pytest.mark.long
@pytest.mark.parametrize("number", [*NUMBERS, "10 without PyBullet"])
def test_its_own_packages_are_enough_for_all_points(fresh, number):
    """The solution gets 100 where nothing else is installed than the exercise declares."""
    number, *less = str(number).split(maxsplit=1)
    exercise = load_exercise(int(number), ROOT)
    needed = {extra for task in exercise.tasks for extra in task.extras}  # not PyBullet
    whole = "pybullet" in exercise.extras and not less
    python = fresh(exercise.extras if whole else tuple(sorted(needed)))
    command = "from botschool.cli import main; main()"
    graded = subprocess.run(
        [python, "-I", "-c", command, "grade", number, "--submission", "solutions"],
        cwd=ROOT, capture_output=True, text=True, env=os.environ | {"BOTSCHOOL_COURSE": str(ROOT)},
    )  # fmt: skip
    assert graded.returncode == 0, graded.stdout + graded.stderr
    assert "100 of 100" in " ".join(graded.stdout.split())
