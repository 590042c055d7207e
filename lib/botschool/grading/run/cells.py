"""Turn a notebook's code cells into a Python file, with the standard library alone.

As a program, it reads a JSON list of cell sources and writes {"whole": ..., "definitions": ...},
each a Script as a dict. It runs in a process of its own, because a hostile text may crash Python's
parser.
"""

from __future__ import annotations

import ast
import builtins
import json
import re
import subprocess
import symtable
import sys
from dataclasses import dataclass, field
from keyword import iskeyword

PARSE_SECONDS = 30
MAX_CODE = 2**20
"""Characters of code in a notebook."""
MAX_MAGICS = 100
"""IPython lines in a cell."""
MAX_JOINED = 30
"""Lines without indentation in one statement, in a cell that is not Python."""
_STATEMENT = re.compile(
    r"^(?=[^\s#)\]}])(?!(?:else|elif|except|finally)\b)"
    r"(?!(?:(?:<{7}|={7}|>{7}|\|{7}).*\n\s*?)+[ \t]+\S)",  # git's mark within a function
    re.MULTILINE,
)
_DEFINED = re.compile(r"^[ \t]*(?:async[ \t]+def|def|class)[ \t]+(\w+)", re.MULTILINE)
_TEST = re.compile(
    r"^([ \t]*)(from botschool\.grading\.notebook import grade_cell|grade_cell\(.*\))[ \t]*$",
    re.MULTILINE,
)
_MAGIC = re.compile(r"\s*[%!?]|.*\?\s*$|[\s\w,]+=\s*[%!]")
_PYTHON_CELL = re.compile(r"%%(time|timeit|capture|prun)\b")
_BUILTINS = {name for name in dir(builtins) if not iskeyword(name) and name[0] != "_"}
_NAMES = rf"(?:{'|'.join(sorted(_BUILTINS))})\b"
_GIVES_BUILTIN = re.compile(
    rf"^[ \t]*\(?(?:for +)?{_NAMES}(?! *[(\[.])"
    rf"|(?<![:|>] )\b{_NAMES} *(?::?=(?!=)|in\b)|\bas +{_NAMES}",
    re.MULTILINE,
)
NEWER = "it needs Python"
"""How a line's fault begins that a newer Python understands."""
_NONE, _FIRST, _SECOND = slice(0), slice(1), slice(1, 2)
_TAKE_FUNCTIONS = {
    "isinstance": _SECOND, "issubclass": _SECOND, "map": _FIRST, "filter": _FIRST, "astype": _FIRST
}  # fmt: skip
"""Functions and methods -> which of their arguments is a function or a type."""
_DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
_MARKER = re.compile(r"(?:<{7}|={7}|>{7}|\|{7})(?:[ \t].*)?$", re.MULTILINE)
"""A line that git writes where two versions of a file differ."""
_RUN = re.compile(r"%run[ \t]+(?:-\w[ \t]+)*(?:\./)?(\w+(?:/\w+)*?)(?:\.py)?[ \t]*$")
"""IPython's line that runs another file."""
_QUOTE_AGAIN = r"""\b[rR]?[fF][rR]?(["']).*?\{[^{}]*\1"""
_TYPES = re.compile(r"[ \t]*except\*? +[\w.]+ *(?:, *[A-Z.\w]+)+ *:")
_NEWER = (
    ((3, 12), "", re.compile(r"[ \t]*(?:async +)?(?:def|class) +\w+ *\[|[ \t]*type +\w+ *[\[=]")),
    ((3, 12), "f-string", re.compile(f".*{_QUOTE_AGAIN}")),
    ((3, 12), "f-string expression part cannot include", re.compile("")),
    ((3, 14), "multiple exception types", _TYPES),
    ((3, 14), "", re.compile(r""".*\b[rR]?[tT][rR]?["']""")),
)  # fmt: skip
"""Syntax that later versions of Python have added: version, begin of an older one's message, line.
"""


class Unreadable(Exception):
    """No file can be made of a notebook's cells; the message is a sentence for the learner."""


@dataclass
class Script:
    """A Python file made of cells."""

    text: str = ""
    places: list[list[int]] = field(default_factory=list)
    """For each line: the number of its code cell, and the line within the cell; both from 1."""
    left_out: list[list] = field(default_factory=list)
    """For each statement that is not Python: number of the cell, line in the cell, column, what
    Python says, and names of the functions and classes in it."""
    undone: list[list] = field(default_factory=list)
    """Number of the cell, line in the cell, and name: each name of Python that gets another value,
    which gets another name here, since functions use the name as Python's."""

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


def gives_builtins(text: str) -> bool:
    """Return whether a text may give a name of Python, such as `list`, another value."""
    return bool(_GIVES_BUILTIN.search(text))


def whole(sources: list[str]) -> Script:
    """Return all code of the cells, in order; values given to names of Python get other names."""
    script, cells = _read(sources)
    broken = {number for number, *_ in script.left_out}
    for number, source in enumerate(sources, 1):
        script.add(number, plain_python(source) if number in broken else cells[number][0])
    script.left_out.clear()
    return script


def definitions(sources: list[str]) -> Script:
    """Return the imports, functions and classes of the cells, and the globals that these use.

    Code that only runs (calls, loops, pictures) and statements that are not Python are left out.
    """
    script, cells = _read(sources)
    kept = _kept([node for _, body in cells.values() for node in body])
    for number, (text, body) in cells.items():
        script.add(number, _without(text, [node for node in body if id(node) not in kept]))
    return script


def _read(sources: list[str]) -> tuple[Script, dict[int, tuple[str, list[ast.stmt]]]]:
    """Return a Script without text, and (text, statements) of each cell."""
    script = Script()
    cells: dict[int, tuple[str, list[ast.stmt]]] = {}
    for number, source in enumerate(sources, 1):
        text = plain_python(source)
        if isinstance(tree := _parsed(text), SyntaxError):
            text, broken = _without_errors(text)
            script.left_out += [[number, *each] for each in broken]
            tree = ast.parse(text)
        cells[number] = text, tree.body
    everything = [node for _, body in cells.values() for node in body]
    functions = _BUILTINS | {node.name for node in everything if isinstance(node, _DEFINITIONS)}
    needed = _called(everything) & _BUILTINS
    given: set[str] = set()
    for number, (text, body) in cells.items():
        uses: list[ast.Name] = []
        for node in body:
            if isinstance(node, (*_DEFINITIONS, ast.Import, ast.ImportFrom)):
                continue
            new = (_given(node, functions) & needed) - given
            script.undone += [[number, node.lineno, name] for name in sorted(new)]
            names = [each for each in ast.walk(node) if isinstance(each, ast.Name)]
            before = set(ast.walk(_value(node) or ast.Pass()))  # has Python's values still
            uses += [e for e in names if e.id in given or (e.id in new and e not in before)]
            given |= new
        if uses:
            text = _renamed(text, uses)
            cells[number] = text, ast.parse(text).body
    return script, cells


def _given(node: ast.stmt, functions: set[str]) -> set[str]:
    """Return the names that a statement gives values; functions: the names of functions.

    Values that may be functions do not count: `sum = np.sum`, `print = partial(print, flush=True)`.
    """
    found = _stored(node) & _names(node)[0]
    for each in ast.walk(node):
        if (value := _value(each)) and not isinstance(each, ast.For):
            parts = value.elts if isinstance(value, ast.Tuple) else [value]
            if any(_may_be_function(part, functions) for part in parts):
                found -= _stored(each)
    return found


def _stored(node: ast.AST) -> set[str]:
    names = [each for each in ast.walk(node) if isinstance(each, ast.Name)]
    return {each.id for each in names if isinstance(each.ctx, ast.Store)}


def _value(node: ast.AST) -> ast.expr | None:
    """Return what a statement stores, which is computed first."""
    if isinstance(node, ast.For):
        return node.iter
    return node.value if isinstance(node, (ast.Assign, ast.AnnAssign, ast.NamedExpr)) else None


def _may_be_function(value: ast.expr, functions: set[str]) -> bool:
    """Return whether a value may be a function: one by name, or one that is made of another."""
    if isinstance(value, ast.Call):
        given = [*value.args, *(each.value for each in value.keywords)]
        names = functions & {each.id for each in given if isinstance(each, ast.Name)}
        return bool(names) or any(isinstance(each, (ast.Lambda, ast.Attribute)) for each in given)
    return isinstance(value, (ast.Lambda, ast.Name, ast.Attribute))


def _renamed(text: str, uses: list[ast.Name]) -> str:
    """Return a cell in which names of Python have other names at these places."""
    lines = [line.encode() for line in text.split("\n")]
    for use in sorted(set(uses), key=lambda use: (use.lineno, use.col_offset), reverse=True):
        line, end = lines[use.lineno - 1], use.end_col_offset or 0
        if line[use.col_offset : end] == use.id.encode():  # not so within some f-strings
            lines[use.lineno - 1] = line[:end] + b"_of_yours" + line[end:]
    return b"\n".join(lines).decode()


def _called(body: list[ast.stmt]) -> set[str]:
    """Return the names that functions and classes call or use as types."""
    found = set()
    for top in body:
        if not isinstance(top, _DEFINITIONS):
            continue
        for node in ast.walk(top):
            uses: list[ast.AST | None] = []
            if isinstance(node, ast.Call):
                name = getattr(node.func, "id", getattr(node.func, "attr", ""))
                uses = [node.func, *node.args[_TAKE_FUNCTIONS.get(name, _NONE)]]
                uses += [each.value for each in node.keywords if each.arg in ("dtype", "key")]
            elif isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
                uses = [*ast.walk(node.returns)] if node.returns else []
            elif isinstance(node, (ast.arg, ast.AnnAssign)) and node.annotation:
                uses = [*ast.walk(node.annotation)]
            found |= {use.id for use in uses if isinstance(use, ast.Name)}
    return found


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
            file = _RUN.match(line)
            runs = f"from {file[1].replace('/', '.')} import *" if file else "pass"
            lines[at - 1] = f"{indent}{runs}  # {line.strip()}"
            text = "\n".join(lines)
    return text


def _parsed(text: str) -> ast.Module | SyntaxError:
    try:
        compile(text, "<cell>", "exec", dont_inherit=True)
        return ast.parse(text)
    except SyntaxError as error:
        return error
    except ValueError as error:
        return SyntaxError(str(error))


def _without_errors(text: str) -> tuple[str, list[list]]:
    """Return a text with empty lines in place of the top-level statements that are not Python.

    Also return line, column, what Python says, and names of each of these.
    """
    pieces, line = _STATEMENT.split(text.replace("\0", "")), 0
    made, broken, cut = "", [], False
    while pieces:
        many = min(len(pieces), MAX_JOINED)
        tries = (plain_python("".join(pieces[: n + 1])) for n in range(many))
        found = next(((n, each) for n, each in enumerate(tries, 1) if _is_python(each)), None)
        taken = "".join(pieces[: found[0] if found else 1])
        names = _DEFINED.findall(taken)
        error = None if found else _parsed(taken)
        if isinstance(error, SyntaxError) and (names or not cut):  # else it belongs to that before
            broken.append(
                [line + (error.lineno or 1), error.offset or 0, _why(error, taken), names]
            )
        made, cut = made + (found[1] if found else "\n" * taken.count("\n")), not found
        line += taken.count("\n")
        del pieces[: found[0] if found else 1]
    return made, broken


def _why(error: SyntaxError, text: str) -> str:
    """Return why a text is not Python, in words."""
    lines = text.split("\n")
    line = lines[error.lineno - 1] if 0 < (error.lineno or 0) <= len(lines) else ""
    if _MARKER.match(line):
        return "git left conflict markers: keep one of the two versions, and remove the marks"
    for version, message, pattern in _NEWER:
        if sys.version_info < version and error.msg.startswith(message) and pattern.match(line):
            this = f"{sys.version_info.major}.{sys.version_info.minor}"
            return f"{NEWER} {version[0]}.{version[1]}; this is {this}"
    return f"{type(error).__name__}: {error.msg.partition(' (detected at ')[0]}"


def _is_python(text: str) -> bool:
    return isinstance(_parsed(text), ast.Module)


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


def _without(text: str, nodes: list[ast.stmt]) -> str:
    """Return a cell with `pass` in place of top-level statements; lines keep their numbers."""
    lines = [line.encode() for line in text.split("\n")]
    for node in reversed(nodes):
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
