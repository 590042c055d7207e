"""A submission's process has the modules of botschool that its exercise uses, and no others."""

import pytest

from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.libraries import Refused
from botschool.grading.declare.modules import closed_files, imported, may_use, needed
from botschool.grading.run.student import Student
from botschool.sandbox.paths import IMPORT_ROOT

SOLUTION = '''"""A solution; botschool.arena says more."""
from botschool import config
from botschool.course import (
    Robot,
    film,
)

if __name__ == "__main__":
    from botschool.net import Network
'''
GRADER = """
from botschool.grading import same
from botschool.grading.run.worlds import made_up
def driver(module):
    from botschool.rl.native import PPO
"""


def test_what_a_solution_and_a_graders_drivers_import_may_be_used():
    assert may_use(SOLUTION, GRADER) == {
        "botschool.arena",
        "botschool.config",
        "botschool.course",
        "botschool.grading.run.worlds",
        "botschool.rl.native",
    }


@pytest.mark.slow
@pytest.mark.parametrize("number", [2, 8, 12])
def test_each_module_is_open_or_closed(number):
    opened = needed(load_exercise(number).tasks[0].refused.may_use)
    closed = closed_files(opened)
    root = (IMPORT_ROOT / "botschool").resolve()
    for file in root.rglob("*.py"):
        name = ".".join(file.relative_to(root.parent).with_suffix("").parts)
        name = name.removesuffix(".__init__")
        shut = any(file.is_relative_to(place) for place in closed)
        assert shut != (name in opened or name.startswith("botschool.sandbox")), name


def test_what_an_open_module_imports_is_open():
    opened = needed(frozenset({"botschool.course"}))
    for name in opened:
        file = IMPORT_ROOT.joinpath(*name.split(".")).with_suffix(".py")
        assert not file.is_file() or imported(file.read_text()) <= opened


WAYS = {
    "a module": "import botschool.npy as it\ndef way(): it.load()",
    "a name of the package": "import botschool\ndef way(): botschool.problem('cartpole')",
    "by its name": "import importlib as i\ndef way(): i.import_module('botschool._core').f()",
}


@pytest.mark.slow
@pytest.mark.parametrize("way", WAYS)
def test_other_modules_do_not_exist(server, tmp_path, way):
    file = tmp_path / "own" / "tiny.py"
    file.parent.mkdir()
    file.write_text(WAYS[way])

    def answer(module):
        try:
            module.way()
        except RuntimeError as error:
            return str(error)

    student = Student(file, server=server, refused=Refused(may_use=frozenset()))
    try:
        assert student.run(answer).startswith("write it yourself: botschool.")
    finally:
        student.close()
