"""Reading run files, learning curves and averages."""

import itertools
import pickle
import re
from functools import partial
from html.parser import HTMLParser

import numpy as np
import pytest
from matplotlib.image import imread

from botschool.analysis import plots
from botschool.analysis.run_page import curve
from botschool.analysis.runs import BEST_POST, find_runs, read_fitness, read_stat
from botschool.errors import BotschoolError
from browser import Browser, find_browser
from running import finished_run, write_experiment


def stat_of(generations, last=100.0, steps=1000):
    """A run that improves linearly from 0 to `last`."""
    fitness = np.linspace(0.0, last, generations) if generations > 1 else np.array([last])
    steps = steps * np.arange(1.0, generations + 1)
    columns = [steps, fitness + 2, fitness, fitness + 1, fitness - 1, 0 * fitness]
    return np.stack(columns, axis=1)


def save_run(folder, seed, stat):
    folder.mkdir(exist_ok=True)
    np.save(folder / f"statS{seed}.npy", stat.ravel())
    (folder / f"S{seed}.fit").write_text(f"seed {seed} bestfit 1 bestgfit {stat[-1, BEST_POST]}\n")


@pytest.fixture
def drawn(monkeypatch):
    """The figures that were written, kept for a look at what is in them."""
    from matplotlib.figure import Figure

    figures = []
    savefig = Figure.savefig

    def keep(figure, *args, **kwargs):
        figures.append(figure)
        savefig(figure, *args, **kwargs)

    monkeypatch.setattr(Figure, "savefig", keep)
    return figures


# runs.py


def test_a_stat_file_gives_one_row_a_generation(tmp_path):
    save_run(tmp_path, 11, stat_of(7))
    np.testing.assert_array_equal(read_stat(tmp_path / "statS11.npy"), stat_of(7))


class Bomb:
    def __reduce__(self):
        return (pytest.fail, ("the file was unpickled",))


def write_header(text, path):
    """A .npy file of version 1 with this header."""
    header = f"{text}\n".encode()
    length = len(header).to_bytes(2, "little")
    path.write_bytes(b"\x93NUMPY\x01\x00" + length + header + bytes(480))


def refused_files():
    good = stat_of(5).ravel()
    backwards = stat_of(5)[::-1].ravel()
    yield "words", "not a stat file", lambda path: path.write_text("good morning")
    yield "empty", "not a stat file", lambda path: path.write_bytes(b"")
    yield "pickle", "not a stat file", lambda path: path.write_bytes(pickle.dumps(Bomb()))
    yield "objects", "not a stat file", lambda path: np.save(path, np.array([Bomb()], dtype=object))
    yield "length", "6 for each generation", lambda path: np.save(path, good[:-1])
    yield "nothing", "no generation", lambda path: np.save(path, good[:0])
    yield "genotype", "steps", lambda path: np.save(path, backwards)
    yield "text array", "plain numbers", lambda path: np.save(path, np.array(["a"] * 6))
    yield "folder", "cannot be read", lambda path: path.mkdir()

    headers = {
        "open bracket": "(", "open string": "'''", "indented": "    x\n  y", "deep": "{" * 200,
        "half": "{'descr': '<f8'",
        "long": "{'descr': '<f8', 'fortran_order': False, 'shape': (10L, 6)",
        "bool": "{'descr': '<f8', 'fortran_order': False, 'shape': (True, 6), }",
        "huge": "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 6), }",
    }  # fmt: skip
    for name, text in headers.items():
        yield f"header: {name}", "damaged", partial(write_header, text)

    def truncate(path):
        np.save(path, good)
        path.write_bytes(path.read_bytes()[:-20])

    yield "truncated", "damaged", truncate


@pytest.mark.parametrize(
    ("message", "make"), [case[1:] for case in refused_files()], ids=[c[0] for c in refused_files()]
)
def test_what_is_no_stat_file_is_refused_in_a_sentence(tmp_path, message, make):
    path = tmp_path / "statS1.npy"
    make(path)
    with pytest.raises(BotschoolError, match=message) as caught:
        read_stat(path)
    assert str(path) in str(caught.value)


def test_a_missing_stat_file_is_named():
    with pytest.raises(BotschoolError, match=r"there is no file .*statS3\.npy"):
        read_stat("nowhere/statS3.npy")


def test_runs_of_a_folder_are_found_by_the_seeds_in_file_names(tmp_path):
    save_run(tmp_path, 11, stat_of(3))
    save_run(tmp_path, 2, stat_of(3))
    for name in ("bestS11.npy", "bestgS11.npy", "stat7.npy", "S2S.fit", "acrobot.ini"):
        (tmp_path / name).touch()
    runs = find_runs(tmp_path)
    assert [run.seed for run in runs] == [2, 7, 11]
    assert runs[2].stat == tmp_path / "statS11.npy"
    assert runs[2].best == tmp_path / "bestS11.npy"
    assert runs[2].bestg == tmp_path / "bestgS11.npy"
    assert runs[2].fit["bestgfit"] == 100.0
    assert (runs[1].best, runs[1].fit) == (None, {})


def test_damaged_files_of_a_folder_are_skipped_and_named(tmp_path):
    save_run(tmp_path, 1, stat_of(3))
    save_run(tmp_path, 2, stat_of(3))
    (tmp_path / "statS2.npy").write_bytes(b"junk")
    (tmp_path / "S2.fit").write_bytes(b"junk")
    notices = []
    assert read_fitness(tmp_path, notices.append) == {1: 100.0}
    assert [name for name in ("S2.fit", "statS2.npy") if any(name in n for n in notices)] == [
        "S2.fit",
        "statS2.npy",
    ]


def test_a_folder_without_runs_is_an_error(tmp_path):
    with pytest.raises(BotschoolError, match="no runs"):
        plots.plot_stat([tmp_path], tmp_path / "a.png")
    with pytest.raises(BotschoolError, match="no folder"):
        plots.plot_ave([tmp_path / "nowhere"])


# plots.py


def lines_of(figure):
    return {line.get_label(): line.get_xydata() for line in figure.axes[0].lines}


def test_the_curves_of_one_run(tmp_path, drawn):
    stat = stat_of(5)
    stat[0, BEST_POST] = -np.inf
    save_run(tmp_path / "acrobot", 4, stat)
    plots.plot_stat([tmp_path / "acrobot" / "statS4.npy"], tmp_path / "a.png")
    lines = lines_of(drawn[0])
    assert drawn[0].axes[0].get_title() == "acrobot, seed 4"
    np.testing.assert_array_equal(lines["best post-evaluated so far"][1:], stat[1:, [0, 2]])
    assert np.isnan(lines["best post-evaluated so far"][0, 1])
    np.testing.assert_array_equal(lines["average of the generation"], stat[:, [0, 4]])
    assert imread(tmp_path / "a.png").shape[:2] == (500, 800)


def test_a_folder_gives_mean_and_band_over_its_runs(tmp_path, drawn):
    for seed, last in enumerate((90.0, 100.0, 110.0)):
        save_run(tmp_path, seed, stat_of(11, last))
    plots.plot_stat([tmp_path], tmp_path / "a.png")
    mean = lines_of(drawn[0])["best post-evaluated so far, mean ± sd of 3 runs"]
    np.testing.assert_allclose(mean[-1], [11000.0, 100.0])
    band = drawn[0].axes[0].collections[-1].get_paths()[0].vertices
    assert band[:, 1].max() == pytest.approx(110.0)
    assert len(drawn[0].axes[0].lines) == 9  # 3 runs, 2 means with 2 edges each


def test_averages_are_printed_and_drawn(tmp_path, capsys, drawn):
    for seed, last in enumerate((1.0, 2.0, 6.0)):
        save_run(tmp_path / "acrobot", seed, stat_of(3, last))
    save_run(tmp_path / "pendulum", 1, stat_of(3, -150.0))
    plots.plot_ave([tmp_path / "acrobot", tmp_path / "pendulum"], tmp_path / "a.png")
    rows = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["acrobot", "3.00", "6.57", "2.65", "3", "1.00", "6.00"] in rows
    assert ["pendulum", "-150.0", "-", "-", "1", "-150.0", "-150.0"] in rows
    assert [bar.get_width() for bar in drawn[0].axes[0].patches] == [3.0, -150.0]


@pytest.mark.parametrize(
    ("name", "message"),
    [("a.xyz", r"must end with one of \.png"), ("no/a.png", "no folder"), ("run.png", "a folder")],
)
def test_pictures_that_cannot_be_written(tmp_path, name, message):
    save_run(tmp_path, 1, stat_of(3))
    (tmp_path / "run.png").mkdir()
    for plot in (plots.plot_stat, plots.plot_ave):
        with pytest.raises(BotschoolError, match=message):
            plot([tmp_path], tmp_path / name)


# --- The page that `botschool es` writes beside a run's files.


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


def test_the_curve_goes_through_the_stat_file():
    rows = np.zeros((3, 6))
    rows[:, 0], rows[:, 2], rows[:, 3], rows[:, 4] = [10, 20, 40], [1, 5, 9], [0, 5, 9], [0, 0, 9]
    drawn = curve(rows)
    lines = dict(re.findall(r'polyline class="(best|own|mean)" points="([^"]*)"', drawn))
    best = np.array([pair.split(",") for pair in lines["best"].split()], dtype=float)
    assert np.diff(best[:, 0]) == pytest.approx(np.diff(best[:, 0])[0] * np.array([1, 2]))
    assert best[2, 1] == 10 and best[0, 1] - best[1, 1] == pytest.approx(best[1, 1] - best[2, 1])


@pytest.mark.slow
def test_robots_of_python_are_played_only_if_asked_for(tmp_path, command):
    path, folder = finished_run(tmp_path, "tiny_envs:Tiny-v0")
    assert command("es", "-f", path, "-s", 1, "-o", folder, "--resume")[0] == 0
    assert not Parts((folder / "pageS1.html").read_text()).within


@pytest.mark.slow
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
