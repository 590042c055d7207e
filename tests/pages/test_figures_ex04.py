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
