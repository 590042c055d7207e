"""Draw the map of a MAP-Elites run, and let some of its elites play."""

from __future__ import annotations

import io
import json
from contextlib import redirect_stdout
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from botschool.analysis.figure import new_figure
from botschool.config import Experiment, from_dict
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.mapelites import features, limits
from botschool.evolution.record import RunFiles
from botschool.render.watch import PostEvaluation
from botschool.terminal import readable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

SHOWN = 3
"""The picture shows an elite from the middle of each of SHOWN x SHOWN parts of the map."""
FRAMES, START, STEP = 6, 40, 10
"""Pictures of an elite: how many, the first one's step, and the steps between them."""


class Map:
    """The map of a run: `experiment`, and of each elite its genotype, fitness and features.

    `cells`, shape (n, 2), are the row and the column of each elite. Raises BotschoolError if the
    folder holds no such run.
    """

    def __init__(self, folder: Path, seed: int) -> None:
        path = RunFiles(folder, seed).checkpoint
        if not path.exists():
            raise BotschoolError(
                f"There is no run of seed {seed} in {folder}: evolve one with 'botschool es -f "
                f"maphopper.ini -s {seed}', or name its folder and its seed (-s)."
            )
        try:
            with np.load(path, allow_pickle=False) as saved:
                sections = json.loads(str(saved["botschool"]))["experiment"]
                self.experiment: Experiment = from_dict(sections)
                if self.experiment.exp.algo != "MAP-Elites":
                    raise BotschoolError(
                        f"{path} is a run of {self.experiment.exp.algo}: only MAP-Elites has a map."
                    )
                fitness = saved["algorithm.fitness"]
                there = np.flatnonzero(fitness > -np.inf)
                self.fitness = fitness[there]
                self.genotypes = saved["algorithm.elites"][there]
                self.place = saved["algorithm.place"][there]
        except BotschoolError:
            raise
        except Exception:  # a damaged file can fail in any way
            raise BotschoolError(f"{path} is no checkpoint of botschool: it is damaged.") from None
        if not len(there):
            raise BotschoolError(f"The map of {path} is empty: let the run go on with --resume.")
        config = self.experiment.algo
        self.size = config.cells
        self.cells = np.stack(np.divmod(there, self.size), axis=1)
        self.axes = features(config.behaviour)
        self.low, self.high = limits(config.lowest), limits(config.highest)

    def chosen(self) -> list[int]:
        """Return the elite nearest to the middle of each part of the map, in reading order."""
        share = (self.cells - self.cells.min(axis=0) + 0.5) / (np.ptp(self.cells, axis=0) + 1)
        middles = (np.indices((SHOWN, SHOWN))[:, ::-1].reshape(2, -1).T + 0.5) / SHOWN
        distances = ((share[:, None] - middles) ** 2).sum(axis=2)
        return list(dict.fromkeys(distances.argmin(axis=0).tolist()))

    def words(self, index: int) -> str:
        """Return the features and the fitness of an elite."""
        values = zip(self.axes, self.place[index], strict=True)
        named = ", ".join(f"{feature.name} {readable(float(value))}" for feature, value in values)
        return f"{named}, fitness {readable(float(self.fitness[index]))}"


class Elites(PostEvaluation):
    """One episode of each of some elites: the first one that evolution evaluated."""

    occasion = "in an episode of the run with seed"

    def __init__(self, elites: Map, seed: int, chosen: list[int]) -> None:
        super().__init__(elites.experiment, seed)
        self.name = "elites of MAP-Elites"
        self.maxsteps = elites.experiment.policy.maxsteps
        self.episodes_seed = seed
        self._map, self._chosen = elites, chosen

    @property
    def available(self) -> int:
        """Return the number of elites."""
        return len(self._chosen)

    def cast(self, episode: int) -> tuple[np.ndarray, None, int]:
        """Return the elite's genotype and the number of its episode."""
        return self._map.genotypes[self._chosen[episode]], None, 0

    def label(self, episode: int) -> str:
        """Return the elite's number in the picture, its features and its fitness."""
        return f"elite {episode + 1}: {self._map.words(self._chosen[episode])}"


def plot_elites(folder: Path, seed: int, picture: Path | None, replay: Path | None) -> None:
    """Print how full the map is, and draw it: fitness by behaviour, and pictures of elites.

    picture: None opens a window, if there is a display. replay: also write a page that plays the
    elites of the picture. Raises BotschoolError.
    """
    elites = Map(folder, seed)
    print(
        f"seed {seed}: {len(elites.fitness)} of {elites.size**2} cells have an elite; fitness from "
        f"{readable(float(elites.fitness.min()))} to {readable(float(elites.fitness.max()))}, "
        f"median {readable(float(np.median(elites.fitness)))}"
    )
    chosen = elites.chosen()
    for number, index in enumerate(chosen, 1):
        print(f"{number:2}  {elites.words(index)}")
    with new_figure(picture, 0.9 + 1.0 * max(len(chosen), 5), 13) as figure:
        left, right = figure.subplots(1, 2, width_ratios=[1, 1.15])
        _draw_map(left, elites, chosen)
        _draw_strips(right, elites, seed, chosen)
        figure.suptitle(f"{elites.experiment.exp.environment}, MAP-Elites, seed {seed}")
    if replay:
        robots = Elites(elites, seed, chosen)
        robots.write_replay(replay, robots.available)
        print(f"replay: {replay} (open it in a browser)")


def _draw_map(axes: Axes, elites: Map, chosen: list[int]) -> None:
    fitness = np.full((elites.size, elites.size), np.nan)
    fitness[tuple(elites.cells.T)] = elites.fitness
    extent = (elites.low[1], elites.high[1], elites.low[0], elites.high[0])
    image = axes.imshow(fitness, origin="lower", extent=extent, aspect="auto", cmap="viridis")
    label = "fitness of each elite (grey: no elite)"
    axes.figure.colorbar(image, ax=axes, label=label, location="top", pad=0.02, aspect=30)
    axes.set(xlabel=elites.axes[1].name, ylabel=elites.axes[0].name, facecolor="#eeeeee")
    low, high = np.array(elites.low), np.array(elites.high)
    middles = low + (elites.cells[chosen] + 0.5) * (high - low) / elites.size
    for number, (y, x) in enumerate(middles, 1):
        axes.annotate(
            str(number), (x, y), ha="center", va="center", color="white", weight="bold",
            bbox={"boxstyle": "circle,pad=0.2", "color": "black", "alpha": 0.6},
        )  # fmt: skip


def _draw_strips(axes: Axes, elites: Map, seed: int, chosen: list[int]) -> None:
    """Draw a row of pictures of each elite's episode."""
    from botschool.render.canvas import draw_offscreen
    from botschool.render.scenes import scene_of

    draw_offscreen()
    robots = Elites(elites, seed, chosen)
    scene = scene_of(robots.problem)
    rows = []
    with redirect_stdout(io.StringIO()):
        for episode in range(len(chosen)):
            steps = list(islice(robots.play(episode, render=True), START + FRAMES * STEP))
            row = [
                _middle(scene.draw_transition(step) if scene else step.frame)
                for step in steps[-FRAMES * STEP :: STEP]
            ]
            rows.append(np.concatenate(row + [row[-1]] * (FRAMES - len(row)), axis=1))
    height = rows[0].shape[0]
    axes.imshow(np.concatenate(rows))
    places = [height * (number + 0.5) for number in range(len(rows))]
    labels = [f"{n}\n{readable(float(elites.fitness[k]))}" for n, k in enumerate(chosen, 1)]
    axes.set_yticks(places, labels)
    axes.tick_params(axis="y", length=0)
    axes.set_ylabel("number in the map, fitness")
    axes.set_xticks([])
    seconds = STEP / robots.problem.fps
    axes.set_title(f"{FRAMES} moments of each, {seconds:.2g} s apart", fontsize=10)
    axes.spines[:].set_visible(False)


def _middle(frame: np.ndarray) -> np.ndarray:
    """Return the square in the middle of a picture."""
    height, width = frame.shape[:2]
    left = max(width - height, 0) // 2
    return frame[:, left : left + height]
