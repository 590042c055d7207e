"""Write the page of an exercise: pictures, films, replays, the questions and their answers."""

from __future__ import annotations

import re
from base64 import b64encode
from dataclasses import dataclass
from fnmatch import fnmatch
from html import escape
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import Exercise, folder_of
from botschool.grading.report.progress import answers
from botschool.output import save_bytes

PAGE = "all.html"
"""The page in results/exNN."""
_KINDS = {".png": "image/png", ".mp4": "video/mp4", ".html": "text/html"}
_QUESTIONS = re.compile(r"^## Questions[^\n]*\n(.*?)(?=^## |\Z)", re.DOTALL | re.MULTILINE)
_MADE = re.compile(
    r"^- `([^`\s]+\.(?:png|mp4|html))`: (.+?)(?=^- |^$|\Z)", re.DOTALL | re.MULTILINE
)
"""In the text of an exercise: a file that it makes, and what to look for in it."""
_LINK = re.compile(r"(?<!!)\[([^\]]*)\]\((?!https?:)[^)]*\)")
_STYLE = """
:root { color-scheme: light dark;
  --page: #fbfaf7; --ink: #22262b; --soft: #5d6670; --line: #d9d6cf }
@media (prefers-color-scheme: dark) {
  :root { --page: #14171b; --ink: #e6e8ea; --soft: #9aa4ae; --line: #343a41 }
}
* { box-sizing: border-box }
body { font: 17px/1.55 system-ui, sans-serif; max-width: 62rem; margin: 0 auto; padding: 1rem;
  background: var(--page); color: var(--ink) }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 1.5rem 0 .3rem } h2 { margin-top: 2.5rem }
figure { margin: 2rem 0 } figcaption { color: var(--soft); max-width: 44rem; margin: .5rem auto 0 }
img, video { display: block; max-width: 100%; max-height: 85vh; margin: 0 auto; background: #fff;
  border-radius: 8px }
video { width: 40rem }
iframe { width: 100%; height: min(46rem, 92vh); border: 1px solid var(--line); border-radius: 8px }
@media (max-width: 820px) { iframe { height: 60rem } }
table { border-collapse: collapse; display: block; overflow-x: auto }
td, th { border-bottom: 1px solid var(--line); padding: .25rem .6rem; text-align: left }
pre { overflow-x: auto } code { font-size: .9em; overflow-wrap: anywhere }
summary { cursor: pointer; font-weight: 600 } footer { color: var(--soft); margin: 3rem 0 1rem }
"""


@dataclass
class Shown:
    """A picture, film or replay of the page."""

    path: Path
    says: str
    """What to look for in it."""


def captions(number: int, root: Path) -> dict[str, str]:
    """Return what the exercise's text says about each file that the finished exercise makes."""
    text = folder_of(number, root) / "README.md"
    found = _MADE.findall(text.read_text(encoding="utf-8")) if text.is_file() else []
    return {name: " ".join(f"{says[:1].upper()}{says[1:]}".split()) for name, says in found}


def captioned(exercise: Exercise, made: list[Path], root: Path) -> list[Shown]:
    """Return the files of a finished exercise that the page shows, in the order of its captions.

    A film is left out if there is a replay of the same name.
    """
    names = {path.name for path in made}
    said = captions(exercise.number, root)
    order = list(said)
    found = []
    for path in made:
        if path.suffix not in _KINDS or path.name == PAGE:
            continue
        if path.suffix == ".mp4" and path.with_suffix(".html").name in names:
            continue
        named = [k for k in order if fnmatch(path.name, k) or fnmatch(path.name, _film(k))]
        place = order.index(named[0]) if named else len(order)
        says = said[named[0]] if named else path.stem.replace("_", " ").capitalize()
        found.append((place, Shown(path, says)))
    return [shown for _, shown in sorted(found, key=lambda each: each[0])]


def _film(name: str) -> str:
    return re.sub(r"\.mp4$", ".html", name)


def write_album(
    exercise: Exercise, shown: list[Shown], folder: Path, root: Path, more: str
) -> Path:
    """Write the page into the folder, with everything in it; return its path.

    more: a sentence on what comes next; "" for a finished exercise, whose page ends with the
    questions, and with the answers after full marks. Raises BotschoolError.
    """
    title = f"Exercise {exercise.number}. {exercise.title}"
    parts = [f"<h1>{escape(title)}</h1>", *map(_figure, shown)]
    if more:
        parts.append(f"<h2>Next</h2><p>{_html(more)}</p>")
    else:
        parts += [_questions(exercise.number, root), _answers(exercise.number, root)]
    parts.append(
        "<footer>Made with botschool. All of it is in this file: send it to a friend.</footer>"
    )
    head = (
        '<!doctype html><html lang="en"><meta charset="utf-8"><meta name="viewport" '
        f'content="width=device-width"><link rel="icon" href="data:,">'
        f"<title>{escape(title)}</title><style>{_STYLE}</style>"
    )
    save_bytes(folder / PAGE, "\n".join([head, *filter(None, parts), ""]).encode())
    return folder / PAGE


def _figure(shown: Shown) -> str:
    content, says = shown.path.read_bytes(), _html(shown.says)
    kind = _KINDS[shown.path.suffix]
    alt = escape(re.sub(r"[`*]", "", shown.says), quote=True)
    if kind == "text/html":
        page = escape(content.decode(), quote=True)
        tag = f'<iframe loading="lazy" title="{alt}" srcdoc="{page}"></iframe>'
    else:
        data = f"data:{kind};base64,{b64encode(content).decode()}"
        tag = f'<img src="{data}" alt="{alt}">'
        if kind == "video/mp4":
            how = "autoplay muted loop playsinline controls"
            tag = f'<video src="{data}" aria-label="{alt}" {how}></video>'
    return f"<figure>{tag}<figcaption>{says}</figcaption></figure>"


def _html(text: str) -> str:
    from markdown_it import MarkdownIt

    return MarkdownIt("commonmark", {"html": False}).renderInline(text)


def _blocks(text: str) -> str:
    from markdown_it import MarkdownIt

    markdown = MarkdownIt("commonmark", {"html": False}).enable("table")
    return markdown.render(_LINK.sub(r"\1", text))


def _questions(number: int, root: Path) -> str:
    text = folder_of(number, root) / "README.md"
    found = _QUESTIONS.search(text.read_text(encoding="utf-8")) if text.is_file() else None
    return f"<h2>Questions to think about</h2>{_blocks(found[1])}" if found else ""


def _answers(number: int, root: Path) -> str:
    """Return the answers after full marks, else why they are not there."""
    try:
        text = answers(number, root)
    except BotschoolError as error:
        return f"<p><small>{escape(str(error))}</small></p>"
    body = _blocks(text.partition("\n")[2])
    return f"<details><summary>Our answers</summary>{body}</details>"
