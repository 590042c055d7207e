"""Tell whether a submission holds the expression that a slip would have made or left out."""

from __future__ import annotations

import ast
import copy
import re

EXCHANGED = " is used where "
"""Words of a slip that takes one name for another: without this name in its place it is false."""
CONDITION = "One of several conditions is left out: "
"""Words of a slip that leaves out what a condition asks for: where one asks for it, it is false."""


def quoted(what: str) -> set[str]:
    """Return the names that a sentence quotes."""
    return set(re.findall(r"`(\w+)`", what))


def pattern(node: ast.AST, names: set[str]) -> str:
    """Return an expression as text, in which all variables but these are called `_`.

    Functions keep their names.
    """
    made = copy.deepcopy(node)
    functions = {id(part.func) for part in ast.walk(made) if isinstance(part, ast.Call)}
    for part in ast.walk(made):
        if isinstance(part, ast.Name) and part.id not in names and id(part) not in functions:
            part.id = "_"
    return ast.unparse(made)


def holds(text: str, expression: str, names: set[str]) -> bool:
    """Return whether a text has an expression with this pattern; False if it is not Python."""
    try:
        parts = ast.walk(ast.parse(text))
        return any(isinstance(p, ast.expr) and pattern(p, names) == expression for p in parts)
    except (SyntaxError, ValueError, RecursionError):
        return False


def asks_for(text: str, function: str, expression: str) -> bool:
    """Return whether a condition in a function of a text asks for an expression."""
    try:
        nodes = [each for each in ast.walk(ast.parse(text)) if isinstance(each, ast.FunctionDef)]
    except (SyntaxError, ValueError, RecursionError):
        return False
    inside = [part for node in nodes if node.name == function for part in ast.walk(node)]
    tests = [each.test for each in inside if isinstance(each, (ast.If, ast.IfExp, ast.While))]
    tests += [each for each in inside if isinstance(each, ast.BoolOp)]
    return any(ast.unparse(part) == expression for test in tests for part in ast.walk(test))
