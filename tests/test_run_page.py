"""The page that `botschool es` writes beside a run's files."""

import itertools
import re
from html.parser import HTMLParser

import numpy as np
import pytest

from botschool.analysis.run_page import curve
from browser import Browser, find_browser
from running import finished_run, write_experiment


class Parts(HTMLParser):
    """Texts of a page by element, and the pages within it."""

    def __init__(self, text):
        super().__init__()
        self.within, self.texts, self.open = [], [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.open.append(tag)
        self.within += [value for name, value in attributes if name == "srcdoc"]

    def handle_endtag(self, tag):
        self.open.pop()

    def handle_data(self, data):
        self.texts.append((self.open[-1] if self.open else "", data.strip()))


@pytest.fixture
def run(tmp_path, command):
    path = write_experiment(tmp_path, "Pendulum-v1", "OpenAI-ES", {"nhiddens": 4})
    folder = tmp_path / "out"
    assert command("es", "-f", path, "-s", 3, "-o", folder)[0] == 0
    return path, folder


def test_a_run_ends_with_a_page_about_itself(run):
    _, folder = run
    text = (folder / "pageS3.html").read_text()
    parts = Parts(text)
    said = [words for _, words in parts.texts]
    stat = np.load(folder / "statS3.npy").reshape(-1, 6)
    assert "Pendulum-v1, seed 3" in said and str(len(stat)) in said
    assert "botschool es -f own.ini -s 3" in said
    assert "botschool es -f own.ini -s 3 -p -g bestgS3.npy" in said
    settings = dict(itertools.pairwise(said))
    assert settings["nhiddens"] == "4" and settings["stepsize"] == "0.01"
    (replay,) = parts.within
    assert "<canvas" in replay and "Pendulum-v1" in replay
    assert not re.findall(r"(?:src|href)=.?(?:https?:)?//", text)  # nothing comes from elsewhere


def test_what_differs_from_the_default_stands_out(run):
    text = (run[1] / "pageS3.html").read_text()
    assert "<tr class=own><td>nhiddens</td>" in text and "<tr><td>nlayers</td>" in text


def test_the_curve_goes_through_the_stat_file():
    rows = np.zeros((3, 6))
    rows[:, 0], rows[:, 2], rows[:, 3], rows[:, 4] = [10, 20, 40], [1, 5, 9], [0, 5, 9], [0, 0, 9]
    drawn = curve(rows)
    lines = dict(re.findall(r'polyline class="(best|own|mean)" points="([^"]*)"', drawn))
    best = np.array([pair.split(",") for pair in lines["best"].split()], dtype=float)
    assert np.diff(best[:, 0]) == pytest.approx(np.diff(best[:, 0])[0] * np.array([1, 2]))
    assert best[2, 1] == 10 and best[0, 1] - best[1, 1] == pytest.approx(best[1, 1] - best[2, 1])


def test_curves_that_are_flat_long_or_unknown_are_drawn():
    flat = np.ones((2, 6))
    assert "nan" not in curve(flat)
    long = np.cumsum(np.ones((10_000, 6)), axis=0)
    assert len(curve(long)) < 40_000
    unknown = np.ones((2, 6))
    unknown[:, 2] = np.nan, 3
    assert "nan" not in curve(unknown)


def test_a_page_can_be_asked_for_at_any_time(run, command, refused, tmp_path):
    path, folder = run
    page = folder / "pageS3.html"
    page.unlink()
    code, out, errors = command("es", "-f", path, "-s", 3, "-o", folder, "--page")
    assert (code, errors) == (0, "") and out == f"page: {page}\n" and page.exists()
    refused("es", "-f", path, "-s", 4, "-o", folder, "--page", says="statS4.npy")


def test_robots_of_python_are_played_only_if_asked_for(tmp_path, command):
    path, folder = finished_run(tmp_path, "tiny_envs:Tiny-v0")
    assert command("es", "-f", path, "-s", 1, "-o", folder, "--resume")[0] == 0
    assert not Parts((folder / "pageS1.html").read_text()).within


@pytest.mark.skipif(not find_browser(), reason="there is no browser")
def test_a_browser_shows_it_without_an_error(run, tmp_path):
    browser = Browser(tmp_path / "profile")
    try:
        browser.call("Page.navigate", url=f"file://{run[1] / 'pageS3.html'}")
        browser.wait("document.readyState === 'complete'")
        browser.wait("document.querySelector('iframe') !== null")
        assert browser.run("document.querySelectorAll('polyline').length") == 6
        within = "document.querySelector('iframe').contentDocument"
        browser.wait(f"{within}.querySelector('#step')?.innerText")
        assert browser.errors == []
    finally:
        browser.close()
