"""Read and write CSV files of other programs, with any delimiter and encoding."""

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
from botschool.grading.classes.unpack import kind_of
from botschool.screen import plain

MAX_TABLE = 20 * 2**20
_SEPARATOR = re.compile(r"\s*\"?sep=(.)\"?[,;\t]*\r?\n", re.IGNORECASE)
"""Excel's first line, which names the delimiter."""


@dataclass
class Table:
    """A CSV file: its head, its rows, and how it was written."""

    path: Path
    head: list[str]
    rows: list[list[str]]
    delimiter: str = ","
    marked: bool = False
    """Whether the file begins with a byte order mark."""

    def column(self, *names: str) -> int | None:
        """Return the index of the first column with one of these heads, in any capitals."""
        heads = [head.strip().casefold() for head in self.head]
        return next((heads.index(name) for name in names if name in heads), None)

    def get(self, row: list[str], *names: str) -> str:
        """Return the cell of the first such column, or "" if there is none."""
        return self.cell(row, self.column(*names))

    @staticmethod
    def cell(row: list[str], column: int | None) -> str:
        """Return a cell; "" if the row is too short."""
        return row[column].strip() if column is not None and column < len(row) else ""

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
    if kind_of(content[:512], path.name):
        raise BotschoolError(f"{path} is no CSV file: open it in Excel and save it as CSV (UTF-8).")
    text, encoding = decoded(content)
    if encoding.startswith("Latin-1"):  # of which Windows has an extension
        text = content.decode("cp1252", "replace")
    named = _SEPARATOR.match(text)
    text = text[named.end() :] if named else text
    first = text.lstrip("\r\n").partition("\n")[0]
    delimiter = named[1] if named else max("\t,;", key=first.count)
    try:
        rows = list(csv.reader(io.StringIO(text, newline=""), delimiter=delimiter))
    except (csv.Error, TypeError) as error:
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


def number_in(text: str, most: float) -> float | None:
    """Return the number in a cell, with a point or a comma; None for others, or above `most`."""
    found = re.fullmatch(r"\s*(\d+)(?:[.,](\d*))?\s*", text, re.ASCII)
    number = float(f"{found[1]}.{found[2] or 0}") if found else most + 1
    return number if number <= most else None


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
