"""The exercises' living pages: each is small and whole, and its figures hear hand and keyboard.

What a figure shows is compared with Python in tests/test_figures_exNN.py.
"""

import re

import pytest

from botschool.grading.copies.release import release
from botschool.grading.copies.starting import living_page
from botschool.page.exercise import PAGE, POINTER, exercise_page, has_page, linked
from botschool.page.markdown import render
from living import FOLDERS, NAMED, ROOT, WITH_PAGES, open_figures

pages = pytest.mark.parametrize("number", WITH_PAGES)


@pytest.mark.slow
@pages
def test_a_page_is_small_and_whole(number):
    text = exercise_page(FOLDERS[number])
    assert len(text.encode()) < 450_000
    assert not re.search(r'(?:src|href)="(?:https?:)?//[^"]*\.(?:js|css|png)', text)
    assert "/*TEXT*/" not in text and "/*DATA*/" not in text
    shown = text.partition("<main>")[2].partition("</main>")[0]
    assert "$" not in re.sub(r"<(code|pre|math)\b.*?</\1>", "", shown, flags=re.DOTALL)
    assert not re.search(r'<img src="(?!data:)', shown)
    script = (FOLDERS[number] / "figure.js").read_text()
    assert set(NAMED[number]) == set(re.findall(r'^figure\("(\w+)"', script, re.MULTILINE))
    assert len(script.splitlines()) < 400


@pages
def test_a_text_leads_to_its_page(number):
    text = (FOLDERS[number] / "README.md").read_text()
    found = POINTER.search(text)
    assert found and found[1] == f"`botschool start {number}`"
    assert "<!-- figure:" in text.partition("```")[0]  # before any code
    assert "](page.html)" in linked(text, "page.html")


SILENT = """[...document.querySelectorAll('.figure canvas, button, input')].filter((one) =>
  !(one.getAttribute('aria-label') || one.innerText || one.labels?.[0]?.innerText)).length"""


@pytest.mark.slow
@pages
@pytest.mark.parametrize(("width", "dark"), [(390, True), (1280, False)])
def test_a_page_opens_without_errors(browser, number, width, dark, tmp_path):
    open_figures(browser, number, tmp_path, width, dark)
    assert browser.run("Object.keys(figures)") == NAMED[number]
    assert browser.run("document.documentElement.scrollWidth") <= width
    assert browser.run(SILENT) == 0
    for name in NAMED[number]:
        told = browser.run(f"figures.{name}.canvas.getAttribute('aria-label')")
        assert len(told) > 30 and "undefined" not in told and "NaN" not in told
        size = f"0, 0, figures.{name}.canvas.width, figures.{name}.canvas.height"
        assert browser.run(f"new Set(figures.{name}.pen.getImageData({size}).data).size") > 3
        before = browser.run(f"JSON.stringify(figures.{name}.state)")
        for slider in browser.run(f"Object.keys(figures.{name}.spec.sliders ?? {{}})"):
            high = browser.run(f"figures.{name}.spec.sliders.{slider}.high")
            browser.run(f"figures.{name}.set({{ {slider}: {high} }})")
        browser.run(f"figures.{name}.reset()")
        assert browser.run(f"JSON.stringify(figures.{name}.state)") == before
    assert browser.errors == []
    assert {url.partition(":")[0] for url in browser.requests} <= {"file", "data", "about", "blob"}


def test_a_text_becomes_a_page(tmp_path):
    text = (
        "# T\n\nA $x_1 < 2$, `$y$` and\n\n$$z = \\frac{1}{2}$$\n\n| a | b |\n|---|---|\n| 1 | 2 |\n"
    )
    text += "\n[on](../ex02_x/README.md)\n\n```\n$ls\n```\n\n<!-- figure: one -->\n"
    made = render(text, tmp_path, lambda target: f"to:{target}")
    assert made.count("<math ") == 2 and "<mfrac>" in made and 'display="block"' in made
    assert "<code>$y$</code>" in made and "$ls" in made and "<table>" in made
    assert 'href="to:../ex02_x/README.md"' in made and 'data-figure="one"' in made


# The ways to a page


@pytest.mark.slow
def test_a_copy_has_its_pages_ready(tmp_path):
    copy = tmp_path / "copy"
    release(ROOT, copy, {1, 7})
    for folder in copy.glob("exercises/ex*"):
        assert "](page.html)" in (folder / "README.md").read_text()
        made = (folder / PAGE).stat().st_mtime_ns
        assert living_page(int(folder.name[2:4]), copy) == folder / PAGE
        assert (folder / PAGE).stat().st_mtime_ns == made
    assert release(ROOT, copy, {1, 7}).written == 0


def test_an_exercise_without_figures_has_no_page(tmp_path):
    (tmp_path / "README.md").write_text("# Exercise 16. Tiny\n")
    assert not has_page(tmp_path) and not has_page(tmp_path / "nothing")
