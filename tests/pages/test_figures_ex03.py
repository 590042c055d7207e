"""The figures of exercise 3: the two hills follow the solution, the pendulum's line the command."""

import numpy as np
import pytest

from botschool import config
from botschool.evolution.run import Run
from living import ROOT, slide, state

SWING = """[EXP]
environment = Pendulum-v1
algo = SSS
[POLICY]
episodes = 5
pepisodes = 20
maxsteps = 200
nhiddens = 10
bias = 1
out_type = 3
[ALGO]
popsize = 8
mutrate = 0.4
"""


def solution():
    """The names of the solution's file."""
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex03_evolution_strategy/evolution_strategy.py").read_text(), names)
    return names


def chance(seed, generation, *shape):
    """Normal numbers as the page draws them."""
    return np.random.Generator(np.random.Philox(key=[seed, generation])).standard_normal(shape)


def height(population, low, high):
    """What the places of the map are worth."""
    (x, y), (a, b), (c, d) = np.transpose(population), low, high
    return 0.65 * np.exp(-((x - a) ** 2 + (y - b) ** 2) / 0.9) + np.exp(
        -((x - c) ** 2 + (y - d) ** 2) / 1.6
    )


def followed(s, generations):
    """The same run by the solution: the population, and [measured, worth] of each best one."""
    student, curve = solution(), []
    population = s["at"] + 0.5 * chance(s["seed"], 0, s["size"], 2)
    for g in range(generations + 1):
        worth = height(population, s["low"], s["high"])
        fitness = worth + s["luck"] * chance(s["seed"] + 1000, g, s["size"])
        best = student["rank"](fitness)[0]
        curve.append([fitness[best], worth[best]])
        if g < generations:
            rng = np.random.Generator(np.random.Philox(key=[s["seed"], g + 1]))
            population = student["next_population"](population, fitness, s["mutrate"], rng)
    return population, curve


def test_the_population_climbs_as_the_solution_says(page):
    for key, value, generations in (("mutrate", 0.1, 3), ("mutrate", 1.2, 12), ("size", 2, 8)):
        slide(page, "hills", key, value)
        page.run("figures.hills.press('again')")
        page.run(f"figures.hills.advance({generations})")
        s = state(page, "hills")
        population, curve = followed(s, generations)
        assert s[key] == value and s["population"] == population.tolist()
        np.testing.assert_allclose(s["curve"], curve, rtol=1e-12)
    measured, worth = max(curve)
    assert [s["record"]["measured"], s["record"]["worth"]] == pytest.approx([measured, worth])


def test_the_pendulum_evolves_as_with_the_command(page, tmp_path):
    slide(page, "swing", "size", 8)
    slide(page, "swing", "mutrate", 0.4)
    page.run("figures.swing.advance(2)")
    (tmp_path / "swing.ini").write_text(SWING)
    run = Run(config.load(tmp_path / "swing.ini"), 1)
    for _ in range(10):
        run.advance()
    rows = page.run("figures.swing.rows")
    assert state(page, "swing")["generation"] == len(rows) == 10
    assert rows == run.record.rows()[:, :6].tolist()
    assert page.run("[...figures.swing.run.bestg]") == run.record.bestg.tolist()
