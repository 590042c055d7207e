"""Explain errors in a submission's code in sentences, with the learner's own lines."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare.checks import NotDone, Wrong, plain
from botschool.grading.run.confined import submission_files
from botschool.sandbox.inside import read_inside

Place = Callable[[int], str]
"""Return words for the learner for a line of the file."""
_RUNS = re.compile(r"(?:pass)?\s*(?:#\s*)?%run\b")
MAX_LINE = 100
"""Characters to show of a line."""
MAX_FILE = 2**20
"""Characters of a file whose lines may be shown."""
MAX_CALLS = 3
"""Calls to show above the place where the program was."""
NO_PROCESSES = (
    "the grader lets your program start no other processes: use num_workers=0, no Pool and no "
    "AsyncVectorEnv"
)
NO_FILMS = 'the grader writes no films: put this below `if __name__ == "__main__":`'
_NO_NUMBERS = {
    "Tensor": "a tensor: .detach().numpy() or .item() gives its numbers",
    "Parameter": "a tensor: .detach().numpy() or .item() gives its numbers",
    "function": "a function itself: parentheses call it",
    "builtin_function_or_method": "a function itself: parentheses call it",
    "method": "a method itself: parentheses call it",
    "generator": "a generator: list(...) makes a list of it",
    "map": "a map: list(...) makes a list of it",
    "zip": "a zip: list(...) makes a list of it",
    "range": "a range: list(...) makes a list of it",
    "filter": "a filter: list(...) makes a list of it",
    "dict_keys": "the keys of a dict: list(...) makes a list of them",
    "dict_values": "the values of a dict: list(...) makes a list of them",
    "set": "a set, which has no order: make a list",
    "ellipsis": "the three dots: write your own code in their place",
}


@dataclass(frozen=True)
class Origin:
    """The origin of a file that was assembled from parts of another file."""

    place: Place | None = None
    """Line of the file -> words for its place; None: use the file's name and the line's number."""
    lost: dict[str, str] = field(default_factory=dict)
    """Name in a part that is not read, mostly of a function -> why."""
    in_parts: bool = False
    """Whether a statement that fails costs only what uses its names."""


_ADVICE = (
    (
        r"matmul: |shapes .* not aligned|mat1 and mat2 shapes",
        "The last axis of the left array must be as long as the second-to-last axis of the right "
        "one: print .shape of both.",
    ),
    (
        r"could not be broadcast|could not broadcast|must match the size of tensor",
        "Arrays of these shapes cannot be combined number by number: print .shape of both.",
    ),
    (
        r"No such file or directory(?s:.*)mkdir\(",
        "mkdir makes only the last folder of a path; with parents=True those above it, too.",
    ),
    (r"'NoneType'", "Something is None here: print each part of the line."),
    (
        r"values to unpack(?s:.*)\.(reset|step)\(",
        "In Gymnasium reset returns (observation, info), and step returns (observation, reward, "
        "terminated, truncated, info).",
    ),
    (
        r"values to unpack",
        "What stands on the right side of this line has another length than the names on the left "
        "side: print it. An array of shape (n, m) is unpacked along its first axis.",
    ),
    (
        r"for .*: 'list' and|bad operand type for unary .*'list'|multiply sequence by non-int",
        "A list is not an array: np.array(...) makes an array for calculations.",
    ),
    (
        r"'float' object cannot be interpreted|(indices must be|expected a sequence of) integers",
        "A whole number is needed here: use // for /, or int(...).",
    ),
    (
        r"does not require grad|on Tensor that requires grad|on a Tensor that requires grad",
        "torch cannot follow through NumPy, .item() or .detach(): compute the loss with torch, and "
        "take numbers out of it only afterwards.",
    ),
    (
        r"setting an array element with a sequence|inhomogeneous shape",
        "The parts of an array must have the same length: print the length of each.",
    ),
)
"""Patterns of exceptions' messages and lines -> what they usually mean to a beginner."""


class SourceLines:
    """The lines of a submission's files, as handed in."""

    def __init__(self, file: Path, origin: Origin) -> None:
        self._file, self._place, self.lost = file, origin.place, origin.lost
        self._texts: dict[str, list[str]] = {}

    def at(self, name: str, line: int) -> tuple[str, str]:
        """Return (the place in words, the text) of a line of a file in the submission's folder."""
        name = plain(name)[:80]
        own = name == self._file.name and self._place is not None
        where = self._place(line) if own else f"{name}:{line}"
        lines = self.lines(name)
        text = lines[line - 1] if 0 < line <= len(lines) else ""
        return where, plain(text.expandtabs(4))

    def shown(self, name: Any, line: Any) -> str:
        """Return a line to put below a sentence; "" if there is none."""
        if not isinstance(name, str) or type(line) is not int:
            return ""
        where, text = self.at(name, line)
        return f"\n  {where}: {text.strip()[:MAX_LINE]}" if text.strip() else f"\n  {where}"

    def lines(self, name: str = "") -> list[str]:
        """Return the lines of the submission's file, or of another submitted file.

        `name` may come from the child. A file outside the submission has no lines.
        """
        name = name or self._file.name
        if name not in self._texts:
            raw = b""
            with contextlib.suppress(OSError):
                if name in self._names():
                    raw = read_inside(self._file.parent, name, MAX_FILE)[:MAX_FILE]
            self._texts[name] = re.split(r"\r\n|\r|\n", raw.decode("utf-8", "replace"))
        return self._texts[name]

    def _names(self) -> set[str]:
        """Return the names of the submission's files, as paths in its folder."""
        try:
            files = submission_files(self._file)
        except (BotschoolError, Wrong):
            return set()
        return {path.relative_to(self._file.parent).as_posix() for path in files}

    def runs_another(self) -> str:
        """Return a line to put below a sentence: the first one that runs another file in IPython.

        "" if there is none. Jupytext makes a comment of such a line.
        """
        runs = (n for n, line in enumerate(self.lines(), 1) if _RUNS.match(line))
        return self.shown(self._file.name, next(runs, None))

    def without_folder(self, printed: str, folder: str) -> str:
        """Return what the submission printed, with its own words for places in its folder."""
        place = re.compile(rf"{re.escape(folder)}/([^\s:]+\.py):(\d{{1,7}})")
        text = place.sub(lambda found: self.at(found[1], int(found[2]))[0], printed)
        return text.replace(f"{folder}/", "")

    def defined(self, name: str) -> int | None:
        """Return the line where a function or class of this name begins, indented or not."""
        pattern = re.compile(rf"\s*(async\s+def|def|class)\s+{re.escape(name)}\b")
        found = [n for n, line in enumerate(self.lines(), 1) if pattern.match(line)]
        return found[0] if found else None

    def twice(self, names: Iterable[str]) -> str:
        """Return a line for each of these functions that the file defines more than once."""
        text = "\n".join(self.lines())
        lines = ""
        for name in names:
            pattern = re.compile(rf"^(?:async +def|def|class) +{re.escape(name)}\b", re.MULTILINE)
            places = [text.count("\n", 0, each.start()) + 1 for each in pattern.finditer(text)]
            if len(places) > 1:
                first, last = (self.at(self._file.name, places[i])[0] for i in (0, -1))
                lines += f"\n  {name} is defined more than once: {last} counts, not {first}."
        return lines


def explained(answer: dict[str, Any], said: str, source: SourceLines) -> Wrong:
    """Return the exception for a child's answer about an exception (sandbox.exceptions.explain)."""
    name, text, near, call = (
        plain(str(answer.get(key) or "")[:500]) for key in ("error", "text", "near", "call")
    )
    if answer.get("process") is True:
        text = NO_PROCESSES
    elif re.search(r"ffmpeg|unknown file extension: \.(mp4|gif)", text):
        text = NO_FILMS
    place = source.shown(answer.get("file"), answer.get("line"))
    if answer.get("loading"):
        return Unloadable(name, text, near, answer, source)
    if name == "NotPlain":
        return Wrong(
            f"{said} returned {_no_numbers(text)}, but numbers, lists or arrays are needed."
        )
    if name == "NotImplementedError":
        return NotDone(text)
    if name == "Missing":
        return Wrong(_missing(text, near, source))
    if name == "Signature":
        return Wrong(
            f"{said} cannot be called like this: {text}. Yours is {call}: take the parameters that "
            "the exercise's file gives it."
        )
    colon = f": {text}" if text else ""
    # drop the line if it is the grader's own
    told = f"{text} {place}"
    means = [advice for pattern, advice in _ADVICE if place and re.search(pattern, told)][:1]
    unknown = re.match(r"name '(\w+)' is not defined", text) if name == "NameError" else None
    if unknown and unknown[1] in source.lost:
        near, means = "", [f"{unknown[1]} cannot be read: {source.lost[unknown[1]]}."]
    below = place + "".join(f"\n  {advice}" for advice in means)
    return Wrong(f"{said} raised {name}{colon}{_suggested(near, text)}{below}")


def where_it_was(calls: list[tuple[str, int]], source: SourceLines) -> str:
    """Return lines to put below a sentence: where the program was, and from where it was called."""
    text = ""
    for number, (name, line) in enumerate(calls[:MAX_CALLS]):
        shown = source.shown(name, line).strip()
        text += f"\n  {'It was at' if number == 0 else 'called from'} {shown}"
    return text


class Unloadable(Wrong):
    """The file cannot be loaded; `banner` tells the learner why, with the line and a caret."""

    def __init__(
        self, name: str, text: str, near: str, answer: dict[str, Any], source: SourceLines
    ) -> None:
        colon = f": {text}" if text else ""
        file, line = answer.get("file"), answer.get("line")
        known = isinstance(file, str) and type(line) is int
        where = f"\n{marked(*source.at(file, line), answer.get('column'))}" if known else ""
        syntax = name in ("SyntaxError", "IndentationError", "TabError")
        what = "Your file is not Python yet" if syntax else "Your file cannot be loaded"
        self.banner = f"{what}. Mend this first:{where}\n  {name}{colon}{_suggested(near, text)}"
        at = f" in {source.at(file, line)[0]}" if known else ""
        super().__init__(f"Your file cannot be loaded: {name}{at}{colon}")


def marked(where: str, text: str, column: Any) -> str:
    """Return a place and its line, with a caret below it."""
    shown = f"  {where}\n    {text.strip()[:MAX_LINE]}"
    if type(column) is not int or column < 1:
        return shown
    indent = len(text) - len(text.lstrip())
    return f"{shown}\n    {' ' * max(0, min(column - 1 - indent, MAX_LINE))}^"


def _missing(name: str, near: str, source: SourceLines) -> str:
    text = f"there is no function {name} in your file"
    if why := source.lost.get(name):
        return f"{name} cannot be read: {why}."
    if line := source.defined(name):
        where, code = source.at(source._file.name, line)
        inner = code != code.lstrip()
        why = "it is indented, and so belongs to what is above it" if inner else "it is not reached"
        return f"{text}: there is one at {where}, but {why}."
    if near:
        return f"{text}; there is {near}: give it the name {name} again."
    if where := source.runs_another():
        return f"{text}.{where}\n  This line is left out: write `from FILE import {name}`."
    return f"{text}: its name must be as the exercise's file gives it."


def _suggested(near: str, text: str) -> str:
    return f". Did you mean {near}?" if near and "Did you mean" not in text else ""


def _no_numbers(text: str) -> str:
    found = re.fullmatch(r"an object of type (\w+)", text)
    return _NO_NUMBERS.get(found[1], text) if found else text
