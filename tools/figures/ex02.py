"""Exercise 2: what is made, the network and its parameters, what tanh does."""

import numpy as np
from matplotlib.patches import Rectangle
from style import BLUE, GREY, ORANGE, PALE, new, plain, result, save, sketch, write

COLOURS = {"b1": "#9bb8d3", "W1": BLUE, "b2": "#f0c9a8", "W2": ORANGE}


def draw() -> None:
    write(result(2, "random_networks.png"), "ex02_result")
    figure, axes = new(9, 3.6)
    sketch(axes, 9, 3.6)
    network(axes)
    matrices(axes)
    save(figure, "ex02_network")
    squeeze()


def network(axes, inputs: int = 4, hidden: int = 3, outputs: int = 2) -> None:
    """Circles and connections in the left half."""
    places = [
        [(x, 1.8 + 0.62 * (k - (count - 1) / 2)) for k in reversed(range(count))]
        for x, count in ((1.0, inputs), (2.6, hidden), (4.2, outputs))
    ]
    for before, after, colour in ((0, 1, BLUE), (1, 2, ORANGE)):
        for one in places[before]:
            for other in places[after]:
                axes.plot(*zip(one, other, strict=True), color=colour, lw=1, alpha=0.6, zorder=1)
    for layer, name, fill in zip(places, "xhy", ("white", PALE, "#fde8d8"), strict=True):
        for k, place in enumerate(layer, 1):
            axes.plot(*place, "o", ms=25, mfc=fill, mec="#444444", zorder=2)
            axes.text(*place, f"${name}_{k}$", ha="center", va="center", zorder=3)
    for x, text in ((1.0, "observation"), (2.6, "hidden neurons"), (4.2, "outputs")):
        axes.text(x, 3.35, text, ha="center")
    axes.text(1.75, 0.35, "$W_1, b_1$", color=BLUE, ha="center", fontsize=13)
    axes.text(3.45, 0.35, "$W_2, b_2$", color=ORANGE, ha="center", fontsize=13)


def matrices(axes) -> None:
    """The arrays that hold the parameters, in the right half."""
    for name, x, rows, columns in (("W1", 5.35, 3, 4), ("b1", 6.85, 3, 1), ("W2", 7.5, 2, 3),
                                   ("b2", 8.65, 2, 1)):  # fmt: skip
        for row in range(rows):
            for column in range(columns):
                corner = x + 0.28 * column, 2.05 - 0.28 * row
                axes.add_patch(Rectangle(corner, 0.26, 0.26, fc=COLOURS[name], ec="white"))
        middle = x + 0.14 * columns
        axes.text(middle, 2.5, f"{name}", ha="center", family="monospace")
        axes.text(middle, 2.05 - 0.28 * rows, f"({rows}, {columns})" if name[0] == "W" else
                  f"({rows},)", ha="center", fontsize=9, color="#555555")  # fmt: skip
    axes.text(7.1, 3.35, "its parameters, as arrays", ha="center")
    axes.text(7.1, 0.55, "a row for each neuron,\na column for each of its inputs", ha="center",
              fontsize=10, color="#555555")  # fmt: skip


def squeeze() -> None:
    figure, (left, right) = new(9, 2.9, 1, 2)
    x = np.linspace(-4, 4, 400)
    left.plot(x, x, "--", color=GREY, lw=1, label="unchanged")
    left.plot(x, np.tanh(x), color=BLUE, lw=2.5, label="tanh")
    left.set(xlabel="weighted sum", ylabel="activation", ylim=(-1.4, 1.4), title="A neuron's curve")
    left.legend(frameon=False, loc="upper left")
    for scale, colour in ((0.1, BLUE), (1, "#009e73"), (10, ORANGE)):
        right.plot(x, np.tanh(scale * x), color=colour, lw=2, label=f"weight {scale}")
    right.set(xlabel="input", ylim=(-1.15, 1.15), title="What the weight of an input does")
    right.legend(frameon=False, loc="upper left")
    for axes in (left, right):
        axes.axhline(0, color=GREY, lw=0.6)
    plain(left, right)
    save(figure, "ex02_tanh")
