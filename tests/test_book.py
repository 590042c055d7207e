"""The book: built whole, without dead links or missing pictures."""

import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse

import pytest

ROOT = Path(__file__).parents[1]


class Links(HTMLParser):
    """Where a page's links and pictures lead."""

    def __init__(self):
        super().__init__()
        self.found, self.places, self.silent = [], set(), []

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        self.places |= {given[key] for key in ("id", "name") if given.get(key)}
        for key in ("href", "src"):
            if given.get(key):
                self.found.append(given[key])
        if tag == "img" and not given.get("alt"):
            self.silent.append(given.get("src"))


@pytest.mark.long
def test_the_book_has_no_dead_link(tmp_path):
    pytest.importorskip("sphinx", reason="the book needs Sphinx: make book")
    command = ["sphinx-build", "-W", "--keep-going", "-q", "-b", "html", "-c", "docs/book"]
    where = ["-d", tmp_path / "trees", ".", tmp_path / "book"]
    command = [sys.executable, "-m", "sphinx", *command[1:], *where]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    pages = {path: Links() for path in (tmp_path / "book").rglob("*.html")}
    assert len(pages) > 30
    for path, links in pages.items():
        links.feed(path.read_text(encoding="utf-8"))
    dead, silent = [], []
    for path, links in pages.items():
        silent += [(path.name, source) for source in links.silent]
        for link in links.found:
            parts = urlparse(link)
            if parts.scheme or parts.netloc:
                continue
            target = (path.parent / unquote(parts.path)).resolve() if parts.path else path
            places = pages[target].places if target in pages else {parts.fragment}
            if not target.exists() or (parts.fragment and parts.fragment not in places):
                dead.append((str(path.relative_to(tmp_path)), link))
    assert dead == []
    assert silent == []
