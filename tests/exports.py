"""Exports of learning platforms for tests: the same submissions as each platform writes them."""

import gzip
import html
import io
import json
import tarfile
import zipfile
from dataclasses import dataclass, field
from pathlib import Path


@dataclass
class Handed:
    """A person's submission: names of files, with folders, and their content."""

    name: str
    files: dict[str, bytes]
    late: bool = False
    attempts: list[dict[str, bytes]] = field(default_factory=list)
    """Earlier attempts."""
    typed: str = ""
    """Text typed into the platform's page instead."""


def notebook(*cells: str) -> bytes:
    """Return a notebook with these code cells, each after a text."""
    made = []
    for cell in cells:
        made.append({"cell_type": "markdown", "metadata": {}, "source": ["Some *text*"]})
        made.append(
            {"cell_type": "code", "metadata": {}, "source": cell.splitlines(keepends=True),
             "outputs": [], "execution_count": None}
        )  # fmt: skip
    return json.dumps({"cells": made, "metadata": {}, "nbformat": 4, "nbformat_minor": 5}).encode()


def zipped(files: dict[str, bytes], top: str = "") -> bytes:
    """Return a zip file with these files."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(top + name, content)
    return buffer.getvalue()


def of_tar(files: dict[str, bytes], mode: str = "w:gz") -> bytes:
    """Return a .tar.gz with these files, or what another mode makes."""
    buffer = io.BytesIO()
    with tarfile.open(fileobj=buffer, mode=mode) as archive:
        for name, content in files.items():
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
    return buffer.getvalue()


def page_of_jupyter(*cells: str) -> bytes:
    """Return the web page that Jupyter makes of a notebook, with outputs."""
    made = "".join(
        f'<div class="cell"><div class="prompt">In [{i}]:</div><div class="highlight hl-ipython3">'
        f"<pre><span></span>{html.escape(cell)}</pre></div>"
        f'<div class="output"><pre>def not_code(): {i}</pre></div></div>'
        for i, cell in enumerate(cells)
    )
    return f"<!DOCTYPE html><html><body><h1>Tiny</h1><p>Some text</p>{made}</body></html>".encode()


def old_notebook(*cells: str) -> bytes:
    """Return a notebook in the format of Jupyter 1 and 2."""
    made = [{"cell_type": "code", "input": cell, "outputs": []} for cell in cells]
    return json.dumps({"worksheets": [{"cells": made}], "metadata": {}, "nbformat": 3}).encode()


def variations(file: str, solution: str, skeleton: str) -> dict[str, dict[str, bytes]]:
    """Return ways to submit one right solution, all of which deserve full marks."""
    stem, text = file.removesuffix(".py"), solution.encode()
    latin = f"# -*- coding: latin-1 -*-\n# J\u00fcrgen\n{solution}".encode("latin-1")
    spaced = stem.replace("_", " ").title()
    return {
        "plain": {file: text},
        "second download": {f"{stem} (1).py": text},
        "number": {f"{stem}-1.py": text},
        "final": {f"{stem}_final.py": text},
        "capitals": {f"{stem.title()}.PY": text},
        "spaces": {f"{spaced} final version.py": text},
        "text suffix": {f"{file}.txt": text},
        "in the exercise's folder": {f"ex03_tiny/{file}": text},
        "in some folder": {f"my work/week 3/{file}": text},
        "the whole course": {
            f"course/exercises/ex03_tiny/{file}": text,
            "course/exercises/ex03_tiny/README.md": b"# Tiny\n",
            "course/README.md": b"# The course\n",
        },
        "a zip file": {"work.zip": zipped({file: text})},
        "a zip file in a zip file": {
            "all.zip": zipped({"inner.zip": zipped({f"a/{file}": text}), "__MACOSX/._x": b"x"})
        },
        "a notebook": {f"{stem}.ipynb": notebook(*solution.split("\n\n\n"))},
        "another notebook": {"Untitled1.ipynb": notebook(solution)},
        "another name": {"main.py": text},
        "UTF-8 with a mark": {file: b"\xef\xbb\xbf" + text},
        "UTF-16": {file: f"# J\u00fcrgen\n{solution}".encode("utf-16")},
        "Latin-1 that says so": {file: latin},
        "Latin-1": {file: f"# J\u00fcrgen\n{solution}".encode("latin-1")},
        "line ends of Windows": {file: solution.replace("\n", "\r\n").encode()},
        "beside the skeleton": {file: skeleton.encode(), f"{stem}_final.py": text},
        "the skeleton deeper": {file: text, f"backup/{file}": skeleton.encode()},
        "with what systems leave": {
            file: text, ".DS_Store": b"x", "__pycache__/tiny.cpython-311.pyc": b"x",
            "__MACOSX/._tiny.py": b"x", "Thumbs.db": b"x",
        },
        "UTF-16 without a mark": {file: solution.encode("utf-16-be")},
        "zero bytes at its end": {file: text + bytes(9)},
        "a notebook of old": {f"{stem}.ipynb": old_notebook(*solution.split("\n\n\n"))},
        "a notebook called script": {file: notebook(solution)},
        "a notebook called json": {f"{stem}.ipynb.json": notebook(solution)},
        "a script called notebook": {f"{stem}.ipynb": text},
        "a script called zip": {f"{stem}.zip": text},
        "in Markdown": {f"{stem}.md": b"My work:\n```python\n" + text + b"```\n"},
        "a zip file called script": {file: zipped({file: text})},
        "a zip file without suffix": {"work": zipped({file: text})},
        "roots and drives": {"work.zip": zipped({f"/home/ada/C:\\work\\{file}": text})},
        "a name too long": {"work.zip": zipped({f"{'x' * 250}/{file}": text})},
        "five zip files deep": {"a.zip": zipped({"b.zip": zipped({"c.zip": zipped({
            "d.zip": zipped({"e.zip": zipped({file: text})})})})})},
        "a tar file": {"work.tar.gz": of_tar({f"a/{file}": text})},
        "compressed": {f"{file}.gz": gzip.compress(text)},
        "empty beside it": {file: b"", f"{stem}_final.py": text},
        "a virtual environment": {"env/pyvenv.cfg": b"x", f"env/lib/{file}": b"x", file: text},
        "with a report": {file: text, "report/report.pdf": b"%PDF"},
        "a copy made by Windows": {f"{stem} - Kopie.py": text, file: skeleton.encode()},
        "a browser's suffix": {f"{file}.download": text},
        "a backup's suffix": {f"{file}.bak": text},
        "another system's name": {f"\u200f{file}.": text},
        "a zip file called rar": {"work.rar": zipped({file: text})},
        "a tar file of Windows": {"work.tbz2": of_tar({f"a/{file}": text}, "w:bz2")},
        "a tar file without suffix": {"work": of_tar({f"a/{file}": text})},
        "a tar file of texts": {"work.tar": of_tar({file: text}, "w")},
        "two marks": {file: b"\xef\xbb\xbf" * 2 + text},
        "a wrong coding line": {file: f"# coding: ascii\n# J\u00fcrgen\n{solution}".encode()},
        "spaces of a web page": {file: solution.replace("    ", "\u00a0   ").encode()},
        "an invisible character": {file: solution.replace("def ", "\u200bdef ", 1).encode()},
        "a page of Jupyter": {f"{stem}.html": page_of_jupyter(solution)},
        "a page called script": {
            file: f"<!DOCTYPE html><h1>Tiny</h1><pre>{html.escape(solution)}</pre>".encode()
        },
        "a notebook that writes a file": {f"{stem}.ipynb": notebook(f"%%writefile x\n{solution}")},
        "only what Jupyter keeps": {
            f".ipynb_checkpoints/{stem}-checkpoint.ipynb": notebook(solution), "notes.txt": b"x"
        },
        "in Quarto": {f"{stem}.qmd": b"My work:\n```{python}\n" + text + b"```\n"},
        "too deep": {"work.zip": zipped({f"{'d/' * 40}{file}": text})},
    }  # fmt: skip


def class_of(file: str, solution: str, skeleton: str) -> list[Handed]:
    """Return a person for each variation."""
    return [
        Handed(f"Per{chr(97 + i // 26)}{chr(97 + i % 26)} S\u00f8n{i}", files)
        for i, files in enumerate(variations(file, solution, skeleton).values())
    ]


# --- platforms; each function returns the files of the export
def moodle(people: list[Handed], underscore: bool = True) -> dict[str, bytes]:
    """Return Moodle's folders, with or without the last underscore of their names."""
    made = {}
    for number, one in enumerate(people, 1234560):
        top = f"{one.name}_{number}_assignsubmission_"
        for name, content in one.files.items():
            made[f"{top}file{'_' * underscore}/{name}"] = content
        if one.typed:
            lines = [html.escape(line).replace("  ", "&nbsp; ") for line in one.typed.splitlines()]
            page = "<p>" + "<br>\n".join(lines) + "</p>"
            made[f"{top}onlinetext{'_' * underscore}/onlinetext.html"] = page.encode()
    return made


def moodle_loose(people: list[Handed]) -> dict[str, bytes]:
    """Return Moodle's export without folders; sub-folders are part of the names."""
    return {
        f"{one.name}_{number}_assignsubmission_file_{name}": content
        for number, one in enumerate(people, 1234560)
        for name, content in one.files.items()
    }


def canvas(people: list[Handed]) -> dict[str, bytes]:
    """Return Canvas's flat files; a submission with folders is a zip file."""
    made = {}
    for number, one in enumerate(people, 400):
        short = "".join(one.name.lower().split()[::-1])
        top = f"{short}_{'LATE_' * one.late}{number}_{number + 90000}_"
        tries = [*one.attempts, one.files]
        for attempt, files in enumerate(tries):
            if any("/" in name for name in files):
                files = {"work.zip": zipped(files)}
            for name, content in files.items():
                stem, dot, suffix = name.rpartition(".")
                name = f"{stem}-{attempt}{dot}{suffix}" if attempt else name
                made[top + name] = content
    return made


def gradescope(people: list[Handed]) -> dict[str, bytes]:
    """Return Gradescope's folders, with a list of the people beside them."""
    made, lines = {}, ["---"]
    for number, one in enumerate(people, 300001):
        for name, content in one.files.items():
            made[f"submission_{number}/{name}"] = content
        lines += [
            f"submission_{number}:",
            "  :submitters:",
            f"  - :name: {one.name}",
            f"    :sid: '{number}'",
            f"    :email: p{number}@example.org",
            "  :created_at: 2026-11-20 21:14:03.563510000 Z",
            "  :score: 0.0",
        ]
    made["submission_metadata.yml"] = "\n".join(lines).encode()
    return {f"assignment_77_export/{name}": content for name, content in made.items()}


def github(people: list[Handed]) -> dict[str, bytes]:
    """Return clones, as the command of a class makes them."""
    made = {}
    for one in people:
        user = "".join(letter for letter in one.name.lower() if letter.isascii() and letter != " ")
        top = f"tiny-submissions/tiny-{user}"
        made[f"{top}/.git/HEAD"] = b"ref: refs/heads/main\n"
        for name, content in one.files.items():
            made[f"{top}/{name}"] = content
    return made


def folders(people: list[Handed]) -> dict[str, bytes]:
    """Return a folder for each person, as nbgrader and most own scripts write."""
    return {f"{one.name}/{name}": content for one in people for name, content in one.files.items()}


PLATFORMS = {
    "moodle": moodle,
    "moodle without underscore": lambda people: moodle(people, underscore=False),
    "moodle loose": moodle_loose,
    "canvas": canvas,
    "gradescope": gradescope,
    "github": github,
    "folders": folders,
}


def written(folder: Path, files: dict[str, bytes]) -> Path:
    """Write the files of an export into a folder."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return folder


def saved(path: Path, files: dict[str, bytes]) -> Path:
    """Write the files of an export into a zip file."""
    path.write_bytes(zipped(files))
    return path
