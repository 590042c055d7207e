"""Render a text of the course for a page: Markdown, formulas as MathML, pictures inside it."""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Callable
from html import escape
from io import BytesIO
from pathlib import Path
from typing import Any
from urllib.parse import unquote

FIGURE = re.compile(r"^<!-- figure: (\w+) -->$", re.MULTILINE)
"""A line of a text: a figure that answers the hand stands here."""


def render(text: str, folder: Path, link: Callable[[str], str] = lambda target: target) -> str:
    """Return a text as HTML.

    folder: where the text lies, so that its pictures are found. link: turns the target of a link to
    a file into that of the page.
    """
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": True}).enable("table")
    markdown.inline.ruler.before("escape", "formula", _formula)
    markdown.add_render_rule("formula", _draw_formula)
    markdown.add_render_rule("table_open", lambda *_: '<div class="scroll"><table>')
    markdown.add_render_rule("table_close", lambda *_: "</table></div>")
    tokens = markdown.parse(
        FIGURE.sub(r'<section class="figure" data-figure="\1"></section>', text)
    )
    for token in (part for each in tokens for part in each.children or ()):
        if token.type == "image":
            token.attrs["src"] = picture(folder / unquote(str(token.attrs["src"])))
        elif token.type == "link_open" and ":" not in str(token.attrs["href"]):
            token.attrs["href"] = link(str(token.attrs["href"]))
    return markdown.renderer.render(tokens, markdown.options, {})


def picture(path: Path) -> str:
    """Return a picture as a URL that holds it, as WebP where that is smaller."""
    from PIL import Image

    content, kind = path.read_bytes(), "svg+xml" if path.suffix == ".svg" else path.suffix[1:]
    if kind == "png":
        smaller = BytesIO()
        Image.open(path).convert("RGBA").save(smaller, "WEBP", lossless=True, method=4)
        content, kind = min(
            (content, kind), (smaller.getvalue(), "webp"), key=lambda one: len(one[0])
        )
    return f"data:image/{kind};base64,{b64encode(content).decode()}"


def _formula(state: Any, silent: bool) -> bool:
    """Read $...$ or $$...$$ as a formula; a rule of markdown-it."""
    found = re.compile(r"\$\$([^$]+)\$\$|\$([^$\s](?:[^$]*[^$\s])?)\$").match(state.src, state.pos)
    if not found:
        return False
    if not silent:
        token = state.push("formula", "math", 0)
        token.content, token.block = found[1] or found[2], bool(found[1])
    state.pos = found.end()
    return True


def _draw_formula(renderer: Any, tokens: Any, index: int, options: Any, env: Any) -> str:
    from latex2mathml.converter import convert

    token = tokens[index]
    text = re.sub(r"\\(operatorname|mathrm)\{([^}]*)\}", _word, token.content)
    formula = convert(text, display="block" if token.block else "inline")
    return formula.replace("<math ", f'<math aria-label="{escape(token.content, quote=True)}" ', 1)


def _word(found: re.Match) -> str:
    """Return a word of a formula as text, which a page sets without gaps."""
    return rf"\text{{{found[2]}}}".replace(r"\ ", " ")
