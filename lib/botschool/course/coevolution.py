"""Give exercise 15 populations, robots, many chases at once, and pictures."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from botschool import problems
from botschool.arenas import arena as arenas
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.paths import course_root
from botschool.policies.net import Network
from botschool.policies.policy import Policy
from botschool.problems import Episodes
from botschool.problems.base import Problem

PROBLEM = "ErPredprey"
POLICY = PolicyConfig(nrobots=2, heterogeneous=1, nhiddens=25, bias=1, architecture=3)
"""The networks of data/experiments/predprey.ini."""
PRE_EVOLVED = "data/genotypes/predprey"
"""A folder inside the course."""
COLOURS = {"predators": "#d55e00", "prey": "#0072b2"}


def load_run(
    folder: str, most: int = 11, best: int = 5
) -> dict[int, tuple[np.ndarray, np.ndarray]]:
    """Return generation -> (predators, prey), each (individuals, nparameters), the best first.

    folder: a run of predprey.ini with a single seed, inside the course; if it holds fewer than two
    generations, the function loads the pre-evolved run.
    most: largest number of generations, evenly spaced over the saved ones.
    best: individuals of each population. Raises BotschoolError.
    """
    from botschool.analysis.populations import Populations, seeds_of

    own = course_root() / folder
    found = seeds_of(own) if own.is_dir() else {}
    if len(found) > 1:
        raise BotschoolError(
            f"{own} holds runs of several seeds ({', '.join(map(str, found))}): keep the run "
            "of one seed there."
        )
    if not found or len(next(iter(found.values()))) < 2:
        own = course_root() / PRE_EVOLVED
        found = seeds_of(own)
    if not found:
        raise BotschoolError(f"{own} holds no populations: evolve some, as README.md explains.")
    saved = Populations(own, next(iter(found)), _contest()[1])
    places = np.linspace(0, len(saved.generations) - 1, min(most, len(saved.generations)))
    chosen = {}
    for generation in (saved.generations[round(place)] for place in places):
        population = saved.load(generation)
        population = population.best(min(best, len(population.prey)))
        chosen[generation] = (population.predators, population.prey)
    print(f"populations: {own}, generations {', '.join(map(str, chosen))}")
    return chosen


@functools.cache
def _contest() -> tuple[Problem, Policy]:
    problem = problems.make(PROBLEM)
    return problem, Policy(PROBLEM, problem.interface, POLICY)


def robot(genotype: np.ndarray) -> Network:
    """Return the network of one predator or prey (4977 parameters) at the start of an episode."""
    network = Network(_contest()[1].spec)
    network.parameters = genotype
    network.reset()
    return network


def play(
    predators: np.ndarray, prey: np.ndarray, pairs: np.ndarray, maxsteps: int = 2000
) -> np.ndarray:
    """Return the predator's fitness in the chase of each pair, shape (chases,).

    predators, prey: shapes (p, nparameters) and (q, nparameters). pairs: integers, shape (chases,
    2): the predator's row and the prey's row. Raises BotschoolError.
    """
    problem, policy = _contest()
    predators, prey, pairs = np.asarray(predators), np.asarray(prey), np.asarray(pairs)
    for name, group in (("predators", predators), ("prey", prey)):
        if group.ndim != 2 or group.shape[1] != policy.nparameters:
            raise BotschoolError(
                f"The {name} have the shape {group.shape}: use (individuals, {policy.nparameters})."
            )
    if pairs.ndim != 2 or pairs.shape[1] != 2 or pairs.dtype.kind not in "iu":
        raise BotschoolError(
            f"The pairs have the shape {pairs.shape} and the type {pairs.dtype}: use whole "
            "numbers of the shape (chases, 2)."
        )
    if len(pairs) and (pairs.min() < 0 or (pairs.max(axis=0) >= (len(predators), len(prey))).any()):
        raise BotschoolError(
            f"A pair contains an index that does not exist: there are {len(predators)} "
            f"predators and {len(prey)} prey, counted from 0."
        )
    chases = len(pairs)
    episodes = Episodes(
        np.ascontiguousarray((pairs + np.array([0, len(predators)])).T, dtype=np.int32),
        np.zeros(chases, dtype=np.uint64),
        np.zeros(chases, dtype=np.uint32),
    )
    networks = np.concatenate([predators, prey]).astype(np.float64)
    return problem.evaluate(policy, networks, None, episodes, maxsteps).fitness


def draw_tournament(
    file: str | Path,
    matrices: dict[str, np.ndarray],
    profiles: dict[str, dict],
    generations: list[int],
) -> None:
    """Draw heat maps of both sides, and fitness against competitors of other times.

    matrices: "predators" and "prey" -> (G, G). profiles: the same names -> "ancient" (G - 1,),
    "present" (G,) and "future" (G - 1,).
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 9.5), layout="constrained")
    maps, curves = figure.subplots(2, 2, height_ratios=(1.5, 1))
    image = None
    for axes, below, (side, matrix) in zip(maps, curves, matrices.items(), strict=True):
        other = next(name for name in matrices if name != side)
        image = axes.imshow(matrix, cmap="viridis", vmin=0, vmax=1, origin="lower")
        for (row, column), value in np.ndenumerate(matrix):
            colour = "black" if value > 0.6 else "white"
            weight = "bold" if row == column else "normal"
            axes.text(column, row, f"{value:.2f}", ha="center", va="center", color=colour,
                      weight=weight, fontsize=9)  # fmt: skip
        ticks = np.arange(len(generations))
        axes.set_xticks(ticks, generations, rotation=45)
        axes.set_yticks(ticks, generations)
        axes.set(xlabel=f"generation of the {other}", ylabel=f"generation of the {side}")
        axes.set_title(f"fitness of the {side}")
        _draw_profile(below, profiles[side], generations, COLOURS[side])
        below.set(xlabel=f"generation of the {side}", ylim=(-0.03, 1.18))
        below.set_title(f"{side} against {other} of other times")
    figure.colorbar(image, ax=maps, label="mean fitness", fraction=0.03, pad=0.02)
    curves[0].set_ylabel("mean fitness")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def _draw_profile(axes, profile: dict, generations: list[int], colour: str) -> None:
    spans = {"ancient": generations[1:], "present": generations, "future": generations[:-1]}
    for (name, when), style in zip(spans.items(), ("-o", "--s", ":^"), strict=True):
        axes.plot(when, profile[name], style, color=colour, lw=2, ms=5, label=name)
    _tidy(axes)
    axes.legend(frameon=False, ncols=3, loc="upper center")


def draw_red_queen(file: str | Path, found: dict[str, dict], generations: list[int]) -> None:
    """Draw how fitness against contemporaries hides the progress of both sides.

    found: "predators" and "prey" -> "change", "own" and "others", each (G - 1,), for all
    generations except the first.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11, 4.6), layout="constrained")
    for axes, (side, parts) in zip(figure.subplots(1, 2, sharey=True), found.items(), strict=True):
        other = next(name for name in found if name != side)
        lines = (
            ("change", "what you see: fitness against contemporaries", "black", "-"),
            ("own", f"what the {side} have gained, against all {other}", COLOURS[side], "-"),
            ("others", f"what the {other} have taken, from all {side}", COLOURS[other], "--"),
        )
        for name, label, colour, style in lines:
            change = np.concatenate([[0.0], parts[name]])
            axes.plot(generations, change, style, color=colour, lw=2, label=label)
        axes.axhline(0, color="black", lw=0.6)
        axes.set(title=side, xlabel="generation")
        _tidy(axes)
        axes.legend(frameon=False, fontsize=9)
        axes.margins(y=0.3)
    figure.axes[0].set_ylabel("change of fitness since the first generation")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def draw_chases(file: str | Path, chases: dict[tuple[int, int], dict]) -> None:
    """Draw chases seen from above: a row for each generation of predators, a column for prey.

    chases: (generation of the predator, generation of the prey) -> "poses" (T + 1, 2, 3) and
    "caught". Rings mark starts; a cross marks where the prey was caught, a disc where it was not.
    """
    from matplotlib.figure import Figure

    hunters, hunted = (sorted({pair[k] for pair in chases}) for k in (0, 1))
    size = (3.5 * len(hunted) + 0.3, 3.8 * len(hunters) + 0.4)
    figure = Figure(figsize=size, layout="constrained")
    grid = figure.subplots(len(hunters), len(hunted), squeeze=False)
    for (predator, prey), chase in chases.items():
        axes = grid[hunters.index(predator), hunted.index(prey)]
        _draw_chase(axes, chase)
        end = "caught after" if chase["caught"] else "still free after"
        axes.set_title(
            f"predator of {predator}, prey of {prey}:\n{end} {len(chase['poses']) - 1} steps",
            fontsize=10,
        )
    figure.suptitle("predators orange, prey blue, darker as time goes on")
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def replay_chases(file: str | Path, pairs: dict[int, tuple[np.ndarray, np.ndarray]]) -> None:
    """Write a page that plays the chase of each pair: generation -> (predator, prey)."""
    from botschool.render.canvas import draw_offscreen
    from botschool.render.replay import write_replay
    from botschool.render.scenes import scene_of

    draw_offscreen()
    problem, policy = _contest()
    write_replay(
        file,
        problem.name,
        "the best predator and the best prey of a generation",
        (problem.play(policy, np.stack(pair), None, 0, 0, 2000) for pair in pairs.values()),
        problem.fps,
        (policy.spec.inputs, policy.spec.outputs * policy.spec.nbins),
        scene_of(problem),
        [f"generation {generation}" for generation in pairs],
    )
    print(f"replay: {file}")


def _draw_chase(axes, chase: dict) -> None:
    from matplotlib.collections import LineCollection
    from matplotlib.colors import LinearSegmentedColormap
    from matplotlib.patches import Circle, Rectangle

    arena = arenas.make("predprey")
    axes.add_patch(
        Rectangle((0, 0), arena.width, arena.height, facecolor="#f7f7f5", edgecolor="#555555", lw=2)
    )
    poses = chase["poses"][..., :2]
    if chase["caught"]:
        poses = _touching(poses, sum(model.radius for model in arena.models))
    names = ("#fbd9bf", COLOURS["predators"], "#5e2900"), ("#c5e1f2", COLOURS["prey"], "#00304d")
    for k, colours in enumerate(names):
        way = poses[:, k]
        pieces = list(np.stack([way[:-1], way[1:]], axis=1))
        fade = LinearSegmentedColormap.from_list(colours[1], colours)
        lines = LineCollection(pieces, cmap=fade, linewidths=1.3, capstyle="round", zorder=2 + k)
        lines.set_array(np.arange(len(pieces)))
        axes.add_collection(lines)
        axes.plot(*way[0], "o", ms=7, mfc="white", mec=colours[1], mew=2, zorder=5)
        axes.add_patch(Circle(way[-1], arena.models[k].radius, color=colours[1], zorder=6))
    if chase["caught"]:
        axes.plot(*poses[-1].mean(axis=0), "X", ms=10, color="black", zorder=7)
    axes.set(xlim=(-40, arena.width + 40), ylim=(-40, arena.height + 40), aspect="equal")
    axes.axis("off")


def _touching(places: np.ndarray, apart: float) -> np.ndarray:
    """Return places in mm, (T + 1, 2, 2), with the predator moved up to the caught prey."""
    from botschool.render.scenes.arenas import touching

    led = places.copy()
    predator, prey = places[-1]
    led[-1, 0] = touching(predator, prey, apart)
    return led


def _tidy(axes) -> None:
    axes.grid(alpha=0.3)
    axes.set_axisbelow(True)
    axes.spines[["top", "right"]].set_visible(False)
