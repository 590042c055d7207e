"""Pictures of tasks, the page of an exercise, and what `botschool show` says."""

import re
import shutil

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.grading.declare.exercise import (
    PICTURES,
    Exercise,
    exercise_numbers,
    load_exercise,
)
from botschool.grading.declare.picture import KINDS, Picture
from botschool.grading.packed import pack
from botschool.grading.report.album import captioned, captions, write_album
from botschool.grading.report.checkpoints import OPEN, RIGHT, WRONG, checkpoints
from botschool.grading.report.drawing import Panel, chosen, draw, panels_of
from botschool.grading.report.progress import remember
from botschool.grading.report.showing import show_done, show_one
from botschool.paths import material
from browser import Browser, find_browser

pytestmark = pytest.mark.slow

ROOT = material()
LINE = np.arange(20.0)
TABLE = np.arange(30.0).reshape(5, 6)


def panel(kind, yours, expected=None, **more):
    return Panel("a title", yours, expected, Picture("It is seen.", "x", "y", kind), **more)


def axes_of(*panels):
    return draw("a task", list(panels)).axes


# ------------------------------------------------------------------- each kind, from arrays
def lines(axes, every=1):
    return [line.get_ydata() for line in axes.lines[::every]]


def offsets(axes):
    return [np.array(each.get_offsets()) for each in axes.collections]


PAIRS = np.stack([LINE, LINE**2], axis=1)
SQUARES = np.zeros((3, 4, 2)) + np.arange(4)[:, None]
DRAWN = {
    "against": (LINE, lines, lambda a: a),
    "arrows": (
        np.hstack([PAIRS, PAIRS]),
        lambda axes: [q.V for q in axes.collections],
        lambda a: a[:, 3],
    ),
    "bars": (
        LINE[:5],
        lambda axes: [[b.get_height() for b in c] for c in axes.containers],
        lambda a: a,
    ),
    "curves": (LINE, lines, lambda a: a),
    "groups": (np.stack([LINE, -LINE, LINE % 3], 1), offsets, lambda a: a[:, :2]),
    "path": (PAIRS, lambda axes: lines(axes, 3), lambda a: a[:, 1]),
    "points": (PAIRS, offsets, lambda a: a),
    "shapes": (
        PAIRS[None, :4],
        lambda axes: [p.get_xy()[:4] for p in axes.patches],
        lambda a: a[0],
    ),
}
"""Kind -> an array, what its axes hold, and what they should hold of the array."""


@pytest.mark.parametrize("kind", DRAWN)
def test_a_wrong_answer_lies_over_the_expected_one(kind):
    expected, data, of = DRAWN[kind]
    yours = expected + 1
    below, above = data(axes_of(panel(kind, yours, expected))[0])
    assert np.array_equal(below, of(expected)) and np.array_equal(above, of(yours))
    (alone,) = data(axes_of(panel(kind, yours))[0])
    assert np.array_equal(alone, of(yours))
    assert set(KINDS) == {*DRAWN, "heat", "histogram"}


def test_tables_stand_beside_each_other_with_their_difference():
    yours = TABLE + np.eye(5, 6)
    axes = [each for each in axes_of(panel("heat", yours, TABLE)) if each.images]
    shown = [each.images[0].get_array() for each in axes]
    assert np.array_equal(shown[0], yours) and np.array_equal(shown[1], TABLE)
    assert np.array_equal(shown[2], yours - TABLE)
    assert axes[0].images[0].get_clim() == axes[1].images[0].get_clim() == (0, 29)
    (alone,) = [each for each in axes_of(panel("heat", TABLE)) if each.images]
    assert np.array_equal(alone.images[0].get_array(), TABLE)


@pytest.mark.parametrize(
    ("shape", "kind"),
    [((5,), "bars"), ((50,), "curves"), ((50, 2), "path"), ((50, 4), "curves"), ((8, 8), "heat"),
     ((3, 4, 2), "shapes"), ((3, 9, 9), "heat")],
)  # fmt: skip
def test_the_shape_chooses_the_kind(shape, kind):
    assert chosen(np.zeros(shape)) == kind
    assert panel("", np.zeros(shape)).kind == kind
    assert panel("arrows", np.zeros(shape)).kind == ("arrows" if shape == (50, 4) else kind)


def test_parts_have_panels_and_single_numbers_share_one():
    expected = {"a": LINE, "b": 1.0, "c": 2.0, "name": "x", "none": None, "over": LINE / 2}
    yours = expected | {"b": 5, "a": "no numbers"}
    curve, bars = panels_of("f", yours, expected, Picture("."), False)
    assert curve.yours is None and curve.note == "yours cannot be drawn"
    assert np.array_equal(curve.over, LINE / 2) and np.array_equal(curve.expected, LINE)
    assert bars.names == ["b", "c"] and bars.yours.tolist() == [5, 2] and bars.apart == 4
    assert [each.title for each in panels_of("f", [LINE, LINE], [LINE, LINE], Picture("."), True,
                                             ("one", "two"))] == ["one", "two"]  # fmt: skip


ODD = {
    "none": None,
    "text": "text",
    "an empty dict": {},
    "a ragged list": [[1], [1, 2]],
    "an array of texts": np.array(["a"]),
    "four dimensions": np.zeros((2, 2, 2, 2)),
    "nothing": np.zeros(0),
    "no pairs": np.zeros((0, 2)),
    "huge numbers": 1e308 * np.ones(20),
    "NaN": np.full(20, np.nan),
    "infinity": np.full(20, np.inf),
    "a huge integer": 10**400,
    "a dict": {"a": 1},
    "a number": 5.0,
    "complex numbers": np.ones(20) * 1j,
}


@pytest.mark.parametrize("odd", ODD.values(), ids=ODD)
def test_no_answer_stops_the_drawing(odd):
    for kind in KINDS:
        for expected in (LINE, TABLE, PAIRS, SQUARES):
            found = panels_of("f", odd, expected, Picture(".", kind=kind), False)
            if found and found[0].kind == kind:  # else the shape has chosen another one
                draw("task $ {", found)
    assert panels_of("f", odd, {"a": 1.0, "b": 2.0}, Picture("."), False)[0].apart != 0


# ------------------------------------------------------------------- tasks, end to end
def checkpoint(tmp_path, number, task, *changes):
    exercise = load_exercise(number, ROOT)
    text = exercise.known.solution
    for old, new in changes:
        assert text.count(old) == 1, (old, text.count(old))
        text = text.replace(old, new)
    (tmp_path / exercise.file).write_text(text)
    (found,) = checkpoints(exercise, [exercise.find(task)], tmp_path / exercise.file)
    return found


SLIPS = {
    "1.4": (
        ("0.1 * speed**2", "0.2 * speed**2"),
        lambda yours, ours: np.isclose((yours - ours).min(), -6.4),
    ),
    "3.2": (
        ("np.argsort(-np.asarray(fitness)", "np.argsort(np.asarray(fitness)"),
        lambda yours, ours: np.array_equal(yours, ours[::-1]),
    ),
    "7.3": (
        ("    change[:, 0] = (change[:, 0] + np.pi) % (2 * np.pi) - np.pi\n", ""),
        lambda yours, ours: np.isclose(np.abs(yours - ours).max(), 2 * np.pi),
    ),
    "8.2": (
        ("np.linspace(-0.5, 0.5, len", "np.linspace(0.5, -0.5, len"),
        lambda yours, ours: np.allclose(yours, -ours),
    ),
    "15.4": (("matrix[g, :g]", "matrix[g, : g + 1]"), lambda yours, ours: (yours < ours).any()),
}
"""Task -> a slip in our solution, and what the numbers that are drawn must say of it."""


@pytest.mark.parametrize("task", SLIPS)
def test_a_wrong_answer_is_drawn_beside_the_right_one(task, tmp_path):
    change, holds = SLIPS[task]
    found = checkpoint(tmp_path, int(task.split(".")[0]), task, change)
    assert found.state == WRONG
    (panel,) = found.panels  # what is right of the answer is left out
    assert holds(panel.yours, panel.expected)
    assert found.save(tmp_path).read_bytes().startswith(b"\x89PNG")


def test_a_right_answer_is_drawn_alone(tmp_path):
    found = checkpoint(tmp_path, 8, "8.2")
    (panel,) = found.panels
    assert (found.state, found.message, panel.expected) == (RIGHT, "", None)
    assert np.array_equal(panel.over, np.sort(panel.over)) and panel.yours[-1] == 0.5


def test_a_mistake_that_the_picture_does_not_show_is_drawn_with_the_checks_calls(tmp_path):
    """Equals come in another order; in the picture's call there are none."""
    order = "np.lexsort((-np.arange(len(fitness)), fitness))"
    change = ('np.argsort(fitness, kind="stable")', order)
    found = checkpoint(tmp_path, 8, "8.2", change)
    assert found.state == WRONG
    assert all(panel.apart > 0 and panel.over is None for panel in found.panels)


def test_what_fails_or_changes_its_arguments_is_wrong(tmp_path):
    start = "    ### BEGIN SOLUTION task 8.2: turn fitness into utilities\n"
    found = checkpoint(tmp_path, 8, "8.2", (start, start + "    1 / 0\n"))
    assert found.state == WRONG and "ZeroDivisionError" in found.message
    assert all(panel.yours is None for panel in found.panels)
    change = ("    return utilities\n", "    fitness[:] = 0\n    return utilities\n")
    found = checkpoint(tmp_path, 8, "8.2", change)
    assert found.state == WRONG and "in place" in found.message
    found = checkpoint(tmp_path, 8, "8.2", (start, start + "    raise NotImplementedError\n"))
    assert (found.state, found.panels) == (OPEN, [])


def half_done(tmp_path):
    """Exercise 7 with 7.1 and 7.3 done, 7.3 wrong."""
    exercise = load_exercise(7, ROOT)
    text = exercise.known.solution.replace(*SLIPS["7.3"][0])
    for task in ("7.2", "7.4", "7.5", "7.6", "7.7"):
        region = rf"( *)### BEGIN SOLUTION task {task}: .*?### END SOLUTION\n"
        text = re.sub(region, rf'\1raise NotImplementedError("task {task}")\n', text, flags=re.S)
    (tmp_path / exercise.file).write_text(text)
    return exercise, tmp_path / exercise.file


def test_a_partly_done_exercise_shows_what_is_done(tmp_path, capsys):
    exercise, file = half_done(tmp_path)
    page = show_done(exercise, file, tmp_path)
    told, text = capsys.readouterr().out, page.read_text()
    assert "✓ 7.1" in told and "✗ 7.3" in told
    says = exercise.find("7.2").picture.says
    assert f"Task 7.2, Recording an episode, comes next. Task 7.2 adds: {says}" in told
    assert text.count("<figure>") == 2 and says in text and "Questions" not in text
    assert {each.name for each in page.parent.iterdir()} == {
        "all.html", "task_7_1.png", "task_7_3.png",
    }  # fmt: skip
    file.write_text(
        exercise.known.solution.replace(
            "### BEGIN SOLUTION", "raise NotImplementedError('task 7.1') #"
        )
    )
    with pytest.raises(BotschoolError, match=r"nothing to draw yet\. Task 7\.1, .* adds: "):
        show_done(exercise, file, tmp_path)


def test_one_task(tmp_path, capsys):
    exercise, file = half_done(tmp_path)
    picture = show_one(exercise, exercise.find("7.3"), file, tmp_path)
    told = capsys.readouterr().out
    assert picture.name == "task_7_3.png" and "7.3. Arrows: wrong" in told and "Orange" in told
    show_one(exercise, exercise.find("7.1"), file, tmp_path)
    assert "right" in (told := capsys.readouterr().out) and "Orange" not in told
    with pytest.raises(BotschoolError, match=r"7\.2 cannot be drawn: not done yet"):
        show_one(exercise, exercise.find("7.2"), file, tmp_path)
    with pytest.raises(BotschoolError, match=r"7\.6 has no picture .* 7\.1, 7\.2"):
        show_one(exercise, exercise.find("7.6"), file, tmp_path)


def test_many_tasks_have_a_picture_and_every_file_a_caption():
    """The first is among the first two tasks of each exercise."""
    tasks = {n: load_exercise(n, ROOT).tasks for n in exercise_numbers(ROOT)}
    drawn = [task for each in tasks.values() for task in each if task.picture]
    assert len(drawn) >= 70
    assert all(task.picture.says.endswith(".") and len(task.picture.says) > 20 for task in drawn)
    assert all(any(task.picture for task in each[:2]) for each in tasks.values())
    assert all(len(captions(n, ROOT)) >= 2 for n in tasks)


def test_pictures_lie_beside_the_grader_plain_or_packed(tmp_path, monkeypatch):
    """They find its drivers; a student's own file of that name takes the pictures away, no more."""
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path))
    folder = next((ROOT / "exercises").glob("ex08_*"))
    copy = shutil.copytree(folder, tmp_path / "exercises" / folder.name)
    (grader,) = copy.glob("test_*.py")
    solution = next((ROOT / "solutions").glob("ex08_*/*.py")).read_text()
    grader.write_text(pack(grader.read_text(), solution))
    exercise = load_exercise(8, tmp_path)
    place = copy / exercise.file
    place.write_text(solution)
    (found,) = checkpoints(exercise, [exercise.find("8.6")], place)
    assert found.state == RIGHT and found.panels[0].yours.shape == (60,)
    (copy / PICTURES).write_text("LINE = 1\n")
    exercise = load_exercise(8, tmp_path)
    assert not any(task.picture for task in exercise.tasks)


# ------------------------------------------------------------------- the page, and films
@pytest.fixture
def made(tmp_path):
    """Exercise 3 of a course of its own, with a picture, a film, and a film with its replay."""
    exercise = Exercise(3, "Tiny", file="tiny.py")
    exercise.task("3.1", "One").check(100)(lambda student: None)
    files = "- `b.mp4`: watch `it`\n  *move*.\n- `c.png`: a curve & more.\n- `a.mp4`: A.\n"
    folder = tmp_path / "exercises" / "ex03_tiny"
    folder.mkdir(parents=True)
    questions = "## Questions to think about\n\n1. Why? See [this](../x.md).\n"
    (folder / "README.md").write_text(f"# T\n\n{files}\n{questions}\n## Literature\n\nNone.\n")
    solutions = tmp_path / "solutions" / "ex03_tiny"
    solutions.mkdir(parents=True)
    (solutions / "README.md").write_text(
        "# Answers\n\n1. **Because.**\n\n| a | b |\n|---|---|\n| 1 | 2 |\n"
    )
    results = tmp_path / "results"
    results.mkdir()
    for name in ("a.mp4", "b.mp4", "other_one.png", "c.png", "all.html", "table.csv"):
        (results / name).write_bytes(b"x")
    draw("t", [panel("curves", LINE)]).savefig(results / "c.png")
    (results / "b.html").write_text('<p id="step">1</p><p title="x">"quoted"</p>')
    return exercise, results


def write(made, tmp_path, monkeypatch, more=""):
    exercise, results = made
    monkeypatch.setattr("botschool.grading.report.progress.load_exercise", lambda *_: exercise)
    shown = captioned(exercise, sorted(results.iterdir()), tmp_path)
    return shown, write_album(exercise, shown, results, tmp_path, more).read_text()


def test_the_page_has_captions_replays_questions_and_later_answers(made, tmp_path, monkeypatch):
    shown, text = write(made, tmp_path, monkeypatch)
    names = [each.path.name for each in shown]
    assert names == ["b.html", "c.png", "a.mp4", "other_one.png"]
    assert "Watch <code>it</code> <em>move</em>." in text and "A curve &amp; more." in text
    assert "Other one" in text and "b.mp4" not in text and 'title="x"' not in text
    assert "Why? See this." in text and "Literature" not in text
    assert "Because" not in text and "you have 0 of 100" in text
    remember(tmp_path, 3, [("3.1", 100, 100)], "digest")
    text = write(made, tmp_path, monkeypatch)[1]
    assert "<strong>Because.</strong>" in text and "<td>1</td>" in text and "<details>" in text
    assert "Because" not in write(made, tmp_path, monkeypatch, "Task 3.2 comes.")[1]


@pytest.mark.skipif(not find_browser(), reason="no Chromium")
def test_the_page_in_a_browser(made, tmp_path, monkeypatch):
    write(made, tmp_path, monkeypatch)
    (made[1] / "a.mp4").unlink()
    page = write_album(
        made[0], captioned(made[0], [*made[1].glob("[bc].*")], tmp_path), made[1], tmp_path, ""
    )
    browser = Browser(tmp_path / "profile")
    try:
        for width in (390, 1280):
            browser.resize(width, 800)
            browser.call("Page.navigate", url=f"file://{page}")
            browser.wait(
                "!!document.querySelector('iframe')?.contentDocument?.querySelector('#step')"
            )
            assert browser.run("document.documentElement.scrollWidth") == width
            assert browser.run("document.querySelector('img').naturalWidth") > 300
        assert not browser.errors
        assert all(r.startswith(("file:", "data:", "about:")) for r in browser.requests)
    finally:
        browser.close()
