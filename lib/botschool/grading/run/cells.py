"""Turn a notebook's code cells into a Python file, with the standard library alone.

As a program, it reads a JSON list of cell sources and writes {"whole": ..., "definitions": ...},
each a Script as a dict. It runs in a process of its own, because a hostile text may crash Python's
parser.
"""

from __future__ import annotations

import ast
import json
import re
import subprocess
import symtable
import sys
from dataclasses import dataclass, field

PARSE_SECONDS = 30
MAX_CODE = 2**20
"""Characters of code in a notebook."""
MAX_MAGICS = 100
"""IPython lines in a cell."""
_TEST = re.compile(
    r"^([ \t]*)(from botschool\.grading\.notebook import grade_cell|grade_cell\(.*\))[ \t]*$",
    re.MULTILINE,
)
_MAGIC = re.compile(r"\s*[%!?]|.*\?\s*$|[\s\w,]+=\s*[%!]")
_PYTHON_CELL = re.compile(r"%%(time|timeit|capture|prun)\b")


class Unreadable(Exception):
    """No file can be made of a notebook's cells; the message is a sentence for the learner."""


@dataclass
class Script:
    """A Python file made of cells."""

    text: str = ""
    places: list[list[int]] = field(default_factory=list)
    """For each line: the number of its code cell, and the line within the cell; both from 1."""
    left_out: list[int] = field(default_factory=list)
    """Numbers of the code cells that are not Python."""

    def add(self, number: int, text: str) -> None:
        lines = [*text.split("\n"), ""]
        self.text += "\n".join(lines) + "\n"
        self.places += [[number, line] for line in range(1, len(lines) + 1)]


def scripts(sources: list[str]) -> tuple[Script, Script]:
    """Return the whole code of a notebook, and its definitions alone.

    Raises Unreadable.
    """
    if sum(map(len, sources)) > MAX_CODE:
        raise Unreadable("The notebook holds more than a megabyte of code.")
    try:
        done = subprocess.run(
            [sys.executable, "-I", "-S", __file__],
            input=json.dumps(sources).encode(),
            capture_output=True,
            timeout=PARSE_SECONDS,
            check=True,
        )
        made = json.loads(done.stdout)
    except (subprocess.SubprocessError, ValueError):
        raise Unreadable("Python cannot read the notebook's code.") from None
    return Script(**made["whole"]), Script(**made["definitions"])


def whole(sources: list[str]) -> Script:
    """Return all code of the cells, in order."""
    script = Script()
    for number, source in enumerate(sources, 1):
        script.add(number, plain_python(source))
    return script


def definitions(sources: list[str]) -> Script:
    """Return the imports, functions and classes of the cells, and the globals that these use.

    Code that only runs (calls, loops, pictures) is left out, and so are cells that are not Python.
    """
    script = Script()
    cells: dict[int, tuple[str, list[ast.stmt]]] = {}
    for number, source in enumerate(sources, 1):
        text = plain_python(source)
        tree = _parsed(text)
        if tree is None:
            script.left_out.append(number)
        else:
            cells[number] = text, tree.body
    kept = _kept([node for _, body in cells.values() for node in body])
    for number, (text, body) in cells.items():
        script.add(number, _without(text, [node for node in body if id(node) not in kept]))
    return script


def plain_python(source: str) -> str:
    """Return a cell without lines that only IPython understands and without lines of test cells."""
    text = _TEST.sub(r"\1pass", source.replace("\r\n", "\n").replace("\r", "\n"))
    if re.match(r"\s*%%", text) and not _PYTHON_CELL.match(text.lstrip()):
        return "\n".join("# " + line for line in text.split("\n"))
    for _ in range(MAX_MAGICS):
        try:
            ast.parse(text)
            return text
        except (SyntaxError, ValueError) as error:
            lines, at = text.split("\n"), getattr(error, "lineno", None) or 0
            if not 1 <= at <= len(lines) or not _MAGIC.match(lines[at - 1]):
                return text
            line = lines[at - 1]
            indent = line[: len(line) - len(line.lstrip())]
            lines[at - 1] = f"{indent}pass  # {line.strip()}"
            text = "\n".join(lines)
    return text


def _parsed(text: str) -> ast.Module | None:
    try:
        return ast.parse(text)
    except (SyntaxError, ValueError):
        return None


def _kept(body: list[ast.stmt]) -> set[int]:
    """Return ids of the statements that define, or that bind a name which a kept statement uses."""
    always = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
    kept: set[int] = set()
    needed: set[str] = set()
    waiting = [(node, *_names(node)) for node in body]
    grows = True
    while grows:
        grows = False
        for node, bound, used in waiting:
            if id(node) not in kept and (isinstance(node, always) or bound & needed):
                kept.add(id(node))
                needed |= used
                grows = True
    return kept


def _names(node: ast.stmt) -> tuple[set[str], set[str]]:
    """Return the global names that a statement binds or changes, and the names that it uses."""
    bound, used = set(), set()
    try:
        tables = [symtable.symtable(ast.unparse(node), "<cell>", "exec")]
    except SyntaxError:
        return bound, used
    top = tables[0]
    while tables:
        table = tables.pop()
        tables += table.get_children()
        for symbol in table.get_symbols():
            if table is not top and not symbol.is_global():
                continue
            if table is top and (symbol.is_assigned() or symbol.is_imported()):
                bound.add(symbol.get_name())
            if symbol.is_referenced():
                used.add(symbol.get_name())
    if isinstance(node, (ast.Assign, ast.AugAssign)):  # table[0] = 1
        for target in node.targets if isinstance(node, ast.Assign) else [node.target]:
            while isinstance(target, (ast.Subscript, ast.Attribute)):
                target = target.value
            if isinstance(target, ast.Name):
                bound.add(target.id)
    return bound, used


def _without(text: str, dropped: list[ast.stmt]) -> str:
    """Return a cell with some top-level statements replaced by `pass`; lines keep their numbers."""
    lines = [line.encode() for line in text.split("\n")]
    for node in reversed(dropped):
        first, last = node.lineno - 1, node.end_lineno - 1
        before, after = lines[first][: node.col_offset], lines[last][node.end_col_offset :]
        if first == last:
            lines[first] = before + b"pass" + after
        else:
            lines[first : last + 1] = [before + b"pass", *[b""] * (last - first)]
            lines[last] = after.lstrip(b" \t;")
    return b"\n".join(lines).decode()


if __name__ == "__main__":
    given = json.load(sys.stdin)
    made = {"whole": vars(whole(given)), "definitions": vars(definitions(given))}
    json.dump(made, sys.stdout)
    sys.stdout.flush()
