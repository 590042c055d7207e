"""The book: built whole, without dead links or missing pictures."""

import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlparse

import pytest

ROOT = Path(__file__).parents[2]


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


@pytest.fixture(scope="module")
def book(tmp_path_factory):
    """The folder of the whole book."""
    pytest.importorskip("sphinx", reason="the book needs Sphinx: make book")
    tmp_path = tmp_path_factory.mktemp("book")
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html"]
    command += ["-c", "docs/book", "-d", tmp_path / "trees", ".", tmp_path / "book"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return tmp_path / "book"


@pytest.mark.long
def test_the_book_has_no_dead_link(book):
    pages = {path: Links() for path in book.rglob("*.html")}
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
                dead.append((str(path.relative_to(book)), link))
    assert dead == []
    assert silent == []


def visit(browser, path):
    browser.call("Page.navigate", url="about:blank")
    browser.call("Page.navigate", url=f"file://{path}")
    browser.wait("document.readyState === 'complete' && location.protocol === 'file:'")


@pytest.mark.long
def test_each_page_opens_without_an_error(book, browser):
    missing = []
    for path in sorted(book.rglob("*.html")):
        if "live" in path.parts or path.name in ("genindex.html", "py-modindex.html"):
            continue
        browser.errors.clear()
        browser.requests.clear()
        visit(browser, path)
        lost = browser.run(
            "Promise.all([...document.images].map((image) =>"
            " (image.loading = 'eager', image.decode())"
            ".then(() => '', () => image.src))).then((all) => all.filter(Boolean))"
        )
        wrong = browser.run("document.querySelectorAll('.MathJax_Error, mjx-merror').length")
        missing += [(path.name, what) for what in (*lost, *browser.errors)]
        missing += [(path.name, "a formula")] * wrong
        missing += [(path.name, url) for url in browser.requests if url.startswith("http")]
    assert missing == []
