"""Exercise 3: what is made, one generation, a population on its way."""

import numpy as np
from matplotlib.patches import Rectangle
from style import (
    BLUE,
    GREY,
    ORANGE,
    RED,
    above,
    arrow,
    frames,
    made,
    new,
    result,
    save,
    sketch,
    solution,
    write,
)  # fmt: skip


def draw() -> None:
    film = frames(made(3, "pendulum.mp4"), (0, 0.05, 0.1, 0.15, 0.2, 0.3), 620, (0.1, 0, 0.9, 0.94))
    write(above(result(3, "curves.png", 620), film), "ex03_result")
    generation()
    landscape()


def generation() -> None:
    """Six individuals are ranked; the better half stays and is copied with small changes."""
    rng = np.random.default_rng(5)
    genes = rng.normal(0, 0.5, (6, 9))
    fitness = np.array([31, 9, 54, 12, 88, 40])
    order = np.argsort(-fitness)
    figure, axes = new(9.2, 3.7)
    sketch(axes, 11.5, 4.6)

    def column(x, rows, notes, colours):
        for k, (row, note, colour) in enumerate(zip(rows, notes, colours, strict=True)):
            y = 3.3 - 0.58 * k
            for g, gene in enumerate(row):
                shade = np.clip(0.5 + 0.35 * gene, 0, 1)
                axes.add_patch(Rectangle((x + 0.2 * g, y), 0.2, 0.38, fc=(shade, shade, shade)))
            axes.add_patch(Rectangle((x, y), 1.8, 0.38, fill=False, ec=colour, lw=1.8))
            axes.text(x + 1.9, y + 0.19, note, va="center", fontsize=10, color=colour)

    titles = ((0.1, "1. evaluate"), (3.2, "2. rank"), (6.2, "3. select"), (9.1, "4. vary"))
    for x, title in titles:
        axes.text(x + 0.9, 4.15, title, ha="center", fontsize=12)
    ranked, points = genes[order], fitness[order]
    column(0.1, genes, fitness, ["#444444"] * 6)
    column(3.2, ranked, points, [BLUE] * 3 + [RED] * 3)
    column(6.2, ranked[:3], ["", "", ""], [BLUE] * 3)
    for k in range(3, 6):
        y = 3.3 - 0.58 * k
        axes.add_patch(Rectangle((6.2, y), 1.8, 0.38, fc="white", ec=GREY, ls="--"))
        axes.text(7.1, y + 0.19, "free", ha="center", va="center", fontsize=9, color=GREY)
    children = ranked[:3] + rng.normal(0, 0.25, (3, 9))
    column(9.1, np.vstack([ranked[:3], children]), [""] * 6, [BLUE] * 3 + [ORANGE] * 3)
    for x in (2.75, 5.75, 8.55):
        arrow(axes, (x - 0.1, 4.25), (x + 0.35, 4.25), GREY)
    for k in range(3):
        start, end = 3.49 - 0.58 * k, 3.49 - 0.58 * (k + 3)
        arrow(axes, (10.95, start), (10.95, end), ORANGE, 1.2, -0.45)
    save(figure, "ex03_generation")


def landscape() -> None:
    """The strategy with two parameters, on hills that can be seen."""
    student = solution(3)
    x, y = np.meshgrid(np.linspace(-3, 3, 200), np.linspace(-3, 3, 200))

    def height(points):
        a, b = points[..., 0], points[..., 1]
        low = 0.65 * np.exp(-((a + 1.1) ** 2 + (b + 0.9) ** 2) / 0.9)
        return low + np.exp(-((a - 1.2) ** 2 + (b - 1.1) ** 2) / 1.6)

    ground = height(np.stack([x, y], axis=-1))
    figure, grid = new(9.2, 5.0, 2, 4)
    for row, rate in zip(grid, (0.1, 1.2), strict=True):
        population = np.random.default_rng(3).normal([-1.3, 0.2], 0.5, (20, 2))
        panels = iter(row)
        for number in range(31):
            fitness = height(population)
            best = population[student.rank(fitness)[:10]]
            if number in (0, 2, 8, 30):
                axes = next(panels)
                axes.contourf(x, y, ground, 12, cmap="Greens")
                axes.plot(*population.T, "o", ms=5, mfc=ORANGE, mec="white", mew=0.6)
                axes.plot(*best.T, "o", ms=5, mfc=BLUE, mec="white", mew=0.6)
                axes.set(xticks=[], yticks=[], aspect="equal", xlim=(-3, 3), ylim=(-3, 3))
                axes.set_title(f"generation {number}", fontsize=10)
            rng = np.random.default_rng([7, number])
            population = np.vstack([best, best + rate * rng.standard_normal(best.shape)])
        row[0].set_ylabel(f"mutation rate {rate}")
    save(figure, "ex03_landscape")
