"""A test that takes much processor time must be marked."""

import pytest

pytest_plugins = ["pytester"]

CONFTEST = """
from quick import Quick

def pytest_configure(config):
    config.addinivalue_line("markers", "slow: takes long")
    config.pluginmanager.register(Quick(limit=0.05))
"""
TESTS = """
import time

import pytest

first = []

def busy(seconds):
    end = time.process_time() + seconds
    while time.process_time() < end:
        pass

def test_quick():
    pass

def test_that_pays_for_imports():
    busy(0 if first else 0.2)
    first.append(True)

@pytest.fixture(scope="module")
def shared():
    busy(0.2)

def test_with_what_others_share(shared):
    pass

@pytest.mark.slow
def test_marked():
    busy(0.2)

def test_slow():
    busy(0.2)
"""


@pytest.mark.slow
def test_a_slow_test_without_its_mark_fails(pytester):
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile(TESTS)
    result = pytester.runpytest_inprocess("-p", "no:cacheprovider")
    result.assert_outcomes(passed=4, failed=1)
    result.stdout.fnmatch_lines(["*test_slow takes 0.* s of processor*mark it with*slow*"])
