"""Slips with their sentences: what these quote, and which of them are vague."""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass

_LONGEST = 40
"""Characters of a part that a sentence quotes."""
_USED = r": \S+ is used"
_QUOTED = re.compile(rf":? `[^`]*`(?: in `[^`]*`)?(?=\.$)| in `[^`]*`(?=\.$)|{_USED}(?=\.$)")
_CLEAR = ("sign", "wrong way round", "a loop", "not reversed", "counting", "matrix")
"""Words of sentences that need no quotation."""


@dataclass(frozen=True)
class Variation:
    """The text of a solution with a slip, and a sentence that names the slip."""

    what: str
    text: str
    own: bool = True
    """Whether it is our solution that has the slip, and not one in another style."""
    shown: str = ""
    """The pattern of an expression that a submission must hold, or ""; see evidence.py."""
    function: str = ""
    """The function that has the slip."""
    comparison: str = ""
    """The wrong sign of a comparison, as `>=`, or ""."""

    @property
    def vague(self) -> bool:
        return is_vague(self.what)

    @property
    def near(self) -> bool:
        """Return whether a number is a little larger or smaller, as others would be, too."""
        return "number is one" in self.what


class Quotes:
    """What sentences on a function may quote."""

    def __init__(self, public: str, own: bool) -> None:
        """Take the task's text, and whether the function is our solution's.

        Of another style, a sentence quotes only what the text itself has as a name or as a formula:
        nobody knows the rest.
        """
        self._public = set(re.findall(r"\w+", public if own else _as_names(public)))
        self._formulas = "" if own else "".join(public.split())

    def quoted(self, node: ast.AST) -> str:
        """Return a part of a solution as it stands if the task's text says all its words."""
        text = ast.unparse(node)
        words = re.findall(r"[^\W\d]\w*|\d[\w.]*", text)
        if len(text) > _LONGEST or not words or any(w not in self._public for w in words):
            return ""
        if self._formulas and _with_number(node) and "".join(text.split()) not in self._formulas:
            return ""
        return f" `{text.strip('()') if isinstance(node, ast.Tuple) else text}`"

    def about(self, test: ast.expr) -> str:
        """Return a condition, or else its longest name with a dot that the text has."""
        names = [self.quoted(each) for each in ast.walk(test) if isinstance(each, ast.Attribute)]
        longest = max(names, key=len, default="")
        return self.quoted(test) or (f" that asks for{longest}" if longest else "")


def _as_names(public: str) -> str:
    """Return the code of a text, and what its sentences quote."""
    code = re.sub(r'""".*?"""|^ *#[^\n]*', "", public, flags=re.S | re.M)
    return " ".join([code, *re.findall(r"`([^`\n]+)`", public)])


def _with_number(node: ast.AST) -> bool:
    """Return whether a part computes something with a number."""
    parts = [each for each in ast.walk(node) if isinstance(each, ast.BinOp)]
    return any(isinstance(each, ast.Constant) for part in parts for each in ast.walk(part))


def colon(quoted: str) -> str:
    return f":{quoted}" if quoted else ""


def in_(quoted: str) -> str:
    return f" in{quoted}" if quoted else ""


def placed(place: str, what: str) -> str:
    """Return a sentence that says first where a slip is; place: what is made there, or ""."""
    return f"In {place}: {what[0].lower()}{what[1:]}" if place else what


def used(number: float) -> str:
    """Return the end of a sentence that shows the wrong number."""
    return f": {number:.10g} is used"


def without_quotes(what: str) -> str:
    """Return a sentence without its end, which differs where a slip is made in several places."""
    return _QUOTED.sub("", what)


def is_vague(what: str) -> bool:
    """Return whether a sentence names neither a place nor a clear mistake."""
    what = re.sub(_USED, "", what)
    named = "`" in what or bool(re.search(r"\d", what))
    return not named and not any(clear in what.lower() for clear in _CLEAR)


def holds_everywhere(what: str) -> bool:
    """Return whether somebody who makes a slip may make it in all places, and understand this.

    Signs that are reversed in several places may have the effect of any other mistake.
    """
    return not is_vague(what) and "sign" not in what
