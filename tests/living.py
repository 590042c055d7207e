"""What tests of the exercises' living pages share: open a page, use a figure as a hand does."""

from pathlib import Path

import numpy as np

from botschool import _core
from botschool.page.exercise import exercise_page
from botschool.page.markdown import FIGURE
from botschool.problems.native import NativeProblem

ROOT = Path(__file__).parents[1]
FOLDERS = {int(path.name[2:4]): path for path in sorted(ROOT.glob("exercises/ex[0-9]*"))}
NAMED = {n: FIGURE.findall((path / "README.md").read_text()) for n, path in FOLDERS.items()}
"""The figures that each exercise's text names."""
WITH_PAGES = [n for n, names in NAMED.items() if names]


def open_figures(browser, number, tmp_path, width=1280, dark=False):
    """Write an exercise's page and open it, with nothing moving; return its path."""
    path = tmp_path / f"ex{number:02d}.html"
    path.write_text(exercise_page(FOLDERS[number]), encoding="utf-8")
    browser.errors.clear()
    browser.requests.clear()
    browser.resize(width, 900, phone=width < 500, dark=dark)
    browser.call("Page.navigate", url="about:blank")
    browser.call("Page.navigate", url=f"file://{path}#still")
    browser.wait("document.body?.dataset.ready")
    return path


def place_of(browser, name, x, y):
    """Scroll to a figure; return the window's point at (x, y), pixels of its picture."""
    canvas = f"figures.{name}.canvas"
    browser.run(f"{canvas}.scrollIntoView({{block: 'center', behavior: 'instant'}})")
    box = browser.run(f"{canvas}.getBoundingClientRect().toJSON()")
    return box["x"] + x, box["y"] + y


def drag(browser, name, start, end):
    """Drag with the mouse in a figure, from and to (x, y) in pixels of its picture."""
    for kind, (x, y), buttons in (
        ("mousePressed", start, 1),
        ("mouseMoved", [(a + b) / 2 for a, b in zip(start, end, strict=True)], 1),
        ("mouseMoved", end, 1),
        ("mouseReleased", end, 0),
    ):
        at = dict(zip("xy", place_of(browser, name, x, y), strict=True))
        browser.call(
            "Input.dispatchMouseEvent",
            type=kind,
            button="left",
            buttons=buttons,
            clickCount=1,
            **at,
        )


def touch(browser, name, start, end):
    """Drag with a finger in a figure."""
    path = [start, [(a + b) / 2 for a, b in zip(start, end, strict=True)], end]
    for kind, at in zip(("touchStart", "touchMove", "touchMove"), path, strict=True):
        point = dict(zip("xy", place_of(browser, name, *at), strict=True))
        browser.call("Input.dispatchTouchEvent", type=kind, touchPoints=[point])
    browser.call("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])


def click(browser, name, x, y):
    """Click in a figure's picture, at (x, y) in its pixels."""
    drag(browser, name, (x, y), (x, y))


def grip_of(browser, name, grip):
    """Return where a figure's grip is in its picture."""
    return browser.run(f"figures.{name}.grips().find(({{ name }}) => name === {grip!r}).at")


def focus(browser, name):
    """Put the keyboard on a figure's picture."""
    browser.run(f"figures.{name}.canvas.focus()")


def slide(browser, name, key, value):
    """Move a slider as the keyboard does."""
    browser.run(
        f"(() => {{ const [input] = [...figures.{name}.section.querySelectorAll('input')]"
        f".filter((one) => one.dataset.key === {key!r}); input.value = {value};"
        f" input.dispatchEvent(new Event('input')); }})()"
    )


def state(browser, name):
    """Return a figure's state."""
    return browser.run(f"figures.{name}.state")


class Stepped:
    """A saved robot in a post-evaluation of seed 1, step by step in Python."""

    def __init__(self, experiment, saved, limit, episode=0, body=None):
        problem = NativeProblem(experiment.exp.environment)
        self.policy = problem.policy(experiment.policy)
        self.policy.load(*self.policy.split(saved))
        self.policy.reset(100_001, episode)
        self.stepper = _core.make_stepper(problem.dynamics)
        self.stepper.set(limit)
        if body is not None:
            self.stepper.set_body(body)
        self.stepper.start(100_001, episode)
        self.total, self.steps, self.ended = 0.0, 0, False

    def run(self, steps, action=None, blind=()):
        """Go on until the episode ends, with the robot's own action or another."""
        for _ in range(steps):
            if self.ended:
                break
            seen = self.stepper.observation
            seen[list(blind)] = 0
            own = np.atleast_1d(self.policy.act(seen)).astype(float)
            reward, self.ended = self.stepper.step(own if action is None else np.array([action]))
            self.total += reward
            self.steps += 1
        return self
