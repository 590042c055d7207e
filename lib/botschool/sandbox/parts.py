"""Load an untrusted file statement by statement: one that fails costs only what uses its names."""

from __future__ import annotations
import __future__

import ast
import traceback
from collections.abc import Iterator
from typing import Any

LEFT_OUT = "__left_out__"
"""The name in the module of [name, line, what was raised] of each name that has no value."""
DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
IMPORTS = (ast.Import, ast.ImportFrom)
MAX_TEXT = 200


def run_parts(text: str, path: str, names: dict[str, Any]) -> None:
    """Run a file's statements one after the other in a module's names.

    A statement that fails is left out: the names that it would bind have no value. Annotations
    are not evaluated. Raises SyntaxError.
    """
    left_out: dict[str, list] = {}
    names[LEFT_OUT] = []
    for node in ast.parse(text, path).body:
        part = ast.Module([node], type_ignores=[])
        flags = __future__.annotations.compiler_flag
        try:
            exec(compile(part, path, "exec", flags, dont_inherit=True), names)
        except BaseException as error:
            unknown = error.name if isinstance(error, NameError) else ""
            about = left_out.get(unknown) or [_line(error, path) or node.lineno, _said(error)]
            for name in bound(node):
                if isinstance(node, (*DEFINITIONS, *IMPORTS)):
                    names.pop(name, None)
                if name not in names:
                    left_out[name] = about
    names[LEFT_OUT] = [[name, *about] for name, about in left_out.items() if name not in names]


def bound(node: ast.AST) -> Iterator[str]:
    """Yield the names that a top-level statement binds."""
    if isinstance(node, DEFINITIONS):
        yield node.name
        return
    if isinstance(node, ast.alias):
        yield node.asname or node.name.partition(".")[0]
    elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
        yield node.id
    for child in ast.iter_child_nodes(node):
        yield from bound(child)


def _line(error: BaseException, path: str) -> int:
    """Return the innermost line of the file where an error was raised; 0 if there is none."""
    trace = traceback.walk_tb(error.__traceback__)
    lines = [line for frame, line in trace if frame.f_code.co_filename == path]
    return lines[-1] if lines else 0


def _said(error: BaseException) -> str:
    try:
        return f"{type(error).__name__}: {error}"[:MAX_TEXT].rstrip(": ")
    except BaseException:  # its text is code of the file, too
        return type(error).__name__
