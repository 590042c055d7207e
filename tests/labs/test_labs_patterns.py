"""Regular expressions that read what students hand in take a time that grows with its length.

Two repetitions side by side that fit the same character try every place between them, and a
repetition over line breaks after `^` starts again in each line.
"""

import ast
import re
import string
from pathlib import Path

import pytest

import botschool

try:
    from re import _parser as parser
except ImportError:  # Python 3.10
    import sre_parse as parser

HERE = Path(botschool.__file__).parent
OURS = {"policy.py", "gradebook.py", "release.py", "mistakes.py", "variations.py"}
"""Modules whose expressions read settings of a class, or our own files."""
CALLS = {
    f"re.{name}" for name in ("compile", "sub", "split", "search", "match", "fullmatch", "findall")
}
SAMPLES = string.printable + "\u00e9\u2003\0"
CATEGORIES = {"DIGIT": r"\d", "SPACE": r"\s", "WORD": r"\w"}


def expressions():
    """Return (place, expression, flags) of each constant that `re` gets in labs/ and grading/."""
    found = []
    for path in sorted([*HERE.glob("labs/*.py"), *HERE.glob("grading/**/*.py")]):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            is_re = isinstance(node, ast.Call) and ast.unparse(node.func) in CALLS
            if not is_re or path.name in OURS or not isinstance(node.args[0], ast.Constant):
                continue
            said = " ".join(map(ast.unparse, [*node.args[1:], *node.keywords]))
            flags = re.MULTILINE if re.search(r"re\.(M|MULTILINE)\b", said) else 0
            found.append((f"{path.name}:{node.lineno}", node.args[0].value, flags))
    return found


def fits(item, letter):
    """Return whether a single-character item of a parsed expression fits a letter."""
    kind, value = str(item[0]), item[1]
    if kind == "LITERAL":
        return ord(letter) == value
    if kind == "NOT_LITERAL":
        return ord(letter) != value
    if kind == "RANGE":
        return value[0] <= ord(letter) <= value[1]
    if kind == "CATEGORY":
        name = str(value).removeprefix("CATEGORY_")
        is_in = bool(re.match(CATEGORIES[name.removeprefix("NOT_")], letter))
        return is_in != name.startswith("NOT_")
    if kind == "IN":
        negated = str(value[0][0]) == "NEGATE"
        return negated != any(fits(each, letter) for each in value[negated:])
    return kind == "ANY" and letter != "\n"


def doubled(parsed, open_sets):
    """Return whether two repetitions of one character lie side by side.

    open_sets: the characters of each repetition that may go on here; changed in place.
    """
    for kind, value in parsed:
        name = str(kind)
        if name.endswith("_REPEAT"):
            least, most, inner = value
            letters = {s for s in SAMPLES if len(inner) == 1 and fits(inner[0], s)}
            if letters and most == parser.MAXREPEAT:
                if any(letters & each for each in open_sets):
                    return True
                open_sets[:] = [*open_sets, letters] if least == 0 else [letters]
            elif letters and least:
                open_sets.clear()
            elif not letters:
                before = [*open_sets]
                if doubled(inner, open_sets):
                    return True
                if least == 0:
                    open_sets += before
        elif name == "SUBPATTERN":
            if doubled(value[3], open_sets):
                return True
        elif name == "BRANCH":
            before, after = [*open_sets], []
            for branch in value[1]:
                sets = [*before]
                if doubled(branch, sets):
                    return True
                after += sets
            open_sets[:] = after
        elif name not in ("AT", "ASSERT", "ASSERT_NOT"):
            open_sets.clear()
    return False


def slow(expression, flags=0):
    text = expression if isinstance(expression, str) else expression.decode()
    crosses = flags & re.MULTILINE and re.match(r"\^(\(\?:)?\\s[*+]", text)
    return bool(crosses) or doubled(parser.parse(text), [])


@pytest.mark.parametrize(
    ("expression", "flags"),
    [
        (r"\d+\.?\d*", 0),
        (r"\[\s*([xX]?)\s*\]", 0),
        (r"answer:[ \t]*(.*)", 0),
        (r"(?:a|\w+)\d+x", 0),
        (r"^\s*(?:def|class)", re.MULTILINE),
    ],
)
def test_slow_expressions_are_found(expression, flags):
    assert slow(expression, flags)


@pytest.mark.slow
def test_no_expression_is_slow():
    found = expressions()
    assert len(found) > 50
    assert [place for place, expression, flags in found if slow(expression, flags)] == []
