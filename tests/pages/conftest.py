"""Fixtures of tests of pages."""

import re

import pytest

from living import open_figures


@pytest.fixture
def page(request, browser, tmp_path):
    """A browser with the living page of the exercise that names the test's file, 1280 pixels wide
    or as a test asks; the page has reported no error in the end."""
    number = int(re.search(r"ex(\d\d)$", request.module.__name__)[1])
    open_figures(browser, number, tmp_path, width=getattr(request, "param", 1280))
    yield browser
    assert browser.errors == []
