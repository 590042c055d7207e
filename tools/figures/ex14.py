"""Exercise 14: what is made, luck, and what one would have in hand."""

import itertools

import numpy as np
from style import BLUE, GREY, ORANGE, RED, new, plain, result, save, write


def draw() -> None:
    write(result(14, "success.png", 920), "ex14_result")
    write(result(14, "indicators.png", 900, (0, 0, 1, 0.483)), "ex14_indicators")
    luck()
    in_hand()


def luck() -> None:
    """All ways to deal six results out to two groups of three."""
    values = np.array([120.0, 135, 150, 180, 210, 240])
    ways = [np.isin(np.arange(6), way) for way in itertools.combinations(range(6), 3)]
    gaps = np.array([values[way].mean() - values[~way].mean() for way in ways])
    order = np.argsort(gaps, kind="stable")
    figure, (left, right) = new(8.8, 3.3, 1, 2, width_ratios=(2, 1))
    for column, k in enumerate(order):
        extreme = column in (0, 19)
        for value, mine in zip(values, ways[k], strict=True):
            left.plot(column, value, "o", ms=7, color=ORANGE if mine else BLUE,
                      alpha=1 if extreme else 0.45)  # fmt: skip
        if extreme:
            left.axvspan(column - 0.5, column + 0.5, color=RED, alpha=0.15, lw=0)
    left.set(xlabel="20 ways to deal six results out to two groups", ylabel="return", xticks=[])
    left.set_title("in 2 of 20 one group is all better: 0.1")
    seeds = [3, 4, 5, 6]
    from math import comb

    chances = [2 / comb(2 * n, n) for n in seeds]
    right.bar(seeds, chances, color=[RED if chance > 0.05 else BLUE for chance in chances])
    for n, chance in zip(seeds, chances, strict=True):
        right.text(n, chance + 0.002, f"{chance:.3f}", ha="center", fontsize=10)
    right.axhline(0.05, color=GREY, ls="--", lw=1)
    right.set(xlabel="seeds of each group", ylim=(0, 0.115), xticks=seeds)
    right.set_title("smallest chance there is")
    plain(left, right)
    save(figure, "ex14_luck")


def in_hand() -> None:
    """Post-evaluations, the best so far, and the line that would know the future."""
    steps = np.array([5, 20, 40, 60, 80, 100])
    measured = np.array([20, 45, 40, 150, 120, 190])
    best = np.maximum.accumulate(measured)
    figure, axes = new(8.8, 3.0)
    axes.plot(steps, best, "--", color=RED, lw=1.5, label="a straight line knows the future")
    axes.step([*steps, 112], [*best, best[-1]], where="post", color=BLUE, lw=2.6,
              label="the best so far: what one has in hand")  # fmt: skip
    axes.plot(steps, measured, "o", ms=8, color=ORANGE, label="a post-evaluation")
    axes.axvline(55, color=GREY, lw=1)
    axes.plot([55, 55], [45, best[2] + (best[3] - best[2]) * 0.75], "o", ms=6, color="black")
    axes.text(56, 12, "at 55 thousand steps", color="#444444")
    axes.set(xlabel="thousand steps", ylabel="return", xlim=(0, 114), ylim=(0, 215))
    axes.legend(frameon=False, loc="upper left")
    plain(axes)
    save(figure, "ex14_in_hand")
