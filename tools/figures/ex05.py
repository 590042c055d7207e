"""Exercise 5: what is made, a body's numbers, a walker at work."""

from matplotlib.patches import Rectangle
from style import BLUE, GREEN, ORANGE, above, frames, made, new, result, save, sketch, write


def draw() -> None:
    walkers, matrix = result(5, "walkers.png", 860), result(5, "matrix.png", 420)
    film = frames(made(5, "walker1.mp4"), (0.05, 0.15, 0.25, 0.35), 860, (0.1, 0.2, 0.9, 0.88))
    write(above(walkers, film), "ex05_result")
    write(matrix, "ex05_matrix")
    numbers()


def numbers() -> None:
    """Where the 64 numbers stand, and the straight stick that they begin with."""
    figure, axes = new(9, 2.9)
    sketch(axes, 9, 2.9)
    parts = (
        (22, "lengths and thicknesses\nof 11 segments", BLUE),
        (20, "limits of\n10 joints", ORANGE),
        (11, "default\nangles", GREEN),
        (11, "densities", "#7f4cb4"),
    )
    at, width = 0.3, 8.4 / 64
    for count, text, colour in parts:
        for k in range(count):
            axes.add_patch(
                Rectangle((at + k * width, 1.95), width * 0.85, 0.35, fc=colour, alpha=0.75)
            )
        axes.text(at + count * width / 2, 2.42, text, ha="center", va="bottom", color=colour)
        at += count * width
    axes.text(4.5, 1.62, "64 numbers of the body, behind those of the brain", ha="center")
    for k in range(11):
        colour = "#d5783c" if k == 0 else "#7f4cb4"
        axes.add_patch(
            Rectangle((0.6 + 0.71 * k, 0.62), 0.71, 0.17, fc=colour, ec="#2c2040", lw=0.8)
        )
        if k:
            axes.plot(0.6 + 0.71 * k, 0.705, "o", ms=4, color="#2c2040")
    axes.text(0.95, 0.9, "torso", ha="center", color="#d5783c")
    axes.text(4.8, 0.25, "all 0: a straight stick of eleven segments, and no joint can move",
              ha="center", color="#444444")  # fmt: skip
    save(figure, "ex05_numbers")
