"""Fixtures of all tests. Tests open no window: pygame and matplotlib draw in memory."""

import os
import re
import sys
from pathlib import Path

import pytest

from quick import Quick

SLOW_MODULE = re.compile(r"^pytestmark = \[?\s*pytest\.mark\.slow", re.MULTILINE)
os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["MPLBACKEND"] = "Agg"


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers():
    """Return the workers of `-n auto`: one per core of ours, at most eight (each takes 1
    to 2 GB).
    """
    known = hasattr(os, "sched_getaffinity")
    return min(8, len(os.sched_getaffinity(0)) if known else os.cpu_count() or 1)


def pytest_configure(config):
    if Path("/proc/self/stat").exists():  # elsewhere the processor time of children is not known
        config.pluginmanager.register(Quick(limit=0.5))


def pytest_ignore_collect(collection_path, config):
    """Do not import what would be deselected: modules that are slow as a whole, and the
    thousands of proofs in tests/course unless a mark or a path asks for them.
    """
    marks = config.option.markexpr
    paths = [Path(config.invocation_params.dir, name.split("::")[0]) for name in config.args]
    if any(collection_path in (path, *path.parents) for path in paths):
        return None
    if collection_path == Path(__file__).parent / "course":
        return None if re.search(r"(?<!not )\bcourse\b", marks) else True
    if collection_path.suffix == ".py" and "not slow" in marks:
        text = collection_path.read_text(encoding="utf-8")
        return True if SLOW_MODULE.search(text) else None
    return None


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(items):
    """Mark tests that start a browser or compile."""
    for item in items:
        if {"browser", "compiled"} & set(item.fixturenames):
            item.add_marker(pytest.mark.slow)


@pytest.fixture(scope="session", autouse=True)
def own_settings(tmp_path_factory):
    """Use a folder of its own for the user's settings, so that the real ones stay as they are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CONFIG_HOME", str(tmp_path_factory.mktemp("settings")))
        yield


@pytest.fixture(scope="module")
def by_sb3():
    """Train with Stable-Baselines3 unless an engine is named, as if no problem were native."""
    from botschool.rl.native import choosing

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(choosing, "native_problem", lambda env: None)
        yield


@pytest.fixture(scope="session")
def server():
    """The fork server of graders, one for a whole run."""
    from botschool.grading.run.confined import fork_server

    with fork_server() as one:
        yield one


@pytest.fixture
def messages(server, tmp_path):
    """Grade a text in an exercise of tiny_course's file; return the message of each task."""
    from botschool.grading.judge.submission import grade
    from tiny_course import submit

    def of(text, exercise):
        file = submit(tmp_path / str(len(list(tmp_path.iterdir()))), text)
        return [task.message for task in grade(exercise, file, server=server).tasks]

    return of


@pytest.fixture
def command(capfd, monkeypatch):
    """Call the command in this process; return (exit code, standard output, standard error)."""
    from botschool import cli
    from botschool.problems import base, finding

    def call(*arguments):
        for module in (base, finding):  # a program says a note once
            module.say.cache_clear()
        monkeypatch.setattr(sys, "argv", ["botschool", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as end:
            cli.main()
        code = 0 if end.value.code is None else end.value.code
        return (code, *capfd.readouterr())

    return call


@pytest.fixture
def refused(command):
    """Call the command, which must refuse in a sentence with the given words;
    return the sentence.
    """
    from running import one_sentence

    def call(*arguments, says=()):
        code, _, errors = command(*arguments)
        one_sentence(code, errors, says)
        return errors

    return call


@pytest.fixture
def studies(monkeypatch):
    """Let a test import the modules of tools/studies and tests/bench; forget them afterwards."""
    tests = Path(__file__).parent
    folders = [tests.parent / "tools" / "studies", tests / "bench"]
    for folder in folders:
        monkeypatch.syspath_prepend(str(folder))
    before = set(sys.modules)
    yield
    for name in set(sys.modules) - before:
        if any((folder / f"{name}.py").exists() for folder in folders):
            del sys.modules[name]


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    """A headless browser that opens pages; skipped where there is none."""
    from browser import Browser, find_browser

    if find_browser() is None:
        pytest.skip("no browser found: install chromium to test pages")
    browser = Browser(tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()
