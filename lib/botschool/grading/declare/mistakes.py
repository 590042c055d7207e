"""Read the cases of an exercise: wrong answers that prove its grader, and right ones.

solutions/exNN_name/cases.txt holds them. A case is a section of the file:

    %% noise_of_the_first_only loses 16.2, 16.3 and says so
    Adds noise to the first sensor only.
    -     noise = rng.normal(0, 0.1, len(sensors))
    +     noise = rng.normal(0, 0.1)

The first line gives the name and the tasks that lose points; a right answer loses none. The second
line says what the code does wrong, as a sentence for the learner that begins with a verb: a grader
prints it if a submission answers exactly as this case does (judge/causes.py). Lines with `-`
are lines of the solution, which must hold them exactly once and without a gap; the lines with `+`
replace them; the next `-` begins another change. Code that follows is put after the solution's
functions and redefines them; there `_name` is the solution's function `name`.

`and says so`: the message of the first of these tasks must hold the second line. A third line
`says: WORDS`, a regular expression, asks for words of a check instead, or of the second line if the
message has it.
"""

from __future__ import annotations

import re
from contextlib import suppress
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path

CASES = "cases.txt"
"""The file beside the solution; packed for students."""
THIS = "this"
"""What a case `says` that asks for its second line."""
_TITLE = re.compile(r"(\w+)(?: loses (\d+\.\d+(?:, \d+\.\d+)*)( and says so)?)?")
_HEAD = re.compile(r"(?:(?:says:|[-+])(?: .*)?\n)*")
_IMPORT = re.compile(r"^\s*(import|from) ", re.MULTILINE)
_MAIN = re.compile(r'^if __name__ == "__main__":', re.MULTILINE)


@dataclass(frozen=True)
class Case:
    """A solution with something wrong or different."""

    number: int
    name: str
    loses: tuple[str, ...]
    """Tasks that lose points."""
    what: str
    """What is wrong or different, in a sentence."""
    says: str | None
    changes: tuple[tuple[str, str], ...]
    """Lines of the solution, and the lines that replace them."""
    code: str

    def __str__(self) -> str:
        return f"ex{self.number:02d}-{self.name}"

    def of(self, solution: str) -> str:
        """Return the text of the submission. Raises ValueError if a change does not fit."""
        for old, new in self.changes:
            if solution.count("\n" + old) != 1:
                raise ValueError(f"{self}: the solution must hold these lines exactly once:\n{old}")
            solution = solution.replace("\n" + old, "\n" + new)
        return inserted(solution, _originals(self.code, solution)) if self.code else solution


@dataclass(frozen=True)
class Known:
    """An exercise's solution and its cases, for the grader."""

    number: int = 0
    solution: str = ""
    mistakes: str = ""

    def changed(self, task: str) -> list[tuple[Case, str]]:
        """Return the mistakes that cost a task points, with the text of the solution of each.

        Those made in this task come first, those that import something last: imports take long.
        """
        cases = [case for case in read_cases(self.number, self.mistakes) if task in case.loses]
        cases.sort(key=lambda case: (bool(_IMPORT.search(case.code)), case.loses.index(task)))
        texts = list[tuple[Case, str]]()
        for case in cases:
            with suppress(ValueError):  # it no longer fits the solution
                texts.append((case, case.of(self.solution)))
        return texts


def case_text(root: Path, number: int) -> str:
    """Return the text of an exercise's cases, "" if it has none; root: the course."""
    paths = sorted((root / "solutions").glob(f"ex{number:02d}_*/{CASES}"))
    return paths[0].read_text(encoding="utf-8") if paths else ""


def inserted(text: str, addition: str) -> str:
    """Return a file's text with an addition after its functions, before its main part."""
    found = _MAIN.search(text)
    at = found.start() if found else len(text)
    return f"{text[:at]}\n{addition}\n\n{text[at:]}"


def _originals(code: str, solution: str) -> str:
    """Return the code after lines that keep the solution's function `name` as `_name`."""
    names = re.findall(r"^(?:def|class) (\w+)", solution, re.MULTILINE)
    kept = [
        f"_{name} = {name}\n"
        for name in names
        if re.search(rf"\b_{name}\b", code)
        and not re.search(rf"^ *(?:(?:def|class) _{name}\b|_{name}\b[^(\n]*=)", code, re.MULTILINE)
    ]
    return "".join(kept) + code


def read_cases(number: int, text: str, make: type[Case] = Case) -> list[Case]:
    """Return the cases of an exercise's file of cases. Raises ValueError."""
    _, *parts = re.split(r"^%% (.*)\n", text, flags=re.MULTILINE)
    return [
        make(number, *_parts(f"exercise {number}", title, body))
        for title, body in zip(parts[::2], parts[1::2], strict=True)
    ]


def _parts(where: str, title: str, text: str) -> tuple:
    """Return the fields of a Case after its number; text: the section after its first line."""
    found = _TITLE.fullmatch(title)
    if not found:
        raise ValueError(f"{where}: write '%% NAME loses N.2, N.4', not '%% {title}'")
    name, loses, so = found.groups()
    what, _, text = text.partition("\n")
    if not re.match(r"\w", what):
        raise ValueError(f"{where}: {name}: the second line must say what is wrong or different")
    head = _HEAD.match(text).group()
    lines = head.splitlines()
    says = [THIS] if so else [line[6:] for line in lines if line.startswith("says: ")]
    edits = [(line[0], f"{line[2:]}\n") for line in lines if line[0] in "-+"]
    changes = []
    for is_old, group in groupby(edits, key=lambda edit: edit[0] == "-"):
        block = "".join(line for _, line in group)
        if is_old:
            changes.append((block, ""))
        elif not changes:
            raise ValueError(f"{where}: {name}: lines with + must follow lines with -")
        else:
            changes[-1] = (changes[-1][0], block)
    code = text[len(head) :].strip("\n")
    tasks = tuple(loses.split(", ")) if loses else ()
    return name, tasks, what, says[0] if says else None, tuple(changes), code
