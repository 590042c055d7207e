"""The ten runs of exercise 4's figure are the command's, and so is what their robots are worth."""

import numpy as np
import pytest

from botschool import config
from botschool.course import SavedRobot
from botschool.evolution.run import Run
from botschool.paths import material
from living import click, focus, slide, state

ACROBOT = material() / "data/experiments/acrobot.ini"


def followed(seed, generations, **policy):
    """Run some generations of the experiment with a seed."""
    experiment = config.load(ACROBOT)
    for key, value in policy.items():
        setattr(experiment.policy, key, value)
    run = Run(experiment, seed)
    for _ in range(generations):
        run.advance()
    return run.record


@pytest.mark.parametrize("policy", [{}, {"episodes": 5, "pepisodes": 1}])
def test_ten_runs_are_the_command_s(page, policy):
    for key, value in policy.items():
        page.run(f"figures.runs.press('{key}-{value}')")
    page.run("figures.runs.advance(10)")
    made = state(page, "runs")["generations"]
    assert sum(made) == 20 and min(made) >= 1
    for seed in (1, 4, 10):
        record = followed(seed, made[seed - 1], **policy)
        rows = page.run(f"figures.runs.rows[{seed - 1}]")
        assert rows == record.rows()[:, :6].tolist()
        found = page.run(f"[...figures.runs.runs[{seed - 1}].bestg]")
        assert found == record.bestg.tolist()
    new = SavedRobot(ACROBOT, record.bestg).evaluate(2_000_000, 200).mean()
    kept = page.run("tried(figures.runs.robots[9].task, figures.runs.runs[9].bestg)")
    assert kept == pytest.approx(new, rel=1e-12)


def test_a_run_is_chosen_and_a_guess_is_kept(page):
    slide(page, "runs", "guess", -90)
    page.run("figures.runs.advance(6)")
    left, top, width, height = page.run("tiles(figures.runs)[6]")
    click(page, "runs", left + width / 2, top + height / 2)
    assert state(page, "runs")["chosen"] == 7
    focus(page, "runs")
    page.press("ArrowRight")
    s = state(page, "runs")
    assert (s["chosen"], s["guess"]) == (8, -90)
    assert "seed 8" in page.run("figures.runs.line.textContent")
    rows = followed(8, s["generations"][7]).rows()
    best = np.format_float_positional(rows[-1, 1], trim="-").replace("-", "−")
    assert f"best {best}," in page.run("figures.runs.line.textContent")


def test_robots_are_measured_at_the_end_of_their_runs(page):
    page.run("figures.runs.advance(5)")
    # as if the first run had used its steps
    page.run("figures.runs.rows.forEach((rows, i) => { rows.at(-1)[0] = i ? 400000 : 300000 })")
    page.run("figures.runs.advance(5)")
    assert all(state(page, "runs")["worth"])
    record = followed(1, 1)
    for kind in ("best", "bestg"):
        new = SavedRobot(ACROBOT, getattr(record, kind)).evaluate(2_000_000, 200).mean()
        assert state(page, "runs")["worth"][0][kind] == pytest.approx(new, rel=1e-12)
    assert "your guess was −65" in page.run("figures.runs.line.textContent")


def dice(seed, at, count):
    """The sum of a throw, with the page's uniform()."""

    def product(a, b):
        return a * b & 0xFFFFFFFF

    state, total = 1_000_000 * seed + at + 1, 0
    for _ in range(count):
        state = state + 0x6D2B79F5 & 0xFFFFFFFF
        mixed = product(state ^ state >> 15, state | 1)
        mixed ^= mixed + product(mixed ^ mixed >> 7, mixed | 61) & 0xFFFFFFFF
        total += 1 + 6 * (mixed ^ mixed >> 14) // 2**32
    return total


def test_the_highest_throw_keeps_no_promise(page):
    slide(page, "dice", "dice", 20)
    page.run("figures.dice.press('other')")
    page.run("figures.dice.advance(200)")
    page.run("figures.dice.press('same')")
    s = state(page, "dice")
    assert s["sums"] == [dice(2, at, 20) for at in range(1000)]
    assert s["again"] == [dice(2, 500_000 + at, 20) for at in range(10)]
    assert max(s["sums"]) > 90 > np.mean(s["again"])
    assert f"highest {max(s['sums'])}" in page.run("figures.dice.line.textContent")
