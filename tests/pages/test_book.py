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


@pytest.mark.long
def test_the_book_by_keyboard(book, browser):
    """Search; a living figure below a picture of something that moves, which opens and plays."""
    browser.resize(1280, 900)
    visit(browser, book / "search.html")
    browser.run("location.search = '?q=ziggurat'")
    browser.wait("document.querySelectorAll('#search-results li a').length > 0")

    visit(browser, book / "exercises/ex04_acrobot/README.html")
    assert browser.run("document.querySelectorAll('details.living').length") == 1
    browser.run("document.querySelector('details.living summary').focus()")
    browser.press("Enter", "\r")
    browser.wait("document.querySelector('details.living').open")
    browser.run("document.querySelector('details.living').scrollIntoView()")
    assert browser.run("document.activeElement.tagName") == "SUMMARY"
    visit(browser, book / "docs/book/live/acrobot.html")
    browser.wait("bench && game.step > 2")
    browser.press(" ", " ")
    browser.wait("!game.playing")
    step = browser.run("game.step")
    browser.press("ArrowRight")
    assert browser.run("game.step") == step + 1
    reached = []  # everything that can be pressed is reached by the tabulator
    for _ in range(80):
        browser.press("Tab")
        reached.append(browser.run("document.activeElement.id || document.activeElement.className"))
    assert {"pause", "once", "again", "speed", "seed", "evolve", "neuron", "heal", "load"} <= set(
        reached
    )
    assert browser.run(
        "[...document.querySelectorAll('canvas, iframe, button, input, select')].every((one) =>"
        " one.getAttribute('aria-label') || one.title || one.labels?.length || one.innerText)"
    )
