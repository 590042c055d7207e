"""Extract the parts of a solution that replace a submission's failing functions.

A task that declares needs=("3.2",) calls functions of task 3.2. If both fail, the task is graded
again with our 3.2 in place of the learner's: one mistake costs points once.

A hostile submission gains little. In this one attempt its process holds only our functions of the
needed tasks; `pruned` leaves out the graded task's functions. The submission may call or read them
to earn the points of this task, which is the purpose. It cannot carry them to another task: every
attempt has a confined process and folder of its own that are thrown away, and nothing that this
attempt returns, prints, draws or raises is shown.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Iterable

_REGION = re.compile(r"### BEGIN SOLUTION task (\d+\.\d+)")
_FUNCTIONS = (ast.FunctionDef, ast.ClassDef)


def functions_of(solution: str) -> dict[str, list[str]]:
    """Return task -> the functions and classes that belong to it alone.

    Of a class that belongs to several tasks, it is the methods: "Robot.reset".
    """
    names: dict[str, list[str]] = {}
    lines = solution.split("\n")
    for node in ast.parse(solution).body:
        tasks = _tasks(lines, node)
        if len(tasks) == 1:
            names.setdefault(tasks.pop(), []).append(node.name)
        elif isinstance(node, ast.ClassDef):
            for method in node.body:
                if len(tasks := _tasks(lines, method)) == 1:
                    names.setdefault(tasks.pop(), []).append(f"{node.name}.{method.name}")
    return names


def pruned(solution: str, tasks: Iterable[str]) -> str:
    """Return the functions of these tasks as a Python file, with all they use of the solution.

    Functions of other tasks are left out.
    """
    tasks, lines, functions = set(tasks), solution.split("\n"), functions_of(solution)
    nodes = list[ast.stmt]()
    for node in ast.parse(solution).body:
        if isinstance(node, ast.ClassDef) and not _tasks(lines, node) <= tasks:
            node.body = [part for part in node.body if set() < _tasks(lines, part) <= tasks]
            if node.body:
                nodes.append(node)
        elif not isinstance(node, ast.If) and _tasks(lines, node) <= tasks:
            nodes.append(node)
    wanted = {name.partition(".")[0] for task in tasks for name in functions.get(task, ())}
    if not wanted:
        return ""
    kept: list[ast.stmt] = []
    while new := [node for node in nodes if node not in kept and _bound(node) & wanted]:
        kept += new
        wanted |= {name for node in new for name in _used(node)}
    kept += [n for n in nodes if isinstance(n, ast.Expr) and _used(n) and _used(n) <= wanted]
    return "\n\n\n".join(_text(lines, node) for node in nodes if node in kept) + "\n"


def _text(lines: list[str], node: ast.stmt) -> str:
    """Return a statement's text, of a class that of the methods left in it."""
    if not isinstance(node, ast.ClassDef):
        return "\n".join(lines[node.lineno - 1 : node.end_lineno])
    bases = ", ".join(map(ast.unparse, node.bases))
    parts = ["\n".join(lines[part.lineno - 1 : part.end_lineno]) for part in node.body]
    return "\n\n".join([f"class {node.name}({bases}):", *parts])


def _tasks(lines: list[str], node: ast.stmt) -> set[str]:
    """Return the tasks for which a function or class is written."""
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
