"""Read the text of an .ini file: sections, keys and values, each with its line number.

The standard library's configparser forgets line numbers, which messages for learners need.
"""

from __future__ import annotations

import difflib
import os
import re
from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

from botschool.errors import BotschoolError
from botschool.npy import opened

LONGEST_FILE = 1_000_000
"""Largest number of characters; a longer file is no experiment file."""


class Entry(NamedTuple):
    """One line `key = value`."""

    key: str
    """As written in the file."""
    value: Any
    """Text without comment and surrounding space."""
    line: int
    """Counted from 1; 0 when unknown."""


def read_sections(
    path: str | PathLike[str], names: tuple[str, ...], aliases: dict[str, str]
) -> dict[str, dict[str, Entry]]:
    """Return section name -> lower-case key -> entry, for every section of the file.

    `names` are the allowed sections; `aliases` gives the key that a second name stands for. Raises
    BotschoolError for a file that cannot be read and for a line that is no part of an .ini file.
    """
    sections: dict[str, dict[str, Entry]] = {}
    opened: dict[str, int] = {}
    entries = None
    for number, line in enumerate(re.split(r"\r\n|\r|\n", _read(path)), start=1):
        text = re.sub(r"(^|\s)[#;].*", "", line, flags=re.DOTALL).strip()
        if not text:
            continue
        try:
            if text.startswith("["):
                name = _section(text, names)
                if name in opened:
                    raise ValueError(
                        f"section [{name}] starts a second time, after line {opened[name]}: "
                        "put all its lines under the first one"
                    )
                opened[name] = number
                entries = sections.setdefault(name, {})
            else:
                entry = _entry(text, number)
                if entries is None:
                    raise ValueError(
                        f"{shown(text)} stands before the first section: put a line "
                        f"[{names[0]}] above it"
                    )
                key = aliases.get(entry.key.lower(), entry.key.lower())
                if key in entries:
                    raise ValueError(_twice(entry.key, entries[key]))
                entries[key] = entry
        except ValueError as error:
            raise refusal(path, number, str(error)) from None
    return sections


def refusal(path: str | PathLike[str], line: int, sentence: str) -> BotschoolError:
    """Return an error whose sentence starts with the file and, unless it is 0, the line."""
    place = f"{os.fspath(path)}, line {line}" if line else f"{os.fspath(path)}"
    return BotschoolError(f"{place}: {sentence}{'' if sentence.endswith('?') else '.'}")


def nearest(word: object, known: Iterable[str]) -> str:
    """Return a remedy for an unknown word: the most similar known one, or all of them.

    word: whatever a file holds in the place of a name.
    """
    names = {name.lower(): name for name in known}
    close = difflib.get_close_matches(str(word).lower()[:80], names, n=1)
    return f"did you mean {names[close[0]]}?" if close else f"known are {', '.join(names.values())}"


def shown(value: Any) -> str:
    """Return a value in a form to quote in a sentence: short, on one line."""
    text = str(value) if str(value).isprintable() and str(value) else ascii(value)
    return text if len(text) <= 40 else f"{text[:37]}..."


def _section(text: str, names: tuple[str, ...]) -> str:
    match = re.fullmatch(r"\[([^\[\]]*)\]", text)
    if not match:
        raise ValueError(
            f"{shown(text)} is no section: write its name in brackets, alone on the line, "
            f"as in [{names[0]}]"
        )
    name = match[1].strip()
    if name.upper() not in names:
        close = nearest(name, (f"[{known}]" for known in names))
        raise ValueError(f"section [{shown(name)}] is unknown: {close}")
    return name.upper()


def _entry(text: str, number: int) -> Entry:
    match = re.fullmatch(r"([^=:]*)[=:](.*)", text, flags=re.DOTALL)
    if not match:
        raise ValueError(f"{shown(text)} lacks an = sign: write key = value")
    key = match[1].strip()
    if not key:
        raise ValueError(f"{shown(text)} has nothing before its = sign: write key = value")
    return Entry(shown(key), match[2].strip(), number)


def _twice(key: str, first: Entry) -> str:
    if key.lower() == first.key.lower():
        return f"{key} is given a second time, after line {first.line}: keep one of the two lines"
    return f"{key} means the same as {first.key} in line {first.line}: keep one of the two lines"


def _read(path: str | PathLike[str]) -> str:
    """Return the file's text. Latin-1 is accepted, too, because comments may use it."""
    try:
        with opened(path) as file:
            data = file.read(LONGEST_FILE + 1)
    except FileNotFoundError:
        raise refusal(path, 0, f"there is no such file: {_instead(Path(path))}") from None
    except (OSError, ValueError) as error:
        if os.path.isdir(path):
            problem = f"this is a folder, not a file: {_instead(Path(path) / 'x')}"
        else:
            reason = getattr(error, "strerror", None) or error
            problem = f"it cannot be read ({reason}): check its name and permissions"
        raise refusal(path, 0, problem) from None
    if len(data) > LONGEST_FILE or re.search(rb"[\x00-\x08\x0e-\x1f\x7f]", data):
        raise refusal(path, 0, "this is no experiment file: give an .ini file of plain UTF-8 text")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        return data.decode("latin-1")


def _instead(path: Path) -> str:
    """Return a hint in place of a missing file: the .ini files of its folder."""
    folder = "this folder" if path.parent == Path() else f"the folder {path.parent}"
    try:
        found = sorted(file.name for file in path.parent.iterdir() if file.suffix.lower() == ".ini")
    except OSError:
        return f"{folder} does not exist or cannot be read, check the path"
    if not found:
        return f"{folder} holds no .ini file, check the path"
    close = difflib.get_close_matches(path.name, found, n=1)
    more = ", ..." if len(found) > 10 else ""
    listing = f"{folder} holds {', '.join(found[:10])}{more}"
    return f"did you mean {close[0]} ({listing})?" if close else listing
