"""Tests open no window: pygame and matplotlib draw in memory."""

import os
import sys

import pytest

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["MPLBACKEND"] = "Agg"


@pytest.fixture
def command(capfd, monkeypatch):
    """Calls the command in this process: (exit code, standard output, standard error)."""
    from botschool import cli
    from running import TESTS

    def call(*arguments):
        monkeypatch.setattr(sys, "argv", ["botschool", *map(str, arguments)])
        capfd.readouterr()
        with pytest.raises(SystemExit) as end:
            cli.main()
        code = 0 if end.value.code is None else end.value.code
        return (code, *capfd.readouterr())

    monkeypatch.syspath_prepend(TESTS)
    return call


@pytest.fixture
def refused(command):
    """Calls the command, which must refuse in a sentence that holds the given words. Gives it."""
    from running import one_sentence

    def call(*arguments, says=()):
        code, _, errors = command(*arguments)
        one_sentence(code, errors, says)
        return errors

    return call
