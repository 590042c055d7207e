"""Exercise 12: what is made, the elite, the price of surprise."""

import numpy as np
from style import BLUE, GREEN, GREY, ORANGE, above, frames, made, new, plain, result, save, write


def draw() -> None:
    film = frames(made(12, "pendulum.mp4"), np.linspace(0.336, 0.375, 7), 860, (0, 0, 1, 0.94))
    write(above(result(12, "learning.png", 860), film), "ex12_result")
    elite()
    surprise()


def elite() -> None:
    rng = np.random.default_rng(4)
    returns = np.round(rng.gamma(4, 7, 20) + 9)
    bound = np.percentile(returns, 70)
    order = np.argsort(returns)
    kept = returns[order] >= bound
    figure, axes = new(8.6, 2.9)
    axes.bar(np.arange(20), returns[order], color=np.where(kept, ORANGE, "#bbbbbb"))
    axes.axhline(bound, color=BLUE, lw=1.8)
    axes.text(0, bound + 1.5, f"bound: 70 % of the episodes are not above {bound:.0f}", color=BLUE)
    axes.text(3.5, 30, "thrown away", ha="center", color="#666666")
    axes.text(16.3, 56, "the elite", ha="right", color=ORANGE, fontsize=13)
    axes.set(xlabel="20 episodes of one iteration, by their return", ylabel="return", xticks=[])
    plain(axes)
    save(figure, "ex12_elite")


def surprise() -> None:
    figure, (left, right) = new(8.8, 3.0, 1, 2)
    p = np.linspace(0.01, 1, 300)
    left.plot(p, -np.log(p), color=BLUE, lw=2.5)
    for chance in (0.5, 0.1):
        left.plot(chance, -np.log(chance), "o", ms=8, color=ORANGE)
        left.annotate(f"probability {chance}: {-np.log(chance):.1f}", (chance, -np.log(chance)),
                      (chance + 0.05, -np.log(chance) + 0.25), color=ORANGE)  # fmt: skip
    left.set(xlabel="probability of what was done", ylabel="surprise", ylim=(0, 4.7))
    left.set_title("one of several choices")
    a = np.linspace(-3, 3, 300)
    for sigma, colour in ((0.3, ORANGE), (1.0, GREEN), (2.5, GREY)):
        value = a**2 / (2 * sigma**2) + np.log(sigma) + np.log(2 * np.pi) / 2
        right.plot(a, value, color=colour, lw=2.2, label=f"σ = {sigma}")
    right.set(xlabel="how far the action was from the mean", ylim=(-0.6, 6), title="any force")
    right.legend(frameon=False, loc="upper center")
    plain(left, right)
    save(figure, "ex12_surprise")
