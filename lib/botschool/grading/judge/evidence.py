"""Tell whether a submission may have a slip, by its text."""

from __future__ import annotations

import ast
import copy
import re
from difflib import SequenceMatcher

from botschool.grading.judge.sentences import Variation

EXCHANGED = " is used where "
"""Words of a slip that takes one name for another: without this name in its place it is false."""
CONDITION = "One of several conditions is left out: "
"""Words of a slip that leaves out what a condition asks for: where one asks for it, it is false."""
LIKE = 0.8
"""Likeness, from 0 to 1, of functions that count as written in the same way."""
ONLY_IF_ALIKE = re.compile("each pass|pass of a loop|Two steps are done")
"""Words of slips that only those recognise whose function is written in the same way."""
ARGUMENTS = re.compile(r"wo arguments of `(?:\w+\.)*(\w+)` are exchanged")
"""Words of a slip in a call: where nobody calls this, it is false."""
LEFT_OUT = re.compile(r"A step is left out: `([^`]*\W[^`]*)`")
"""Words of a slip that leaves out an assignment to a part: where there is one, it is false."""


def may_be_true(slip: Variation, text: str) -> bool:
    """Return whether the sentence of a slip may be true of a submission's text."""
    _, is_condition, condition = slip.what.partition(CONDITION)
    if is_condition and asks_for(text, slip.function, condition.strip("`.")):
        return False
    if (step := LEFT_OUT.search(slip.what)) and assigns(text, step[1]):
        return False
    if slip.comparison and not _may_compare(text, slip):
        return False
    if (call := ARGUMENTS.search(slip.what)) and not slip.own and call[1] not in text:
        return False
    only_if_alike = slip.vague or ONLY_IF_ALIKE.search(slip.what)
    if only_if_alike and not written_alike(text, slip.text, slip.function):
        return False
    return not slip.shown or holds(text, slip.shown, quoted(slip.what))


def _may_compare(text: str, slip: Variation) -> bool:
    """Return whether a function has a slip's wrong sign, either way round, or no comparison."""
    signs = set(
        re.findall(r"[<>]=?|[!=]=", " ".join(words_of(text, slip.function)).replace(" ", ""))
    )
    turned = slip.comparison.translate(str.maketrans("<>", "><"))
    return not signs or bool(signs & {slip.comparison, turned})


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


def written_alike(text: str, other: str, function: str) -> bool:
    """Return whether two texts have a function of this name that is written in the same way."""
    one, another = words_of(text, function), words_of(other, function)
    matcher: SequenceMatcher[str] = SequenceMatcher(a=one, b=another, autojunk=False)
    return bool(one) and matcher.ratio() >= LIKE


def words_of(text: str, function: str) -> list[str]:
    """Return the words of a function's body and what stands between them; [] without it."""
    try:
        nodes = [each for each in ast.walk(ast.parse(text)) if isinstance(each, ast.FunctionDef)]
    except (SyntaxError, ValueError, RecursionError):
        return []
    bodies = [node.body for node in nodes if node.name == function]
    return re.findall(r"\w+|\W", "\n".join(map(ast.unparse, bodies[-1]))) if bodies else []


def assigns(text: str, target: str) -> bool:
    """Return whether a text assigns something to this very expression."""
    try:
        nodes = [n for n in ast.walk(ast.parse(text)) if isinstance(n, (ast.Assign, ast.AugAssign))]
    except (SyntaxError, ValueError, RecursionError):
        return False
    targets = [t for n in nodes for t in (n.targets if isinstance(n, ast.Assign) else [n.target])]
    return any(ast.unparse(each) == target for each in targets)


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
