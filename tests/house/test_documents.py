"""The repository explains itself: what its files refer to is in it."""

import posixpath
import re
import subprocess
from functools import cache
from pathlib import Path

import pytest

from botschool import config

ROOT = Path(__file__).parents[2]
SPECIFICATION = "docs/specification.md"

OUTSIDE = re.compile(r"\b(?:FACTS|DESIGN|COURSE)\.md|\.\./shared\b|\bchapter\.txt")
"""Documents that are not in the repository."""

LINK = re.compile(r"\]\(\s*<?([^)\s>]+)")
DOCUMENT = re.compile(r"(?<![\w./-])docs/(?:reports/)?[\w-]+\.md")
CITATION = re.compile(r'docs/specification\.md[`)]*,((?:(?:,| and|, and)? "[^"]+")+)')
WRAPPED = re.compile(r"[ \t]*\n[ \t]*(?://+|#+|\*|>)?[ \t]*")
"""The end of a line, with what a comment begins the next one."""


@cache
def tracked() -> frozenset[str]:
    """Paths of all files under version control, from the root, with forward slashes."""
    try:
        listed = subprocess.run(
            ["git", "ls-files", "-z"], cwd=ROOT, capture_output=True, check=True, text=True
        ).stdout
    except (OSError, subprocess.CalledProcessError):
        pytest.skip("this is no git checkout, so it cannot be said which files are tracked")
    return frozenset(name for name in listed.split("\0") if name and (ROOT / name).is_file())


@cache
def texts() -> dict[str, str]:
    """The tracked files that are text, by path."""
    found = {}
    for name in sorted(tracked()):
        try:
            found[name] = (ROOT / name).read_bytes().decode()
        except UnicodeDecodeError:
            continue
    return found


def headings(markdown: str) -> list[str]:
    """The headings of a document, without marks."""
    return [
        line.lstrip("#").strip().replace("`", "")
        for line in without_code(markdown).split("\n")
        if re.match(r"#{1,6} ", line)
    ]


def anchors(markdown: str) -> set[str]:
    """What a link to a heading is called, after the #."""
    return {
        re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in headings(markdown)
    }


def without_code(markdown: str) -> str:
    """The document with its blocks of code blanked."""
    return re.sub(r"^```.*?^```", "", markdown, flags=re.MULTILINE | re.DOTALL)


def broken_links(name: str, markdown: str, files: dict[str, str] | frozenset[str]) -> list[str]:
    """Relative links that lead to no tracked file or folder, or to no heading."""
    folders = {str(parent) for file in files for parent in Path(file).parents}
    broken = []
    for target in LINK.findall(without_code(markdown)):
        if re.match(r"[a-z][a-z+.-]*:", target):
            continue
        path, _, anchor = target.partition("#")
        place = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
        there = markdown if place == name else texts().get(place, "")
        exists = place == name or place in files or place in folders
        if not exists or (anchor and place.endswith(".md") and anchor not in anchors(there)):
            broken.append(target)
    return broken


def cited_sections(text: str) -> list[str]:
    """Sections of the specification that a text cites, also across the lines of a comment."""
    return [
        section
        for names in CITATION.findall(WRAPPED.sub(" ", text))
        for section in re.findall(r'"([^"]+)"', names)
    ]


@pytest.mark.slow
def test_no_file_refers_to_a_document_outside_the_repository():
    found = [f"{name}: {match[0]}" for name in texts() for match in OUTSIDE.finditer(texts()[name])]
    assert not found


@pytest.mark.slow
def test_every_link_of_a_document_leads_somewhere():
    broken = {
        name: links
        for name, text in texts().items()
        if name.endswith(".md") and (links := broken_links(name, text, tracked()))
    }
    assert not broken


def test_every_document_that_is_named_exists():
    missing = {
        f"{name}: {document}"
        for name, text in texts().items()
        if not name.startswith("tests/")
        for document in DOCUMENT.findall(text)
        if document not in tracked()
    }
    assert not missing


def test_every_cited_section_of_the_specification_exists():
    known = headings(texts()[SPECIFICATION])
    unknown = [
        f'{name}: "{section}"'
        for name, text in texts().items()
        if name != "tests/house/test_documents.py"
        for section in cited_sections(text)
        if section not in known
    ]
    assert not unknown


def test_every_test_that_a_document_names_exists():
    missing = []
    for document in (name for name in texts() if name.endswith(".md")):
        for path, name in re.findall(r"`(tests/[\w/]+\.py)(?:::(\w+))?`", texts()[document]):
            if path not in texts() or (name and f"def {name}(" not in texts()[path]):
                missing.append(f"{document}: {path}::{name}")
    assert not missing
    assert "::test_" in texts()["docs/chapter.md"]


def test_the_specification_refers_to_sections_of_its_own():
    text, _, _ = without_code(texts()[SPECIFICATION]).partition("\n## Sources")
    quoted = re.findall(r'"([A-Z][^"]*)"', WRAPPED.sub(" ", text))
    assert quoted
    assert not set(quoted) - set(headings(texts()[SPECIFICATION]))


def told_defaults(markdown: str) -> dict[str, set[str]]:
    """Hyperparameter -> its defaults, from the tables with a column of defaults or values."""
    told: dict[str, set[str]] = {}
    column = 0
    for line in markdown.split("\n"):
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if not line.startswith("|"):
            column = 0
        elif re.fullmatch(r"\[\w+\]|key", cells[0]):
            column = next(i for i, cell in enumerate(cells) if re.match("default|value", cell))
        elif column:
            for name in re.findall(r"\w+", cells[0]):
                told.setdefault(name, set()).update(values(cells[column]))
    return told


def values(text: str) -> set[str]:
    """The numbers and words of a text."""
    return set(re.findall(r"[\w.-]+", text))


def test_the_specification_has_every_hyperparameter_with_its_default():
    told = told_defaults(texts()[SPECIFICATION])
    missing = [
        f"{section} {name} = {default}"
        for section, name, default, _ in config.describe()
        if default not in (None, "")
        and not values(f"{default:g}" if isinstance(default, float) else str(default))
        <= told.get(name, set())
    ]
    assert not missing


def test_every_table_is_one():
    """A row of dashes stands on a line of its own, below the head."""
    for name, text in texts().items():
        if not name.endswith(".md"):
            continue
        prose = re.sub(r"^ *```.*?^ *```", "", text, flags=re.DOTALL | re.MULTILINE)
        for block in re.findall(r"(?:^ *\|.*\n?)+", prose, re.MULTILINE):
            second = [*block.splitlines(), ""][1]
            assert re.fullmatch(r" *\|(\s*:?-+:?\s*\|)+\s*", second), f"{name}: {block[:70]}"
