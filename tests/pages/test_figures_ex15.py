"""The figure of exercise 15: chases in the page are those of the command."""

import numpy as np

from botschool.page.figures.ex15 import data
from living import built, click, drag, grip_of, open_figures, slide

RETURN = "figures.tournament.robot.total"


def chase(browser):
    """Play the episode to its end; return what the predator gets."""
    browser.run("while (!figures.tournament.robot.ended) figures.tournament.advance(500)")
    return browser.run(RETURN)


@built
def test_a_click_on_the_matrix_lets_two_robots_meet(browser, tmp_path):
    matrix = np.array(data()["matrix"])
    assert matrix.shape == (6, 6) and 0 < matrix.mean() < 1
    open_figures(browser, 15, tmp_path)
    assert browser.run("page.matrix") == matrix.tolist()
    for row, column in ((4, 0), (1, 1), (2, 5)):
        box = f"cells(figures.tournament)[{6 * row + column}].box"
        [x, y, width, height] = browser.run(box)
        click(browser, "tournament", x + width / 2, y + height / 2)
        chosen = browser.run("[figures.tournament.state.predator, figures.tournament.state.prey]")
        assert chosen == [row, column]
        assert chase(browser) == matrix[row, column]
    assert browser.errors == []


@built
def test_sliders_choose_and_a_hand_changes_the_chase(browser, tmp_path):
    open_figures(browser, 15, tmp_path)
    slide(browser, "tournament", "predator", 3)
    slide(browser, "tournament", "prey", 0)
    told = browser.run("figures.tournament.canvas.getAttribute('aria-label')")
    assert "The predator of generation 180 meets the prey of generation 0" in told
    x, y = grip_of(browser, "tournament", "grip1")
    prey = grip_of(browser, "tournament", "grip2")
    before = browser.run("[...figures.tournament.robot.state]")
    drag(browser, "tournament", (x, y), (x, y + 0.6 * (prey[1] - y) + 40))
    after = browser.run("[...figures.tournament.robot.state]")
    assert after[:2] != before[:2] and after[2:] == before[2:]
    chase(browser)
    assert browser.errors == []
