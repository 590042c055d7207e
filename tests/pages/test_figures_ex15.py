"""The figure of exercise 15: chases in the page are those of the command."""

import numpy as np

from botschool.page.figures.ex15 import data
from living import click

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
