"""Exercise 10's solution and the package envs/balance_bot are the same environment."""

import ast

import pytest

import building

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
