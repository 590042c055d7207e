"""Choose the file of an exercise among all files that a person handed in."""

from __future__ import annotations

import contextlib
import re
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.files import File, Handed
from botschool.grading.classes.texts import (
    code_of_fences,
    code_of_notebook,
    decoded,
    is_notebook,
    text_of_page,
    today,
    without_cookie,
    without_jupyter,
)
from botschool.grading.copies.starting import original
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import Number, folder_of
from botschool.sandbox.scratch import MAX_COPIED, MAX_COPIED_FILES

MAX_TEXT = 4 * 2**20
"""Bytes of a file that may be an exercise's."""
MAX_LISTED = 30
"""Names in a list of files."""
SUFFIXES = (".py", ".ipynb", ".txt", ".pyw", ".html", ".htm", ".md", ".json", ".zip", "")
"""Suffixes of files that may hold an exercise, even under a wrong name."""
DATA = (
    ".npy", ".npz", ".csv", ".json", ".ini", ".png", ".jpg", ".jpeg", ".gif", ".svg", ".dat", ".pt",
    ".pth", ".onnx", ".yaml", ".yml", ".toml", ".xml", ".urdf", ".stl", ".obj", ".mp4",
)  # fmt: skip
"""Suffixes of data files, which a program reads or writes."""
GIVEN = (
    ".venv/", "build/", "data/", "docs/", "envs/", "lib/", "solutions/", "tests/", "tools/",
)  # fmt: skip
"""Folders beside exercises/ that nobody solves an exercise in."""
_COURSE = re.compile(r"((?:.*/)?)exercises/ex\d\d_")
_STUB = re.compile(r"raise NotImplementedError\(\s*['\"]task \d")
_NAMES = re.compile(r"^(?:async +def|def|class) +(\w+)", re.MULTILINE)
_OLD = re.compile(r"old|backup|\bbak\b|orig|before|skeleton|template", re.IGNORECASE)


class Wanted:
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
        self.names = set(_NAMES.findall(self.skeleton))
        self.places = {f"{self.folder}/{file}", f"exercises/{self.folder}/{file}", file}
        folder = root / "exercises"
        self.others = {
            squashed(path.stem)
            for path in folder.glob("ex[0-9][0-9]_*/*.py")
            if path.parent.name != self.folder and not path.name.startswith("test_")
        } - {self.stem}

    def choose(
        self, handed: Handed, new_folder: Callable[[], Path], newest_first: bool = False
    ) -> Choice:
        """Return the file to grade; newest_first: whether the platform numbers attempts."""
        return choose(handed, self, new_folder, newest_first)


def squashed(name: str) -> str:
    """Return the letters and digits of a name in lower case."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def code_lines(text: str) -> set[str]:
    """Return the lines of a program without comments and without those of test cells."""
    lines = (line.strip() for line in text.splitlines())
    return {line for line in lines if line and line[0] != "#" and "grade_cell" not in line}


@dataclass
class Candidate:
    """A file that may be the exercise's."""

    file: File
    wanted: Wanted
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
        if self.suffix == ".md":
            return code_of_fences(text)
        return text_of_page(text) if self.suffix in (".html", ".htm") else text

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

    @cached_property
    def is_exact(self) -> bool:
        name = Path(self.wanted.file)
        return self.file.name in (name.name, name.with_suffix(".ipynb").name)

    @cached_property
    def shared(self) -> float:
        """Return the share of the skeleton's functions that it defines."""
        names = self.wanted.names
        return len(names & set(_NAMES.findall(self.code))) / len(names) if names else 0.0

    @cached_property
    def differs(self) -> bool:
        """Return whether it differs from the file that students got."""
        lines = code_lines(self.code)
        return bool(lines) and (not self.wanted.known or lines != self.wanted.lines)

    def fits(self) -> bool:
        """Return whether its name or its definitions are the exercise's."""
        name = self.file.name.lower()
        if self.suffix not in SUFFIXES or name.startswith("test_"):
            return False
        if self.is_named:
            python = self.suffix in (".py", ".ipynb", ".pyw") or self.is_notebook
            return python or (self.shared > 0 and "def " in self.code)
        others = any(other in squashed(name) for other in self.wanted.others)
        return not others and self.shared >= 0.6 and len(self.wanted.names) > 1

    def rank(self, newest_first: bool) -> tuple:
        """Return a sort key: the larger, the more likely the person wants this file graded."""
        place = self.file.shown in self.wanted.places
        left = len(_STUB.findall(self.code))
        number = max(map(int, re.findall(r"\d+", self._addition)), default=0)
        return (
            self.is_exact or self.shared > 0,
            self.differs,
            number if newest_first else 0,
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
        stem = re.sub(r"\.\w+$", "", re.sub(r"(?i)\.txt$", "", self.file.name))
        own = "[^a-z0-9]*".join(self.wanted.stem)
        return re.sub(own, "", stem, count=1, flags=re.IGNORECASE)


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


def choose(
    handed: Handed, wanted: Wanted, new_folder: Callable[[], Path], newest_first: bool = False
) -> Choice:
    """Return the file to grade; newest_first: whether the platform numbers attempts."""
    candidates, unread = _candidates(handed, wanted)
    if not candidates:
        if any(_is_of(link, wanted) for link in handed.links):
            return Choice(problem=f"{wanted.file} is a link to another place.")
        if unread or handed.unread:
            return Choice(problem=f"The folder of {wanted.file} is unreadable.", unread=True)
        return Choice(problem=_nothing(handed, wanted))
    ranked = sorted(candidates, key=lambda each: each.rank(newest_first), reverse=True)
    best, others = ranked[0], ranked[1:]
    choice = Choice(origin=best.file, changed=best.differs)
    choice.used.add(best.file)
    if best.file.shown not in wanted.places:
        typed = best.suffix in (".html", ".htm")
        what = "the text that was typed in" if typed else best.file.shown
        choice.notes.append(f"Graded: {plain(what)}.")
    if others:
        given = [each for each in others if not each.differs]
        changed = [each for each in others if each.differs]
        if changed:
            choice.notes.append(f"Not used: {listed([each.file.shown for each in changed])}.")
        if given and best.differs:
            names = listed([each.file.shown for each in given])
            choice.notes.append(f"Not used, because nothing in it was changed: {names}.")
        choice.used |= {each.file for each in others}
    if not best.content.strip():
        choice.notes.append(f"{plain(best.file.name)} is empty.")
    elif not best.differs and best.code.strip():
        choice.notes.append(f"Nothing was changed in {plain(best.file.name)}.")
    _settle(choice, best, handed, wanted, new_folder)
    return choice


def listed(names: list[str]) -> str:
    """Return names with commas; of a long list, only its beginning and the number of the others."""
    shown = ", ".join(plain(name) for name in names[:MAX_LISTED])
    return f"{shown} and {len(names) - MAX_LISTED} more" if len(names) > MAX_LISTED else shown


def _is_of(link: str, wanted: Wanted) -> bool:
    """Return whether a link stands where the exercise's file or its folder is."""
    parts = link.split("/")
    return parts[-1] in (wanted.file, wanted.folder, "exercises") or wanted.folder in parts


def _candidates(handed: Handed, wanted: Wanted) -> tuple[list[Candidate], bool]:
    """Return the files that fit, and whether an unreadable one may be the exercise's.

    Files of other names count only if every file of the exercise's name is unchanged, and what the
    course gives out beside the exercises never: its library has modules of similar names.
    """
    courses = {match[1] for file in handed.files if (match := _COURSE.match(file.shown))}
    given = tuple(course + folder for course in courses for folder in GIVEN)
    own = {file for file in handed.files if not file.shown.startswith(given)}
    named = {file for file in own if wanted.stem in squashed(file.name)}
    found, unread = [], False
    for files in (named, own - named):
        for file in sorted(files, key=lambda file: file.shown):
            suffix = re.search(r"\.\w+$", file.name)
            if (suffix[0].lower() if suffix else "") not in SUFFIXES:
                continue
            try:
                content = file.read(MAX_TEXT)
            except OSError as error:
                if file in named:
                    unread |= error.errno is not None  # else a link, or no regular file
                    handed.links += [] if error.errno else [file.shown]
                continue
            candidate = Candidate(file, wanted, content)
            if len(content) <= MAX_TEXT and candidate.fits():
                found.append(candidate)
        if any(each.differs for each in found):
            break
    return found, unread


def _nothing(handed: Handed, wanted: Wanted) -> str:
    names = [file.shown for file in handed.files]
    have = f" Handed in: {listed(names[:5])}{' ...' * (len(names) > 5)}." if names else ""
    return f"There is no {wanted.file}.{have}"


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


def _settle(
    choice: Choice,
    best: Candidate,
    handed: Handed,
    wanted: Wanted,
    new_folder: Callable[[], Path],
) -> None:
    """Store the file under its name, in UTF-8, with the files beside it."""
    encoding = decoded(best.content)[1]
    if best.is_notebook and not best.code:
        choice.problem = f"{plain(best.file.shown)} is not a readable notebook."
        return
    if encoding:
        choice.notes.append(f"{plain(best.file.name)} was stored as {encoding}.")
    if best.is_notebook != (best.suffix == ".ipynb"):
        what = "a notebook" if best.is_notebook else "no notebook"
        choice.notes += [f"{plain(best.file.name)} is {what}."] * (best.suffix in (".py", ".ipynb"))
    content = today(best.text) if best.is_notebook else without_jupyter(best.text)
    if content != best.text and not best.is_notebook:
        choice.notes.append("Left out: lines that only Jupyter understands.")
    beside = [
        file
        for file in handed.files
        if file != best.file and file.shown.startswith(best.file.folder)
    ]
    suffix = ".ipynb" if best.is_notebook else ".py"
    name = Path(wanted.file).with_suffix(suffix).name
    own = best.file.path.name == name and best.file.place.endswith(best.file.shown)
    if own and not encoding and content == best.text:
        choice.file = best.file.path.absolute()
        choice.used |= _needed(best, [file for file in beside if file.top == best.file.top])
        return
    candidates = choice.used - {best.file}
    choice.used |= _needed(best, beside)
    folder = new_folder()
    content = content if best.is_notebook else without_cookie(content)
    room = MAX_COPIED
    for file in beside[:MAX_COPIED_FILES]:
        inner = file.shown[len(best.file.folder) :]
        if file in candidates or inner == name or inner.count("/") > 10:
            continue
        try:
            copied = file.read(room)
            room -= len(copied)
            if room < 0:
                raise BotschoolError(f"holds more than {MAX_COPIED // 2**20} MB")
            place = folder / inner
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(copied)
        except BotschoolError as error:
            choice.problem = f"The folder of {wanted.file} {error}: keep only the files it needs."
            return
        except OSError:
            continue
    choice.file = folder / name
    choice.file.write_bytes(content.encode("utf-8", "replace"))
