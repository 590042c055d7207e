"""Exercise 8: what is made, the cloud of candidates, utilities, the fall of a curve."""

import numpy as np
from style import BLUE, GREEN, GREY, ORANGE, RED, arrow, new, plain, result, save, solution, write


def draw() -> None:
    write(result(8, "stability.png", 920), "ex08_result")
    cloud()
    utilities()
    fall()


def slope(points: np.ndarray) -> np.ndarray:
    return -((points[..., 0] - 2.2) ** 2 + 2.5 * (points[..., 1] - 1.4) ** 2)


def cloud() -> None:
    student = solution(8)
    rng = np.random.default_rng(11)
    figure, (left, right) = new(9, 3.9, 1, 2)
    x, y = np.meshgrid(np.linspace(-2, 3, 150), np.linspace(-2, 2.6, 150))
    centre, noise = np.array([0.0, 0.0]), rng.standard_normal((10, 2))
    pairs = np.stack([centre + 0.6 * noise, centre - 0.6 * noise], axis=1)
    ranks = student.utilities(slope(pairs.reshape(-1, 2)))
    for axes in (left, right):
        axes.contour(x, y, slope(np.stack([x, y], axis=-1)), 14, colors="#c9dcc9", linewidths=1,
                     linestyles="solid")  # fmt: skip
        axes.plot(2.2, 1.4, "*", ms=16, color=GREEN)
        axes.set(xticks=[], yticks=[], xlim=(-1.8, 2.8), ylim=(-1.8, 2.2), aspect="equal")
    for one, other in pairs:
        left.plot(*zip(one, other, strict=True), color=GREY, lw=0.8, zorder=1)
    shown = left.scatter(*pairs.reshape(-1, 2).T, c=ranks, cmap="RdYlBu", s=48, ec="#444444",
                         lw=0.6, zorder=2)  # fmt: skip
    figure.colorbar(shown, ax=left, label="utility", shrink=0.8)
    left.plot(*centre, "o", ms=9, color="black", zorder=3)
    left.set_title("ten samples, on both sides of the centre")
    plus, minus = ranks[0::2], ranks[1::2]
    for difference, vector in zip(plus - minus, noise, strict=True):
        tip = centre + 0.6 * difference * vector
        right.plot(*zip(centre, tip, strict=True), color=ORANGE, lw=1.3, alpha=0.7)
    direction = ((plus - minus)[:, None] * noise).sum(axis=0)
    arrow(right, centre, centre + 1.5 * direction / np.linalg.norm(direction), BLUE, 3)
    right.plot(*centre, "o", ms=9, color="black")
    right.set_title("each pair weighted (orange), all added up (blue)", fontsize=11)
    save(figure, "ex08_cloud")


def utilities() -> None:
    student = solution(8)
    fitness = np.array([9.0, 10.0, 500.0, 12.0, 11.0, 31.0])
    order = np.argsort(fitness)
    figure, (left, right) = new(9, 2.7, 1, 2)
    names = [f"c{k}" for k in order]
    colours = [RED if value == 500 else BLUE for value in fitness[order]]
    left.bar(names, fitness[order], color=colours)
    left.set(title="fitness: one was lucky", ylabel="return")
    right.bar(names, student.utilities(fitness)[order], color=colours)
    right.axhline(0, color="black", lw=0.8)
    right.set(title="utility: every rank is worth a step")
    plain(left, right)
    save(figure, "ex08_utilities")


def fall() -> None:
    x = np.arange(0, 201)
    curve = 20 + 70 * (1 - np.exp(-x / 40)) - 25 * np.exp(-(((x - 120) / 14) ** 2))
    highest = np.maximum.accumulate(curve)
    bottom = int(np.argmax(highest - curve))
    figure, axes = new(8.6, 2.9)
    axes.plot(x, curve, color=BLUE, lw=2.4, label="the curve")
    axes.plot(x, highest, "--", color=GREY, lw=1.4, label="its height so far")
    axes.fill_between(x, curve, highest, color=RED, alpha=0.12)
    axes.annotate("", (bottom, curve[bottom]), (bottom, highest[bottom]),
                  arrowprops={"arrowstyle": "<->", "color": RED, "lw": 2})  # fmt: skip
    axes.text(bottom, 53, "largest fall", color=RED, ha="center")
    axes.annotate("", (208, curve.min()), (208, curve.max()),
                  arrowprops={"arrowstyle": "<->", "color": GREEN, "lw": 2})  # fmt: skip
    axes.text(211, 45, "whole\nheight", color=GREEN)
    axes.set(xlabel="generation", ylabel="mean fitness", xlim=(0, 232))
    axes.legend(frameon=False, loc="lower center")
    plain(axes)
    save(figure, "ex08_drop")
