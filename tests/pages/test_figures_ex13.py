"""The figures of exercise 13 compute advantages and the clipped surrogate as the solution does."""

import numpy as np
import pytest

from living import ROOT, drag, grip_of, slide, state


@pytest.fixture(scope="module")
def solution():
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex13_inside_ppo/inside_ppo.py").read_text(), names)
    return names


def judged(solution, s):
    """The advantages that the solution finds for a strip."""
    count = len(s["rewards"])
    starts = np.arange(count)[:, None] == s["end"]
    done = np.array([float(s["end"] == count)])
    column = [np.array(s[key])[:count, None] for key in ("rewards", "values")]
    last = np.array(s["values"][-1:])
    found = solution["advantages"](
        *column, starts.astype(float), last, done, s["gamma"], s["lambda"]
    )
    return found[:, 0]


def test_rewards_values_and_the_end_are_dragged(page, solution):
    before = state(page, "strip")
    np.testing.assert_allclose(before["advantages"], judged(solution, before), atol=1e-6)
    assert np.flatnonzero(before["advantages"]).tolist() == [*range(8, 15)]
    pixels = page.run("strips(figures.strip).rewards.box[3]") / 4.8
    for grip, up in (("rewards4", 1), ("values11", -1.5), ("values21", 1)):
        x, y = grip_of(page, "strip", grip)
        drag(page, "strip", (x, y), (x, y - up * pixels))
    x, y = grip_of(page, "strip", "end")
    step = page.run("strips(figures.strip).rewards.x(1) - strips(figures.strip).rewards.x(0)")
    drag(page, "strip", (x, y), (x + 3 * step, y))
    slide(page, "strip", "lambda", 0.6)
    slide(page, "strip", "gamma", 0.9)
    s = state(page, "strip")
    assert [s["end"], s["lambda"], s["gamma"]] == [11, 0.6, 0.9]
    moved = [s["rewards"][3], s["values"][10], s["values"][20]]
    np.testing.assert_allclose(moved, [1, -1.5, 1], atol=1e-6)
    np.testing.assert_allclose(s["advantages"], judged(solution, s), atol=1e-6)
