"""Read the text of a submitted file, whatever its encoding."""

from __future__ import annotations

import codecs
import contextlib
import html
import json
import re
from typing import Any

MAX_TEXT, MAX_NOTEBOOK = 4 * 2**20, 50 * 2**20
"""Bytes of a file that may be an exercise's, and of a notebook with its pictures."""
MARKS = (
    (codecs.BOM_UTF8, "utf-8-sig", "UTF-8 with a mark"),
    (codecs.BOM_UTF32_LE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF32_BE, "utf-32", "UTF-32"),
    (codecs.BOM_UTF16_LE, "utf-16", "UTF-16"),
    (codecs.BOM_UTF16_BE, "utf-16", "UTF-16"),
)
COOKIE = re.compile(r"^([ \t\f]*#.*?coding[:=][ \t]*)([-\w.]+)", re.ASCII)
_JUPYTER = re.compile(
    r"^([ \t]*)(get_ipython\(\)|(?<![ \t])(?:%(?:matplotlib|load_ext|autoreload|pip)\b|!\w))",
    re.MULTILINE,
)
_INVISIBLE = re.compile("[\x1a\u200b-\u200f\u202a-\u202e\u2060\u2066-\u2069\ufeff]")
_CODE = re.compile(r"^[^\n'\"#]*", re.MULTILINE)
"""The beginning of a line, up to its first text or comment."""


def decoded(content: bytes) -> tuple[str, str]:
    """Return the text of a Python file and the name of its encoding; "" for plain UTF-8."""
    for mark, codec, name in MARKS:
        if content.startswith(mark):
            return content.decode(codec, "replace").lstrip("\ufeff"), name
    for codec, first in (("utf-16-le", 1), ("utf-16-be", 0)):
        if content[first:100:2].count(0) > 20 and len(content) % 2 == 0:
            return content.decode(codec, "replace"), "UTF-16 without a mark"
    if b"\0" in content:  # which no program may hold; they fill up a damaged file
        text, name = decoded(content.replace(b"\0", b""))
        return text, f"{name or 'UTF-8'} with zero bytes"
    if content.isascii() and not _said(content):
        return content.decode("ascii"), ""
    said = _said(content)
    with contextlib.suppress(LookupError, UnicodeError, ValueError):
        text = content.decode(codecs.lookup(said).name)
        if isinstance(text, str):
            plain = codecs.lookup(said).name in ("utf-8", "ascii")
            return text, "" if plain else said
    try:
        return content.decode("utf-8"), f"UTF-8, although it says {said}" if said else ""
    except UnicodeDecodeError:
        return content.decode("latin-1"), "Latin-1 (it does not say so)"


def _said(content: bytes) -> str:
    """Return the encoding that a program's first two lines declare; "" if none."""
    for line in content.split(b"\n", 2)[:2]:
        if found := COOKIE.match(line.decode("latin-1")):
            return found[2]
    return ""


def is_larger(value: Any, most: int) -> bool:
    """Return whether plain data holds more than `most` values, each alias counted as often as used.

    A few lines of YAML with aliases make billions of values, which take no memory until they are
    copied or shown.
    """
    waiting, count = [value], 0
    while waiting:
        each = waiting.pop()
        inner = [*each, *each.values()] if isinstance(each, dict) else each
        if isinstance(inner, list):
            count += len(inner)
            if count > most:
                return True
            waiting += inner
    return False


def without_cookie(text: str) -> str:
    """Return a text with UTF-8 in its encoding declaration, if it has one."""
    lines = text.split("\n", 2)
    return "\n".join(
        [*(COOKIE.sub(r"\g<1>utf-8", line) for line in lines[:2]), *lines[2:]],
    )


def is_notebook(text: str) -> bool:
    """Return whether a text looks like a saved notebook, whatever its name."""
    return text.lstrip().startswith("{") and ('"cells"' in text or '"worksheets"' in text)


def today(notebook: str) -> str:
    """Return a notebook in the present format and with plain cells, if it is not so.

    Jupyter 1 to 2 had another format. A cell that writes a file holds a program. A notebook of more
    than MAX_TEXT characters loses its outputs and pictures.
    """
    if len(notebook) <= MAX_TEXT and not re.search(r'"worksheets"|%%writefile', notebook):
        return notebook
    try:
        found = json.loads(notebook)
        sheets = found.get("worksheets", [found])
        cells = [_plain_cell(cell) for sheet in sheets for cell in sheet["cells"]]
    except (ValueError, LookupError, TypeError, AttributeError, RecursionError):
        return notebook
    return json.dumps({"cells": cells, "metadata": {}, "nbformat": 4, "nbformat_minor": 4})


def _plain_cell(cell: dict[str, Any]) -> dict[str, Any]:
    kind, text = cell["cell_type"], cell.get("source", cell.get("input", ""))
    text = text if isinstance(text, str) else "".join(text)
    made = {"cell_type": kind, "metadata": {}, "source": text}
    if kind == "code":
        made["source"] = re.sub(r"^\s*%%writefile\b.*\n?", "", text)
        made |= {"outputs": [], "execution_count": None}
    return made


def code_of_notebook(text: str) -> str:
    """Return the code of a notebook; "" if it cannot be read."""
    try:
        cells = json.loads(today(text))["cells"]
        sources = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    except (ValueError, LookupError, TypeError, RecursionError):
        return ""
    return "\n".join(sources)


def code_of_fences(text: str) -> str:
    """Return the code between ``` and ``` in a Markdown text, or else all of it."""
    blocks = re.findall(r"^```.*\n([\s\S]*?)^```", text, re.MULTILINE)
    return "\n".join(blocks) or text


def without_invisible(text: str) -> str:
    """Return a script without the invisible characters that Python refuses."""
    text = _INVISIBLE.sub("", text)
    return _CODE.sub(lambda code: code[0].replace("\xa0", " "), text) if "\xa0" in text else text


def without_jupyter(text: str) -> str:
    """Return a script without the lines that only a notebook understands."""
    return _JUPYTER.sub(r"\1pass  # \2", text)


def text_of_page(page: str) -> str:
    """Return the program in a web page, line by line.

    This is the highlighted code, as in the page that Jupyter makes of a notebook; else the
    preformatted text, if it has functions; else all text, with headings as comments. Python's own
    parser takes time with the square of the length of a hostile page.
    """
    shown: list[str] = []
    preformatted: list[str] = []
    highlighted: list[str] = []
    hidden, divs = 0, [0]  # how many elements `highlight` are open, within each <div>
    begin: int | None = None  # of the preformatted text
    for found in _PIECE.finditer(_without_comments(page)):
        end, tag, inside = found[1], (found[2] or "").lower(), found[3] or ""
        begins_line = not shown or shown[-1].endswith("\n")
        if tag in _HIDDEN:
            hidden = max(0, hidden + (-1 if end else 1))
        if tag == "div" and end and len(divs) > 1:
            divs.pop()
        elif tag == "div" and not end:
            classes = _CLASS.search(inside)
            divs.append(divs[-1] + bool(classes and "highlight" in classes[1].split()))
        if tag == "pre" and end and begin is not None:
            preformatted.append("".join(shown[begin:]))
            highlighted += preformatted[-1:] * bool(divs[-1])
            begin = None
        if not tag and not found[0].startswith(("<!", "<?")) and not hidden:
            text = html.unescape(found[0])
            if begins_line and begin is None:
                text = text.lstrip("\r\n")  # the page's own line end after <br> or <p>
            shown += [text] * bool(text)
        if (tag in _BLOCKS and not begins_line) or (tag == "br" and not end):
            shown.append("\n")
        if not end and tag in _HEADINGS:
            shown.append("# ")
        if not end and tag == "pre":
            begin = len(shown)
    programs = ["\n".join(highlighted), "\n".join(preformatted)]
    chosen = (text for text in programs if re.search(r"^(def|class) ", text, re.MULTILINE))
    text = next(chosen, "".join(shown))
    text = text.replace("\r\n", "\n").replace("\xa0", " ").replace("\u200b", "")
    return re.sub(r"\n{3,}", "\n\n", text).strip("\n") + "\n"


_PIECE = re.compile(r"<(/?)([a-zA-Z][a-zA-Z0-9]*)((?:[^a-zA-Z0-9<>][^<>]*)?)>|<[!?][^<>]*>|[^<]+|<")
"""A tag of a web page, or a piece of its text."""
_CLASS = re.compile(r"""\bclass *= {0,9}["']?([^"'<>]*)""", re.IGNORECASE)
_BLOCKS = {"p", "div", "li", "tr", "pre", "h1", "h2", "h3", "h4", "table", "ul", "ol"}
_HEADINGS, _HIDDEN = {"h1", "h2", "h3", "h4"}, {"script", "style", "head"}


def _without_comments(page: str) -> str:
    """Return a page without its comments; a comment without an end reaches to the page's."""
    first, *others = page.split("<!--")
    return first + "".join(part.partition("-->")[2] for part in others)
