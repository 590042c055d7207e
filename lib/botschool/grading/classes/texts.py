"""Read the text of a submitted file, whatever its encoding."""

from __future__ import annotations

import codecs
import html.parser
import json
import re
from typing import Any

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
_BLOCKS = {"p", "div", "br", "li", "tr", "pre", "h1", "h2", "h3", "h4", "table", "ul", "ol"}


def decoded(content: bytes) -> tuple[str, str]:
    """Return the text of a Python file and the name of its encoding; "" for plain UTF-8."""
    for mark, codec, name in MARKS:
        if content.startswith(mark):
            return content.decode(codec, "replace"), name
    for codec, first in (("utf-16-le", 1), ("utf-16-be", 0)):
        if content[first:100:2].count(0) > 20 and len(content) % 2 == 0:
            return content.decode(codec, "replace"), "UTF-16 without a mark"
    if b"\0" in content:  # which no program may hold; they fill up a damaged file
        text, name = decoded(content.replace(b"\0", b""))
        return text, f"{name or 'UTF-8'} with zero bytes"
    if content.isascii():
        return content.decode("ascii"), ""
    for line in content.split(b"\n", 2)[:2]:
        found = COOKIE.match(line.decode("latin-1"))
        if found:
            try:
                codec = codecs.lookup(found[2]).name
                text = content.decode(codec)
            except (LookupError, UnicodeError, ValueError):
                break
            if not isinstance(text, str) or codec in ("utf-8", "ascii"):
                break
            return text, found[2]
    try:
        return content.decode("utf-8"), ""
    except UnicodeDecodeError:
        return content.decode("latin-1"), "Latin-1 (it does not say so)"


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
    """Return a notebook in the present format; Jupyter 1 to 2 had another."""
    try:
        found = json.loads(notebook)
        if "worksheets" not in found:
            return notebook
        cells = [cell for sheet in found["worksheets"] for cell in sheet["cells"]]
        made = [
            {"cell_type": "code", "metadata": {}, "source": cell["input"], "outputs": []}
            for cell in cells
            if cell["cell_type"] == "code"
        ]
    except (ValueError, LookupError, TypeError, RecursionError):
        return notebook
    return json.dumps({"cells": made, "metadata": {}, "nbformat": 4, "nbformat_minor": 5})


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


def without_jupyter(text: str) -> str:
    """Return a script without the lines that only a notebook understands."""
    return _JUPYTER.sub(r"\1pass  # \2", text)


def text_of_page(page: str) -> str:
    """Return the text typed into a web page's editor, line by line."""
    reader = _Page()
    reader.feed(page)
    reader.close()
    text = "".join(reader.parts).replace("\xa0", " ").replace("\u200b", "")
    return re.sub(r"\n{3,}", "\n\n", text.replace("\r\n", "\n")).strip("\n") + "\n"


class _Page(html.parser.HTMLParser):
    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.parts: list[str] = []
        self._skipped = 0
        self._preformatted = 0

    def handle_starttag(self, tag: str, attributes: list) -> None:
        if tag in ("script", "style", "head"):
            self._skipped += 1
        self._preformatted += tag == "pre"
        if tag in _BLOCKS:
            self._end_line(always=tag == "br")

    def handle_startendtag(self, tag: str, attributes: list) -> None:
        if tag in _BLOCKS:
            self._end_line(always=tag == "br")

    def handle_endtag(self, tag: str) -> None:
        if tag in ("script", "style", "head"):
            self._skipped = max(0, self._skipped - 1)
        self._preformatted = max(0, self._preformatted - (tag == "pre"))
        if tag in _BLOCKS - {"br"}:
            self._end_line(always=False)

    def handle_data(self, data: str) -> None:
        if self._skipped:
            return
        ended = not self.parts or self.parts[-1].endswith("\n")
        if ended and not self._preformatted:
            data = data.lstrip("\r\n")  # the page's own line end after <br> or <p>
        if data:
            self.parts.append(data)

    def _end_line(self, always: bool) -> None:
        if always or (self.parts and not self.parts[-1].endswith("\n")):
            self.parts.append("\n")
