"""Exercise 10: what is made, the robot and its frames, how it stays up."""

import numpy as np
from matplotlib.patches import Circle, Polygon, Rectangle
from style import (
    BLUE,
    GREEN,
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
    write,
)  # fmt: skip


def draw() -> None:
    film = frames(made(10, "balance.mp4"), (0, 0.02, 0.04, 0.07, 0.1, 0.15), 900, (0, 0, 1, 0.94))
    write(above(result(10, "balance.png", 900), film), "ex10_result")
    robot()
    balancing()


def robot() -> None:
    figure, axes = new(9, 4.4)
    sketch(axes, 9, 4.4)
    scale, ground, middle = 7.0, 0.45, 3.0
    axes.plot([0.5, 5.5], [ground, ground], color=GREY, lw=1.5)

    def place(x, z):
        return middle + scale * x, ground + scale * z

    axes.add_patch(Rectangle(place(-0.1, 0.1), 0.2 * scale, 0.4 * scale, fc="#cfe3f2", ec=BLUE))
    for side in (-1, 1):
        x = 0.12 * side
        axes.add_patch(
            Rectangle(place(x - 0.01, 0), 0.02 * scale, 0.2 * scale, fc="#55555c", ec="black")
        )
        arrow(axes, place(x, 0.1), place(x + 0.07 * side, 0.1), ORANGE, 2)
        axes.plot(*place(x, 0.1), "o", ms=6, color=ORANGE)
    for end, name in (((0.06, 0), "x"), ((0, 0.06), "z")):
        arrow(axes, place(0, 0), place(*end), "black", 1.8)
        axes.text(*place(end[0] * 1.25, end[1] * 1.25), name, ha="center", va="center")
    axes.plot(*place(0, 0.3), "P", ms=11, color=RED)
    notes = (
        ("torso: link, 0.8 kg, a box 40 cm high", (0.1, 0.45), (0.42, 0.5), BLUE),
        ("its centre of mass: inertial origin 0 0 0.3", (0, 0.3), (0.42, 0.36), RED),
        ("right_axle: joint, origin and axis\n(what the wheel turns around)", (0.19, 0.1),
         (0.42, 0.19), ORANGE),
        ("the torso's frame: its point 0 0 0 on the floor,\ny points away from you", (0.01, 0.0),
         (0.42, 0.03), "black"),
    )  # fmt: skip
    for text, start, end, colour in notes:
        axes.annotate(text, place(*start), place(*end), color=colour, va="center", fontsize=10,
                      arrowprops={"arrowstyle": "-", "color": colour, "lw": 0.8})  # fmt: skip
    axes.text(*place(-0.16, 0.24), "left_wheel", ha="right", fontsize=10, color="#55555c")
    save(figure, "ex10_robot")


def balancing() -> None:
    """Four moments from the side."""
    figure, axes = new(9, 2.7)
    sketch(axes, 9, 2.7)
    axes.plot([0.2, 8.8], [0.35, 0.35], color=GREY, lw=1.5)
    moments = (
        (1.0, 0.0, 0, "in balance, for a moment"),
        (3.2, 0.28, 0, "it leans forwards ..."),
        (5.6, 0.3, 0.75, "... the wheels run ahead ..."),
        (8.0, 0.02, 0.2, "... and are under it again"),
    )
    for x, lean, speed, text in moments:
        wheel = np.array([x, 0.65])
        up, across = np.array([np.sin(lean), np.cos(lean)]), np.array([np.cos(lean), -np.sin(lean)])
        corners = [wheel + a * 0.13 * across + b * up for a, b in
                   ((-1, 0.0), (1, 0.0), (1, 1.5), (-1, 1.5))]  # fmt: skip
        axes.add_patch(Polygon(corners, fc="#cfe3f2", ec=BLUE))
        axes.add_patch(Circle(wheel, 0.3, fc="#55555c", ec="black"))
        axes.plot(*(wheel + 0.75 * up), "P", ms=9, color=RED)
        axes.plot([wheel[0]] * 2, [0.65, 2.25], ":", color=GREY, lw=1)
        if speed:
            arrow(axes, (x + 0.35, 0.65), (x + 0.35 + speed, 0.65), GREEN, 2.5)
        axes.text(x, 0.05, text, ha="center", fontsize=10)
    save(figure, "ex10_balancing")
