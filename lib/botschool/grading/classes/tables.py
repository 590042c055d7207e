"""Read and write CSV files of other programs, with any delimiter, encoding and header."""

from __future__ import annotations

import csv
import io
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.texts import decoded
from botschool.screen import plain

MAX_TABLE = 20 * 2**20

COLUMNS = {
    "name": ("name", "fullname", "student", "studentname", "displayname"),
    "first": ("firstname", "first", "givenname", "forename", "vorname"),
    "last": ("lastname", "last", "surname", "familyname", "nachname", "name2"),
    "id": (
        "id", "idnumber", "studentid", "sid", "sisuserid", "studentnumber", "matriculationnumber",
        "matrikelnummer", "number",
    ),
    "mail": ("email", "emailaddress", "mail", "emailadresse"),
    "user": ("username", "user", "login", "loginid", "sisloginid", "github", "githubusername"),
    "participant": ("identifier", "participant"),
    "exercise": ("exercise", "assignment"),
    "points": ("points", "adjustment", "change"),
    "reason": ("reason", "comment", "note", "notes"),
    "group": ("group", "groupname", "team"),
    "submitted": ("submitted", "lastmodifiedsubmission", "submissiontime", "time", "date"),
}  # fmt: skip
"""Meaning of a column -> letters and digits of its heads in lower case."""


@dataclass
class Table:
    """A CSV file: its head, its rows, and how it was written."""

    path: Path
    head: list[str]
    rows: list[list[str]]
    delimiter: str = ","
    marked: bool = False
    """Whether the file begins with a byte order mark."""

    def column(self, meaning: str) -> int | None:
        """Return the index of the first column with a meaning of COLUMNS, or with a name."""
        heads = [re.sub(r"[\W_]", "", head.lower()) for head in self.head]
        for known in COLUMNS.get(meaning, (meaning,)):
            if known in heads:
                return heads.index(known)
        return None

    def get(self, row: list[str], meaning: str) -> str:
        """Return the cell, or "" if there is no such column."""
        index = self.column(meaning)
        return row[index].strip() if index is not None and index < len(row) else ""

    def text(self) -> bytes:
        """Return the file's present content."""
        stream = io.StringIO()
        writer = csv.writer(stream, delimiter=self.delimiter, lineterminator="\r\n")
        writer.writerows([self.head, *self.rows])
        return stream.getvalue().encode("utf-8-sig" if self.marked else "utf-8", "replace")


def read_table(path: Path) -> Table:
    """Return a CSV file with a head. Raises BotschoolError."""
    try:
        with path.open("rb") as file:
            content = file.read(MAX_TABLE + 1)
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read ({error.strerror}).") from None
    if len(content) > MAX_TABLE:
        raise BotschoolError(f"{path} is larger than {MAX_TABLE // 2**20} MB: is it a table?")
    text, encoding = decoded(content)
    first = text.lstrip("\r\n").partition("\n")[0]
    delimiter = max(",;\t", key=first.count)
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))
    except csv.Error as error:
        raise BotschoolError(f"{path} is not a readable table ({error}).") from None
    rows = [row for row in rows if any(cell.strip() for cell in row)]
    if not rows:
        raise BotschoolError(f"{path} is empty: it needs a table with a head.")
    return Table(path, rows[0], rows[1:], delimiter, "mark" in encoding)


def made_table(rows: Iterable[Sequence[Any]]) -> bytes:
    """Return a new CSV file, in which no text is a formula."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerows([[safe_cell(c) if isinstance(c, str) else c for c in row] for row in rows])
    return stream.getvalue().encode("utf-8-sig", "replace")


def check_own(path: Path, sign: str, maker: str) -> None:
    """Raise BotschoolError before overwriting a file that lacks the sign of our command."""
    try:
        with path.open(encoding="utf-8-sig", errors="replace") as file:
            head = file.read(1000)
    except FileNotFoundError:
        return
    except OSError:
        head = ""
    if sign not in head or path.is_symlink():
        raise BotschoolError(
            f"{path} exists and was not made by {maker}: move it away, or choose another folder "
            "with -o."
        )


_FORMULA = re.compile(
    r"""((?:^|[;,])[\s"\x00-\x1f\u200b-\u200f\u2060\ufeff]*)"""
    "(?=[-=+@\u2212\ufe62\ufe63\ufe66\ufe6b\uff0b\uff0d\uff1d\uff20])"
)
"""The beginning of a formula, also in full-width letters, and of one after a semicolon or comma."""


def safe_cell(text: str) -> str:
    """Return a text in one line that no spreadsheet takes for a formula, nor a terminal for more.

    A program that splits a table at semicolons sees further cells in it.
    """
    return _FORMULA.sub(r"\1'", plain(" ".join(text.split())))
