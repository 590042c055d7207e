"""Find the fields of a sheet: each follows its question, and shows how it is answered."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass

_MARKER = re.compile(r"<!--\s*field:\s*([\w-]+)\s*-->")
BOX = re.compile(r"\[\s{0,9}([xX]?)\s{0,9}\]\s{0,9}([^\[\n]+)")
ABOUT = ("name", "course", "words")
"""Fields that the check reads on their own."""


@dataclass(frozen=True)
class Field:
    """A field of a laboratory's sheet."""

    id: str
    kind: str
    """"number", "choice" or "text"."""
    what: str
    """Its question."""
    predicts: bool
    """Whether it belongs to the prediction."""


def parts_of(text: str) -> Iterator[tuple[str, str, str]]:
    """Yield id, text before and answer of each field: up to the next field, heading or table."""
    before, *parts = _MARKER.split(text)
    for id, part in zip(parts[::2], parts[1::2], strict=True):
        yield id, before, re.split(r"^#|^\|", part, maxsplit=1, flags=re.MULTILINE)[0]
        before = part


def fields_of(page: str) -> dict[str, Field]:
    """Return the fields of a laboratory's page by their id."""
    prediction = page.partition("\n## Prediction")[2].partition("\n## ")[0]
    found = {}
    for id, before, answer in parts_of(page):
        if id not in ABOUT:
            kind = (
                "text" if answer.strip() == ">" else "number" if "answer:" in answer else "choice"
            )
            predicts = f"field: {id} -->" in prediction
            found[id] = Field(id, kind, _question(before), predicts)
    return found


def _question(before: str) -> str:
    """Return the last sentence of the last paragraph of a text."""
    paragraph = " ".join(before.rpartition("\n\n")[2].split())
    return re.split(r"(?<=[.?:]) (?=[A-Z*])", paragraph)[-1]
