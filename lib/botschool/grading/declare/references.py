"""The parts of a solution that stand in for a submission's functions which do not pass yet.

A task that declares needs=("3.2",) calls functions of task 3.2. When it fails and 3.2 has failed,
too, it is graded again with our 3.2 in the place of the learner's: one mistake costs once.

What a hostile submission gains by that: in this one attempt its process holds our functions of the
tasks needed and of no others; those of the task that is graded are left out by `pruned`. It may
call or read them, for the points of this task, which is the meaning. It cannot carry them to
another task: every attempt has a process and a folder of its own, both confined and thrown away,
and nothing that is printed, drawn or said in exceptions during this attempt is shown.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable

_REGION = re.compile(r"### BEGIN SOLUTION task (\d+\.\d+)")
_FUNCTIONS = (ast.FunctionDef, ast.ClassDef)


def functions_of(solution: str) -> dict[str, list[str]]:
    """task -> the functions and classes that belong to it alone."""
    found: dict[str, list[str]] = {}
    lines = solution.split("\n")
    for node in ast.parse(solution).body:
        if isinstance(node, _FUNCTIONS):
            tasks = _tasks(lines, node)
            if len(tasks) == 1:
                found.setdefault(tasks.pop(), []).append(node.name)
    return found


def pruned(solution: str, tasks: Iterable[str]) -> str:
    """The functions of these tasks as a Python file, with all they use of the solution's file.

    Functions of other tasks are left out in any case.
    """
    tasks, lines, functions = set(tasks), solution.split("\n"), functions_of(solution)
    nodes = [
        node
        for node in ast.parse(solution).body
        if not isinstance(node, ast.If) and _tasks(lines, node) <= tasks
    ]
    wanted = {name for task in tasks for name in functions.get(task, ())}
    if not wanted:
        return ""
    kept: list[ast.stmt] = []
    while new := [node for node in nodes if node not in kept and _bound(node) & wanted]:
        kept += new
        wanted |= {name for node in new for name in _used(node)}
    kept += [n for n in nodes if isinstance(n, ast.Expr) and _used(n) and _used(n) <= wanted]
    texts = [ast.get_source_segment(solution, node) for node in nodes if node in kept]
    return "\n\n\n".join(text for text in texts if text) + "\n"


def _tasks(lines: list[str], node: ast.stmt) -> set[str]:
    """Those that a function or class is written for."""
    if not isinstance(node, _FUNCTIONS):
        return set()
    return set(_REGION.findall("\n".join(lines[node.lineno - 1 : node.end_lineno])))


def _bound(node: ast.stmt) -> set[str]:
    if isinstance(node, _FUNCTIONS):
        return {node.name}
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        return {(name.asname or name.name).partition(".")[0] for name in node.names}
    if isinstance(node, (ast.Assign, ast.AnnAssign)):
        return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)
                and isinstance(each.ctx, ast.Store)}  # fmt: skip
    return set()


def _used(node: ast.stmt) -> set[str]:
    return {each.id for each in ast.walk(node) if isinstance(each, ast.Name)
            and isinstance(each.ctx, ast.Load)}  # fmt: skip
