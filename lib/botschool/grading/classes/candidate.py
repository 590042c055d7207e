"""Judge whether a submitted file is an exercise's, and which of several the person means."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.files import File
from botschool.grading.classes.kinds import is_page
from botschool.grading.classes.texts import (
    code_of_fences,
    code_of_notebook,
    decoded,
    is_notebook,
    text_of_page,
)
from botschool.grading.copies.starting import original
from botschool.grading.declare.exercise import Number, folder_of

MARKDOWN = (".md", ".qmd", ".rmd")
TYPED = ("onlinetext.html", "text.html")
"""Names that Moodle and Canvas give to the text that was typed in."""
_SUFFIX = re.compile(r"(?i)(\.(pyw?|ipynb|txt|html?|json|q?md|rmd))+$")
_STUB = re.compile(r"raise NotImplementedError\(\s*['\"]task \d")
_NAMES = re.compile(r"^(?:async +def|def|class) +(\w+)", re.MULTILINE)
_OLD = re.compile(r"old|backup|\bbak\b|orig|before|skeleton|template", re.IGNORECASE)


def squashed(name: str) -> str:
    """Return the letters and digits of a name in lower case."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def code_lines(text: str) -> set[str]:
    """Return the lines of a program without comments and without those of test cells."""
    lines = (line.strip() for line in text.splitlines())
    return {line for line in lines if line and line[0] != "#" and "grade_cell" not in line}


def names_in(text: str) -> set[str]:
    """Return the functions and classes that a program defines."""
    return set(_NAMES.findall(text.replace("\r", "\n")))


class Sought:
    """The name of an exercise's file, and the file as students got it."""

    number: Number
    file: str
    folder: str
    skeleton: str

    def __init__(self, number: int, file: str, root: Path) -> None:
        self.number, self.file = number, file
        self.folder = folder_of(number, root).name
        self.stem = squashed(Path(file).stem)
        try:
            self.skeleton = original(number, root)
        except BotschoolError:  # then nothing can be told to be as it was given out
            self.skeleton = ""
        self.known = bool(self.skeleton)
        self.lines = code_lines(self.skeleton)
        self.names = names_in(self.skeleton)
        self.places = {f"{self.folder}/{file}", f"exercises/{self.folder}/{file}", file}
        self.others = _others(root / "exercises", self.folder)
        self.others.pop(self.stem, None)


@dataclass
class Candidate:
    """A file that may be the exercise's."""

    file: File
    wanted: Sought
    content: bytes

    @cached_property
    def suffix(self) -> str:
        """Return the name's suffix, without additions of a system."""
        name = re.sub(r"(?i)(\.py|\.ipynb)\.txt$", r"\1", self.file.name)
        suffix = re.search(r"\.\w+$", name)
        return suffix[0].lower() if suffix else ""

    @cached_property
    def text(self) -> str:
        """Return its code, or a notebook's JSON."""
        text = decoded(self.content)[0]
        if self.suffix in MARKDOWN:
            return code_of_fences(text)
        return text_of_page(text) if self.is_page else text

    @cached_property
    def is_page(self) -> bool:
        """Return whether its content is a web page, whatever its name."""
        return self.suffix in (".html", ".htm") or is_page(decoded(self.content)[0])

    @cached_property
    def code(self) -> str:
        return code_of_notebook(self.text) if self.is_notebook else self.text

    @cached_property
    def is_notebook(self) -> bool:
        """Return whether its content is a notebook, whatever its name."""
        named = self.suffix == ".ipynb" and self.text.lstrip().startswith("{")
        return named or is_notebook(self.text)

    @cached_property
    def is_named(self) -> bool:
        return self.wanted.stem in squashed(self.file.name)

    @property
    def is_typed(self) -> bool:
        """Return whether the platform made the file of a text that was typed in."""
        return self.is_page and self.file.name in TYPED

    @cached_property
    def is_exact(self) -> bool:
        name = Path(self.wanted.file)
        return self.file.name in (name.name, name.with_suffix(".ipynb").name)

    @cached_property
    def shared(self) -> float:
        """Return the share of the skeleton's functions that it defines."""
        names = self.wanted.names
        return len(names & names_in(self.code)) / len(names) if names else 0.0

    @cached_property
    def differs(self) -> bool:
        """Return whether it differs from the file that students got."""
        lines = code_lines(self.code)
        return bool(lines) and (not self.wanted.known or lines != self.wanted.lines)

    def fits(self) -> bool:
        """Return whether its name or its definitions are the exercise's."""
        name = self.file.name.lower()
        if name.startswith("test_"):
            return False
        if self.is_named:
            python = self.suffix in (".py", ".ipynb", ".pyw") or self.is_notebook
            return python or (self.shared > 0 and "def " in self.code)
        if self.shared < 0.6 or len(self.wanted.names) < 2:
            return False
        defined = names_in(self.code)
        return not any(
            stem in squashed(name) and len(names & defined) >= 0.6 * len(names)
            for stem, names in self.wanted.others.items()
        )

    def rank(self, newest_first: bool) -> tuple:
        """Return a sort key: the larger, the more likely the person wants this file graded."""
        place = self.file.shown in self.wanted.places
        left = len(_STUB.findall(self.code))
        attempt = re.search(r"-(\d+)$", self._addition)
        number = max(map(int, re.findall(r"\d+", self._addition)), default=0)
        return (
            self.is_exact or self.shared > 0,
            self.differs,
            int(attempt[1]) if newest_first and attempt else 0,
            self.is_named,
            not _OLD.search(self._addition),
            -left,
            self.is_exact,
            place,
            self.suffix == ".py",
            bool(re.search("final|last|new", self._addition, re.IGNORECASE)),
            number,
            -self.file.shown.count("/"),
            self.file.shown,
        )

    @cached_property
    def _addition(self) -> str:
        """Return what its name has beside the exercise's."""
        stem = _SUFFIX.sub("", self.file.name)
        own = "[^a-z0-9]*".join(self.wanted.stem)
        return re.sub(own, "", stem, count=1, flags=re.IGNORECASE)


def _others(exercises: Path, own: str) -> dict[str, set[str]]:
    """Return the names of the other exercises' files, each with what the file defines."""
    found = {}
    for path in exercises.glob("ex[0-9][0-9]_*/*.py"):
        if path.parent.name != own and not path.name.startswith("test_"):
            text = path.read_text(encoding="utf-8", errors="replace")
            found[squashed(path.stem)] = names_in(text)
    return found
