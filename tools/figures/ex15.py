"""Exercise 15: what is made, the two robots, what a race and a circle look like."""

import numpy as np
from matplotlib.patches import Circle, Wedge
from style import BLUE, GREY, ORANGE, RED, above, arrow, new, result, save, write


def draw() -> None:
    matrices = result(15, "tournament.png", 720, (0, 0, 1, 0.565))
    chases = result(15, "chases.png", 720, (0, 0, 1, 0.345))
    write(above(matrices, chases), "ex15_result")
    write(result(15, "red_queen.png", 720), "ex15_red_queen")
    robots()
    patterns()


def robots() -> None:
    from botschool import arena

    world = arena.make("predprey")
    figure, axes = new(9, 3.6)
    predator, prey = (-500.0, 0.0), (500.0, 0.0)
    for place, model, colour, name, heading in (
        (predator, world.models[0], ORANGE, "predator", 0),
        (prey, world.models[1], BLUE, "prey, faster", 180),
    ):
        for k in range(8):
            axes.add_patch(
                Wedge(place, 420, heading + 45 * k, heading + 45 * (k + 1), fill=False,
                      ec=GREY, lw=0.6, ls=":")
            )  # fmt: skip
        for degrees in model.directions:
            axes.add_patch(
                Wedge(place, model.radius + model.range, heading + degrees - 8,
                      heading + degrees + 8, fc=RED, alpha=0.25)
            )  # fmt: skip
        axes.add_patch(Circle(place, model.radius, fc=colour, ec="black", zorder=3))
        way = 75 if heading == 0 else -75
        arrow(axes, place, (place[0] + way, 0), "white", 2)
        axes.texts[-1].set_zorder(5)
        axes.text(place[0], -500, name, ha="center", color=colour, fontsize=12)
    spread = np.degrees(np.arcsin(85 / 1000))
    axes.add_patch(Wedge(predator, 1000, -spread, spread, fc=ORANGE, alpha=0.15))
    axes.annotate("", (-500, 330), (500, 330), arrowprops={"arrowstyle": "<->"})
    axes.text(0, 350, "1 metre at the start", ha="center")
    axes.text(1010, 150, "dotted: the eight sectors of\nits camera, which says in\nwhich of them "
              "the other is,\nand how large it looks", fontsize=10, color="#555555")  # fmt: skip
    axes.text(1010, -190, "red: infrared sensors,\nas far as they see", fontsize=10, color=RED)
    axes.text(1010, -430, "orange: how the predator\nsees the prey", fontsize=10, color=ORANGE)
    axes.set(xlim=(-950, 1750), ylim=(-540, 450), aspect="equal")
    axes.axis("off")
    save(figure, "ex15_robots")


def patterns() -> None:
    """Made-up matrices of predators: a race, a circle, a standstill."""
    n = 10
    rows, columns = np.mgrid[0:n, 0:n]
    matrices = {
        "an arms race": 0.5 + 0.05 * (rows - columns),
        "a circle": 0.5 + 0.4 * np.sin(2 * np.pi * (rows - columns) / 5),
        "only the predators progress": 0.15 + 0.075 * rows + 0.0 * columns,
    }
    figure, panels = new(9.2, 3.2, 1, 3)
    for axes, (title, matrix) in zip(panels, matrices.items(), strict=True):
        image = axes.imshow(matrix, origin="lower", cmap="viridis", vmin=0, vmax=1)
        axes.plot([-0.5, n - 0.5], [-0.5, n - 0.5], color="white", lw=1.2, ls="--")
        axes.set(title=title, xticks=[], yticks=[], xlabel="generation of the prey →")
    panels[0].set_ylabel("generation of the\npredators →")
    figure.colorbar(image, ax=panels, label="fitness of the predators", shrink=0.85)
    save(figure, "ex15_patterns")
