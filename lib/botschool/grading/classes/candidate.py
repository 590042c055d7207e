"""Judge which submitted file is an exercise's, and store it where it can be graded."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.files import File, Handed, listed
from botschool.grading.classes.texts import (
    MAX_TEXT,
    code_of_fences,
    code_of_notebook,
    decoded,
    is_notebook,
    text_of_page,
    today,
    without_cookie,
    without_invisible,
    without_jupyter,
)
from botschool.grading.classes.unpack import DATA, is_page
from botschool.grading.copies.starting import original
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import PICTURES, Number, folder_of
from botschool.sandbox.errors import CannotRead, Refused
from botschool.sandbox.scratch import MAX_COPIED, MAX_COPIED_FILES, regular_files

MARKDOWN = (".md", ".qmd", ".rmd")
TYPED = ("onlinetext.html", "text.html")
"""Names that Moodle and Canvas give to the text that was typed in."""
MAX_DEPTH = 10
"""Folders within that of the graded file."""
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
        course = path.name.startswith("test_") or path.name == PICTURES
        if path.parent.name != own and not course:
            text = path.read_text(encoding="utf-8", errors="replace")
            found[squashed(path.stem)] = names_in(text)
    return found


@dataclass
class Choice:
    """The file to grade for an exercise, or the reason why there is none."""

    file: Path | None = None
    """Its path on the disk, under a name that can be graded."""
    problem: str = ""
    unread: bool = False
    """Whether the problem lies outside the submission."""
    notes: list[str] = field(default_factory=list)
    """What the reader of the grade must know."""
    used: set[File] = field(default_factory=set)
    changed: bool = False
    """Whether it differs from the file that students got."""
    origin: File | None = None
    """Its name as handed in."""


def settle(
    choice: Choice,
    best: Candidate,
    handed: Handed,
    new_folder: Callable[[], Path],
) -> None:
    """Store the best file where it can be graded, and note what is unusual about it.

    A file that has its right name and form stays where it is.
    """
    if best.is_notebook and not best.code:
        choice.problem = f"{plain(best.file.shown)} is not a readable notebook."
        return
    content, notes = _content(best)
    choice.notes += notes
    beside = [
        file
        for file in handed.files
        if file != best.file and file.shown.startswith(best.file.folder)
    ]
    name = Path(best.wanted.file).with_suffix(".ipynb" if best.is_notebook else ".py").name
    own = best.file.path.name == name and best.file.place.endswith(best.file.shown)
    plain_text = content == best.text and not decoded(best.content)[1] and not best.is_page
    if own and plain_text and _is_small(best.file.path):
        choice.file = best.file.path.absolute()
        choice.used |= _needed(best, [file for file in beside if file.top == best.file.top])
        return
    rivals = choice.used - {best.file}
    needed = _needed(best, beside)
    choice.used |= needed
    wishes = [file for file in beside if file not in rivals]
    folder = new_folder()
    left = _copy(best, sorted(wishes, key=lambda file: file not in needed), name, folder)
    if left:
        choice.notes.append(
            f"Left out, because the folder holds more than {MAX_COPIED // 2**20} MB or "
            f"{MAX_COPIED_FILES} files: {listed(left)}."
        )
    choice.file = folder / name
    choice.file.write_bytes(content.encode("utf-8", "replace"))


def _content(best: Candidate) -> tuple[str, list[str]]:
    """Return the text to grade, and sentences on how it differs from the file."""
    name, encoding, notes = plain(best.file.name), decoded(best.content)[1], []
    if encoding:
        notes.append(f"{name} was stored as {encoding}.")
    if best.is_notebook != (best.suffix == ".ipynb"):
        what = "a notebook" if best.is_notebook else "no notebook"
        notes += [f"{name} is {what}."] * (best.suffix in (".py", ".ipynb"))
    if best.is_page and best.suffix not in (".html", ".htm"):
        notes.append(f"{name} is a web page: only its text counts.")
    if best.is_notebook:
        return today(best.text), notes
    visible = without_invisible(best.text)
    if visible != best.text:
        notes.append("Invisible characters, which Python refuses, were replaced.")
    content = without_jupyter(visible)
    if content != visible:
        notes.append("Left out: lines that only Jupyter understands.")
    return without_cookie(content) if encoding or content != best.text else content, notes


def _is_small(file: Path) -> bool:
    """Return whether the sandbox takes the folder of a file as it is."""
    try:
        regular_files(file)
    except Refused:
        return False
    except CannotRead:  # which the grader reports
        pass
    return True


def _copy(best: Candidate, wishes: list[File], name: str, folder: Path) -> list[str]:
    """Copy files beside the best one, in this order; return the paths of those without room."""
    room, count, left = MAX_COPIED - MAX_TEXT, MAX_COPIED_FILES - 1, []
    for file in wishes:
        inner = file.shown[len(best.file.folder) :]
        if inner == name:
            continue
        try:
            content = file.read(room)
            if len(content) > room or count == 0 or inner.count("/") > MAX_DEPTH:
                left.append(file.shown)
                continue
            place = folder / inner
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        except OSError:
            continue
        room -= len(content)
        count -= 1
    return left


def _needed(best: Candidate, beside: list[File]) -> set[File]:
    """Return the files beside it that a program can use: data, and modules that it names."""
    used = {file for file in beside if file.name.lower().endswith(DATA)}
    texts, waiting = [best.code], {file for file in beside if file not in used}
    while texts:
        text = texts.pop()
        for file in list(waiting):
            stem = re.sub(r"\.\w+$", "", file.name)
            if file.name in text or re.search(rf"\b{re.escape(stem)}\b", text):
                waiting.discard(file)
                used.add(file)
                with contextlib.suppress(OSError):
                    texts.append(file.read(MAX_TEXT).decode("utf-8", "replace"))
    return used
