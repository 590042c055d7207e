"""Exercise 11: what is made, the way there and back, saturation, momentum."""

import numpy as np
from style import BLUE, GREEN, GREY, ORANGE, arrow, box, new, plain, result, save, sketch, write


def draw() -> None:
    write(result(11, "features.png", 920), "ex11_result")
    chain()
    saturation()


def chain() -> None:
    figure, axes = new(9.4, 2.9)
    sketch(axes, 11, 3.4)
    names = ("$X$", "sums", "$H$", "$Y$", "$L$")
    under = ("patterns", "of the inputs", "hidden\nactivations", "outputs", "loss")
    for k, (name, text) in enumerate(zip(names, under, strict=True)):
        x = 0.2 + 2.2 * k
        box(axes, x, 1.45, 1.1, 0.7, name, "#fde8d8" if k == 4 else "#e8eef4", 14)
        axes.text(x + 0.55, 1.35, text, ha="center", va="top", fontsize=9, color="#555555")
        if k < 4:
            arrow(axes, (x + 1.15, 2.0), (x + 2.15, 2.0), BLUE, 2)
            arrow(axes, (x + 2.15, 1.62), (x + 1.15, 1.62), ORANGE, 2)
    for k, text in enumerate(("$W_1, b_1$", r"$\sigma$", "$W_2, b_2$", "targets")):
        axes.text(1.85 + 2.2 * k, 2.2, text, ha="center", fontsize=12, color=BLUE)
    axes.text(5.5, 3.0, "forwards: what does the network answer, and how wrong is it?", ha="center",
              color=BLUE)  # fmt: skip
    axes.text(5.5, 0.25, "backwards: how does the loss change with each of these?", ha="center",
              color=ORANGE)  # fmt: skip
    axes.text(8.45, 0.72, "$D_2$ arises here", ha="center", fontsize=10, color=ORANGE)
    axes.text(4.05, 0.72, "$D_1$ arises here", ha="center", fontsize=10, color=ORANGE)
    save(figure, "ex11_chain")


def saturation() -> None:
    z = np.linspace(-8, 8, 400)
    h = 1 / (1 + np.exp(-z))
    figure, axes = new(8, 2.9)
    axes.axvspan(-8, -4, color=GREY, alpha=0.15, lw=0)
    axes.axvspan(4, 8, color=GREY, alpha=0.15, lw=0)
    axes.plot(z, h, color=BLUE, lw=2.5, label="activation")
    axes.plot(z, np.gradient(h, z), color=ORANGE, lw=2.5, label="slope: what gets back through")
    axes.text(-6, 0.45, "saturated:\nalways off", ha="center", color="#555555")
    axes.text(6, 0.45, "saturated:\nalways on", ha="center", color="#555555")
    axes.text(0.35, 0.3, "here it learns", color=GREEN)
    axes.set(xlabel="what the neuron receives", xlim=(-8, 8), ylim=(-0.03, 1.25))
    axes.legend(frameon=False, loc="upper left", ncols=2)
    plain(axes)
    save(figure, "ex11_saturation")
