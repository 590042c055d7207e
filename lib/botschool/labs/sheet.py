"""Read a sheet: Markdown with marked fields, a table and sections."""

from __future__ import annotations

import hashlib
import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.labs.declare import Lab
from botschool.labs.fields import BOX, Field, parts_of
from botschool.sandbox.inside import read_inside

_ANSWER = re.compile(r"answer:(.*)", re.IGNORECASE)
_NUMBER = re.compile(r"(?<![\w.])[-+\u2212]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][-+]?\d+)?(?![\w.]*\d)")
MAX_BYTES = 200_000
MAX_ANSWER = 100
"""Characters of an answer in numbers."""
MIN_WORDS = 10
"""Words of a text."""


class Unreadable(BotschoolError):
    """A field is empty or cannot be read; the text is a sentence."""


def made_by(path: Path) -> str:
    """Return the command that makes a file of a laboratory's folder."""
    return f"botschool lab {path.resolve().parent.name.removeprefix('lab').lstrip('0')} start"


@dataclass(frozen=True)
class Sheet:
    """The text of a sheet, with line ends normalised, and the answers in it."""

    text: str

    @classmethod
    def read(cls, path: Path) -> Sheet:
        """Read a sheet. Raises BotschoolError."""
        try:
            content = read_inside(path.parent, path.name, MAX_BYTES)
            if len(content) > MAX_BYTES:
                raise BotschoolError(f"{path} is larger than {MAX_BYTES // 1000} kB: shorten it.")
            text = content.decode("utf-8-sig")
        except FileNotFoundError:
            raise BotschoolError(f"There is no {path}: {made_by(path)} makes it.") from None
        except OSError as error:
            raise BotschoolError(
                f"{path} cannot be read ({error.strerror or 'no regular file'}): it must be a "
                "file of its own, and no link."
            ) from None
        except UnicodeDecodeError:
            raise BotschoolError(f"{path} is not UTF-8 text: save it as UTF-8.") from None
        return cls("\n".join(text.splitlines()))

    @property
    def prediction(self) -> str:
        """Return the prediction without differences that editors cause: spaces, line ends."""
        section = r"^## +Prediction[^\n]*\n(.*?)(?=^## |\Z)"
        found = re.search(section, self.text, re.MULTILINE | re.DOTALL | re.IGNORECASE)
        text = uncommented(found[1] if found else "", " ")
        return " ".join(text.replace("[X]", "[x]").split())

    def raw(self, id: str) -> str:
        """Return the lines of a field: up to the next field, heading or table."""
        for name, _, part in parts_of(self.text):
            if name == id:
                return part
        raise Unreadable(
            f"The field {id} is not in sheet.md: put its line <!-- field: {id} --> back."
        )

    def value(self, field: Field) -> Any:
        """Return the answer in a field. Raises Unreadable."""
        raw = self.raw(field.id)
        if field.kind == "number":
            found = _ANSWER.search(raw)
            return numbers_in(found[1] if found else "", field.what, 1)[0]
        if field.kind == "choice":
            chosen = [label.strip() for mark, label in BOX.findall(raw) if mark]
            if len(chosen) != 1:
                how = "nothing is" if not chosen else "more than one box is"
                raise Unreadable(f"{field.what} Here {how} marked: put [x] before exactly one.")
            return chosen[0]
        text = _quoted(raw)
        if len(re.findall(r"\w+", text)) < MIN_WORDS:
            raise Unreadable(f"{field.what} Write at least {MIN_WORDS} words after the sign >.")
        return text

    @property
    def words(self) -> str:
        """Return the text that the instructor reads; "" if there is none."""
        try:
            return _quoted(self.raw("words"))
        except Unreadable:
            return ""

    def values(self, fields: Iterable[Field]) -> tuple[dict[str, Any], list[str]]:
        """Return the readable answers by id, and a sentence on each other field."""
        found, missing = {}, []
        for field in fields:
            try:
                found[field.id] = self.value(field)
            except Unreadable as error:
                missing.append(str(error))
        return found, missing

    def row(self, label: str) -> list[str]:
        """Return the cells after the label in the table's row of this label. Raises Unreadable."""
        for line in self.text.splitlines():
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            if line.strip().startswith("|") and cells[0] == label:
                return cells[1:]
        raise Unreadable(f"The table has no row {label}: put it back.")

    def text_of(self, id: str) -> str:
        """Return the text after `answer:` in a field; "" if there is none."""
        found = _ANSWER.search(self.raw(id))
        return " ".join(found[1].split()) if found else ""


def uncommented(text: str, instead: str = "") -> str:
    """Return a text with `instead` in place of each complete comment."""
    head, end, rest = text.rpartition("-->")  # so each search for the end of a comment finds one
    return re.sub(r"<!--.*?-->", instead, head + end, flags=re.DOTALL) + rest


def _quoted(raw: str) -> str:
    lines = [line.strip()[1:] for line in raw.splitlines() if line.strip().startswith(">")]
    return " ".join(" ".join(lines).split())


def numbers_in(text: str, what: str, count: int, where: str = "after answer:") -> tuple[float, ...]:
    """Return the numbers in an answer. Raises Unreadable unless there are `count`."""
    text = re.sub(r"^answer:", "", text.strip(), flags=re.IGNORECASE).strip()
    numbers = [float(each.replace("\u2212", "-")) for each in _NUMBER.findall(text[:MAX_ANSWER])]
    good = len(numbers) == count and all(map(math.isfinite, numbers)) and len(text) <= MAX_ANSWER
    if good and not re.search(r"\d,\d", text):
        return tuple(numbers)
    asked = "a number" if count == 1 else f"{count} numbers, as 1.5 to 2.5,"
    wrong = f"'{text[:30]}' cannot be read" if text else "It is empty"
    if re.search(r"\d,\d", text[:MAX_ANSWER]):
        asked = "a point instead of the comma"
    raise Unreadable(f"{what} {wrong}: write {asked} {where}.")


def base_seed(sheet: Sheet, lab: Lab) -> int:
    """Return the seed from which all runs' seeds follow (docs/specification.md, "Laboratories")."""
    name, course = sheet.text_of("name").casefold(), sheet.text_of("course").casefold()
    return _first_seed("\0".join([name, lab.name, course, sheet.prediction]))


@cache
def _first_seed(key: str) -> int:
    """Return 31 bits of a slow hash, so that nobody finds a second prediction with this seed.

    A fast hash tries all 2^31 seeds in minutes; this one takes 35 ms and 16 MB a try.
    """
    digest = hashlib.scrypt(key.encode(), salt=b"botschool", n=2**14, r=8, p=1, dklen=4)
    return int.from_bytes(digest, "big") & 0x7FFFFFFF


def seeds_of(sheet: Sheet, lab: Lab, replications: int | None = None) -> dict[str, list[int]]:
    """Return the seeds of the runs: condition -> consecutive numbers."""
    first, count = base_seed(sheet, lab), replications or lab.replications
    return {
        condition.name: list(range(first + 1000 * i, first + 1000 * i + count))
        for i, condition in enumerate(lab.conditions)
    }


def check_specific(sheet: Sheet, lab: Lab) -> None:
    """Raise BotschoolError unless the sheet has name, course and a complete prediction."""
    named, _ = sheet.text_of("name"), sheet.text_of("course")
    if not named:
        raise BotschoolError("Write your name first (sheet.md, after 'Name:').")
    _, missing = sheet.values(field for field in lab.fields.values() if field.predicts)
    if missing:
        raise BotschoolError(f"Write your prediction first (sheet.md, 'Prediction'). {missing[0]}")
