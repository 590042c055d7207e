"""The figure of exercise 15: chases in the page are those of the command."""

import numpy as np

from botschool.page.figures.ex15 import data
from living import click, drag, grip_of, slide

RETURN = "figures.tournament.robot.total"


def chase(page):
    """Play the episode to its end; return what the predator gets."""
    page.run("while (!figures.tournament.robot.ended) figures.tournament.advance(500)")
    return page.run(RETURN)


def test_a_click_on_the_matrix_lets_two_robots_meet(page):
    matrix = np.array(data()["matrix"])
    assert matrix.shape == (6, 6) and 0 < matrix.mean() < 1
    assert page.run("page.matrix") == matrix.tolist()
    for row, column in ((4, 0), (1, 1), (2, 5)):
        box = f"cells(figures.tournament)[{6 * row + column}].box"
        [x, y, width, height] = page.run(box)
        click(page, "tournament", x + width / 2, y + height / 2)
        chosen = page.run("[figures.tournament.state.predator, figures.tournament.state.prey]")
        assert chosen == [row, column]
        assert chase(page) == matrix[row, column]


def test_sliders_choose_and_a_hand_changes_the_chase(page):
    slide(page, "tournament", "predator", 3)
    slide(page, "tournament", "prey", 0)
    told = page.run("figures.tournament.canvas.getAttribute('aria-label')")
    assert "The predator of generation 180 meets the prey of generation 0" in told
    x, y = grip_of(page, "tournament", "grip1")
    prey = grip_of(page, "tournament", "grip2")
    before = page.run("[...figures.tournament.robot.state]")
    drag(page, "tournament", (x, y), (x, y + 0.6 * (prey[1] - y) + 40))
    after = page.run("[...figures.tournament.robot.state]")
    assert after[:2] != before[:2] and after[2:] == before[2:]
    chase(page)
