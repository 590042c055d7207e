"""Draw a native problem that has no picture of its own: observation and action as meters."""

from __future__ import annotations

import numpy as np

from botschool.render.scene import Scene
from botschool.render.shapes import rectangle


class MeterScene(Scene):
    """A row of meters for the observation and one for the action; a disc shows each value.

    The middle is 0. Values are squashed by x / (1 + |x|), so a meter can show any size.
    """

    view = (-0.06, -0.1, 1.56, 1.12)
    scale = 400.0

    def __init__(self, info: dict) -> None:
        """Make the meters; info: as in `_core.native_problems()`."""
        super().__init__()
        self.state_size, self.fps = info["states"], 1 / info["seconds"]
        self._seen = info["robots"] * info["observations"]
        self._acted = info["robots"] * (1 if info["discrete"] else info["outputs"])
        self._row("observation", 0.62, 1.02, self._seen, "blue")
        self._row("action", 0.0, 0.4, self._acted, "orange")

    def _row(self, name: str, bottom: float, top: float, count: int, colour: str) -> None:
        step = 1.5 / count
        middle, half = (bottom + top) / 2, (top - bottom) / 2
        radius = min(0.02, 0.4 * step)
        self.add("text", [(0.75, top + 0.06)], "muted", text=name)
        self.add("line", [(0.0, middle), (1.5, middle)], "muted", radius=0.001)
        for i in range(count):
            x = (i + 0.5) * step
            track = rectangle(x - 0.3 * step, bottom, x + 0.3 * step, top)
            self.add("polygon", track, "muted", opacity=0.15)
            self.add("disc", [(x, 0.0)], colour, radius=radius, pose=self.pose())
        self._rows = [*getattr(self, "_rows", []), (middle, half - radius)]

    def _numbers(self, state, action, observation, reward) -> list[float]:
        seen = np.zeros(self._seen) if observation is None else observation
        acted = action if len(action) else np.zeros(self._acted)
        numbers = []
        for (middle, half), values in zip(self._rows, (seen, acted), strict=True):
            for value in np.asarray(values) / (1 + np.abs(values)):
                numbers += [0.0, middle + half * float(value), 0.0]
        return numbers
