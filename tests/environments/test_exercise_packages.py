"""Each exercise declares the packages that its grader and its solution import."""

import ast
import re
import sys
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

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


@pytest.mark.slow
@pytest.mark.parametrize("number", NUMBERS)
def test_an_exercise_declares_what_it_imports(number):
    (solution,) = (ROOT / "solutions").glob(f"ex{number:02d}_*")
    (folder,) = (ROOT / "exercises").glob(f"ex{number:02d}_*")
    names = set()
    for path in (*solution.glob("*.py"), *folder.glob("*.py")):
        names |= imported(path)
    assert not missing(names - BROUGHT, load_exercise(number, ROOT).extras)


@pytest.mark.slow
def test_the_library_imports_only_what_the_project_declares():
    """A package that comes with another one today, as click came with typer, may not tomorrow."""
    names = {each for path in ROOT.glob("lib/botschool/**/*.py") for each in imported(path)}
    extras = tuple(PROJECT["optional-dependencies"])
    assert missing(names - BROUGHT, extras) == set()


def test_a_missing_extra_is_found():
    assert missing({"stable_baselines3", "numpy"}, ("pybullet",)) == {"stable_baselines3"}
