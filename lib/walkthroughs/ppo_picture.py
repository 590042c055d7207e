"""Draw a training of PPO."""

from __future__ import annotations

from collections import deque
from pathlib import Path

import numpy as np

PANELS = {
    "train/approx_kl": "KL divergence (new policy from old)",
    "train/clip_fraction": "clip fraction",
    "train/entropy_loss": "entropy (curiosity left)",
    "train/explained_variance": "explained variance (of the critic)",
}


def draw(
    episodes: list[tuple[int, float, int]],
    indicators: list[dict[str, float]],
    title: str,
    file: Path,
) -> None:
    """Draw the learning curve, and four indicators beneath it.

    episodes: (steps so far, return, length) of each; indicators: of each update, including "steps".
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 8), layout="constrained")
    grid = figure.add_gridspec(3, 2, height_ratios=(1.6, 1, 1))
    top = figure.add_subplot(grid[0, :])
    if episodes:
        steps, returns, _ = np.array(episodes).T
        top.plot(steps, returns, ".", color="#56b4e9", markersize=3, alpha=0.5, label="an episode")
        recent: deque[float] = deque(maxlen=20)
        means = [(recent.append(each), np.mean(recent))[1] for each in returns]
        top.plot(steps, means, color="#0072b2", linewidth=2, label="mean of the last 20")
        top.legend(frameon=False, loc="lower right")
    top.set(title=title, ylabel="return", xlabel="steps")
    steps = [each["steps"] for each in indicators]
    for i, (name, words) in enumerate(PANELS.items()):
        axes = figure.add_subplot(grid[1 + i // 2, i % 2])
        values = np.array([each[name] for each in indicators])
        axes.plot(steps, -values if name == "train/entropy_loss" else values, color="#0072b2", lw=1)
        axes.set_title(words, fontsize=10)
        if name == "train/explained_variance":
            axes.set_ylim(max(-1.0, values.min()) - 0.05, 1.05)
    for axes in figure.axes:
        axes.grid(alpha=0.3)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")
