"""Draw the answers of a submission over those of our solution."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from botschool.grading.declare.checks import plain
from botschool.grading.declare.picture import OVER, Picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

EXPECTED, WRONG, RIGHT = "#a3adb8", "#d55e00", "#0072b2"
FEW, CURVES, MANY = 12, 8, 200_000
"""Most numbers that are drawn as bars, most columns as curves, most numbers of an answer."""
COLUMNS = 3
SEEN = 1e-6
"""Least difference, relative to the largest number, that counts."""


@dataclass
class Panel:
    """One answer to draw."""

    title: str
    yours: np.ndarray | None
    """None if it cannot be drawn; `note` says why."""
    expected: np.ndarray | None
    """None for a right answer."""
    picture: Picture
    over: np.ndarray | None = None
    """The horizontal values of curves."""
    names: list[str] = field(default_factory=list)
    """Names of bars."""
    note: str = ""
    kind: str = field(init=False)

    def __post_init__(self) -> None:
        shape = self.yours if self.expected is None else self.expected
        kind = "bars" if self.names else self.picture.kind
        self.kind = kind if _suits(kind, shape) else chosen(shape)
        if self.yours is None or self.yours.shape == shape.shape:
            return
        loose = self.kind in ("heat", "histogram")
        if self.yours.ndim != shape.ndim or (self.yours.shape[1:] != shape.shape[1:] and not loose):
            self.note = f"yours has the shape {self.yours.shape}, expected is {shape.shape}"
            self.yours = None
        else:
            self.note = f"yours has {len(self.yours)} rows, expected are {len(shape)}"

    @property
    def apart(self) -> float:
        """Return the largest difference; 0.0 if none is to be seen, NaN if there is no number."""
        if self.expected is None:
            return 0.0
        if self.yours is None or self.yours.shape != self.expected.shape:
            return float("nan")
        if (np.isnan(self.yours) != np.isnan(self.expected)).any():
            return float("nan")
        largest = np.nanmax(np.abs(self.yours - self.expected), initial=0.0)
        scale = np.nanmax(np.abs(self.expected), initial=0.0)
        return float(largest) if largest > SEEN * scale else 0.0


def chosen(array: np.ndarray) -> str:
    """Return the kind of picture for an array of this shape."""
    if array.ndim == 1:
        return "bars" if array.size <= FEW else "curves"
    if array.ndim == 2:
        long = array.shape[1] <= CURVES and len(array) >= 3 * array.shape[1]
        return "path" if array.shape[1] == 2 else "curves" if long else "heat"
    return "shapes" if array.ndim == 3 and array.shape[2] == 2 else "heat"


def _suits(kind: str, array: np.ndarray) -> bool:
    """Return whether a kind of picture can show an array of this shape."""
    columns = {"arrows": 4, "groups": 3, "points": 2}
    if kind in columns:
        return array.ndim == 2 and array.shape[1] == columns[kind]
    if kind in ("path", "shapes"):
        return array.shape[-1] == 2 and array.ndim in ((2, 3) if kind == "path" else (3,))
    most = {"against": 1, "bars": 1, "curves": 2, "heat": 9, "histogram": 9}
    return 1 <= array.ndim <= most.get(kind, 0)


def panels_of(
    title: str, yours: Any, expected: Any, picture: Picture, right: bool, parts: tuple = ()
) -> list[Panel]:
    """Return what can be drawn of two answers; `yours` None: it could not be had.

    Of dicts and lists of arrays every part has a panel; single numbers share one with bars.
    """
    wanted, got = dict(_parts(expected, parts)), dict(_parts(yours, parts))
    over = wanted.pop(OVER, None)
    got.pop(OVER, None)
    single = [name for name, value in wanted.items() if value.ndim == 0]
    made = []
    for name, value in wanted.items():
        if value.ndim == 0 or (value.size < 2 and picture.kind != "groups") or value.size > MANY:
            continue
        mine = got.get(name)
        mine = None if mine is None or not mine.size else mine
        along = over if over is not None and len(over) == len(value) else None
        note = "" if mine is not None else "yours cannot be drawn"
        both = (mine, None) if right and mine is not None else (mine, value)
        made.append(Panel(name or title, *both, picture, along, note=note))
    if single:
        ours = np.array([wanted[name] for name in single])
        mine = np.array([got.get(name, np.array(np.nan)) for name in single], dtype=object)
        whole = np.array([each if np.ndim(each) == 0 else np.nan for each in mine], dtype=float)
        both = (whole, None) if right else (whole, ours)
        if len(single) > 1:
            made.append(Panel(title, *both, picture, names=single))
    return made


def _parts(value: Any, parts: tuple = ()) -> Iterator[tuple[str, np.ndarray]]:
    """Yield the names and arrays of an answer; "" names an answer that is one array."""
    whole = numbers(value)
    named = isinstance(value, (list, tuple)) and 0 < len(parts) == len(value)
    if whole is not None and not named:
        yield "", whole
    elif isinstance(value, dict):
        for key in value:
            one = numbers(value[key])
            if one is not None and (not parts or key in parts or key == OVER):
                yield str(key), one
    elif isinstance(value, (list, tuple)):
        for i, each in enumerate(value):
            one = numbers(each)
            if one is not None:
                yield (parts[i] if i < len(parts) else f"[{i}]"), one


def numbers(value: Any) -> np.ndarray | None:
    """Return a value as an array of finite numbers and NaN; None if it holds anything else."""
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "biuf" or array.size > MANY:
            return None
        array = array.astype(np.float64)
    except (ValueError, TypeError, OverflowError):
        return None
    return np.where(np.abs(array) < 1e30, array, np.nan)


def draw(title: str, panels: list[Panel]) -> Figure:
    """Draw the panels: what is expected grey, a wrong answer orange over it, a right one blue."""
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

    cells = [cell for panel in panels for cell in _cells(panel)]
    tables = any(len(_cells(panel)) > 1 for panel in panels)
    columns = 3 if tables else min(COLUMNS, len(cells))
    rows = -(-len(cells) // columns)
    figure = Figure(figsize=(4.3 * max(columns, 1.3), 3.6 * rows + 0.7), layout="constrained")
    grid = figure.subplots(rows, columns, squeeze=False).ravel()
    for axes, (name, paint) in zip(grid, cells, strict=False):
        paint(axes)
        axes.set_title(plain(name), fontsize=10, parse_math=False)
    for axes in grid[len(cells) :]:
        axes.axis("off")
    figure.suptitle(plain(title), parse_math=False)
    if any(panel.expected is not None for panel in panels):
        words = {"expected": EXPECTED, "yours": WRONG}
        lines = [Line2D([], [], color=colour, lw=4) for colour in words.values()]
        figure.legend(lines, [*words], loc="outside lower center", ncols=2, frameon=False)
    return figure


def _cells(panel: Panel) -> list[tuple[str, Callable[[Axes], None]]]:
    """Return the titles and drawers of a panel: three of a wrong table, else one."""
    note = panel.note or (f"differs by up to {panel.apart:.3g}" if panel.apart > 0 else "")
    title = f"{panel.title}\n{note}" if note else panel.title
    if panel.kind != "heat":
        return [(title, partial(_overlaid, panel=panel))]
    tables = {title: panel.yours}
    if panel.expected is not None:
        tables = {f"yours: {title}": panel.yours, "expected": panel.expected}
        if panel.yours is not None and panel.yours.shape == panel.expected.shape:
            tables["yours minus expected"] = panel.yours - panel.expected
    return [
        (name, partial(_table, name=name, table=table, panel=panel))
        for name, table in tables.items()
    ]


def _table(axes: Axes, name: str, table: np.ndarray | None, panel: Panel) -> None:
    shared = [each for each in (panel.yours, panel.expected) if each is not None]
    if table is None:
        axes.axis("off")
        return
    from matplotlib.ticker import MaxNLocator

    table = _flat(table, panel)
    minus = name.endswith("minus expected")
    low = min(np.nanmin(each, initial=np.inf) for each in shared)
    high = max(np.nanmax(each, initial=-np.inf) for each in shared)
    if minus:
        high = max(float(np.nanmax(np.abs(table), initial=0.0)), 1e-12)
        low = -high
    image = axes.imshow(
        np.atleast_2d(table), aspect="auto", origin="lower", interpolation="nearest",
        cmap="RdBu_r" if minus else "viridis", vmin=low, vmax=high, extent=panel.picture.extent,
    )  # fmt: skip
    axes.figure.colorbar(image, ax=axes)
    if panel.picture.extent is None:
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_locator(MaxNLocator(integer=True))
    axes.set(xlabel=panel.picture.x, ylabel=panel.picture.y)


def _flat(table: np.ndarray, panel: Panel) -> np.ndarray:
    """Return the table of a stack that differs most, or its first."""
    if table.ndim < 3 or not panel.apart > 0:
        return table if table.ndim < 3 else table[(0,) * (table.ndim - 2)]
    worst = np.nanargmax(np.abs(panel.yours - panel.expected))
    return table[np.unravel_index(worst, table.shape)[:-2]]


def _overlaid(axes: Axes, panel: Panel) -> None:
    drawer = _DRAWERS[panel.kind]
    layers = [(panel.expected, EXPECTED, True), (panel.yours, WRONG, False)]
    if panel.expected is None:
        layers = [(panel.yours, RIGHT, False)]
    for array, colour, below in layers:
        if array is not None:
            drawer(axes, array, colour, below, panel)
    axes.set(xlabel=axes.get_xlabel() or panel.picture.x, ylabel=panel.picture.y)
    axes.spines[["top", "right"]].set_visible(False)
    axes.grid(alpha=0.25)
    axes.set_axisbelow(True)
    if panel.picture.extent and panel.kind != "curves":
        left, right, bottom, top = panel.picture.extent
        axes.set(xlim=(left, right), ylim=(bottom, top))


def _curves(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    array = array if array.ndim == 2 else array[:, None]
    fits = panel.over is not None and len(panel.over) == len(array)
    along = panel.over if fits else np.arange(len(array))
    few = len(array) <= 40
    for column in array[:, :CURVES].T:
        axes.plot(
            along, column, color=colour, lw=5 if below else 1.6,
            alpha=0.55 if below else 1.0, marker="." if few and not below else "",
        )  # fmt: skip


def _bars(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    both = panel.expected is not None
    shift = (-0.2 if below else 0.2) if both else 0.0
    axes.bar(np.arange(len(array)) + shift, array, 0.4 if both else 0.7, color=colour)
    if panel.names:
        axes.set_xticks(range(len(panel.names)), panel.names, rotation=20, fontsize=8)
    else:
        axes.set_xticks(range(len(array)))
    axes.axhline(0, color="black", lw=0.6)


def _path(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    ways = array[:, None] if array.ndim == 2 else array
    for way in np.swapaxes(ways, 0, 1)[..., :2]:
        axes.plot(*way.T, color=colour, lw=5 if below else 1.5, alpha=0.55 if below else 1.0)
        axes.plot(*way[0], "o", mfc="white", mec=colour, ms=8 if below else 6)
        axes.plot(*way[-1], "o", color=colour, ms=8 if below else 5)


def _arrows(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    scale = {"angles": "xy", "scale_units": "xy", "scale": 1.0}
    axes.quiver(*array.T, color=colour, width=0.011 if below else 0.005, **scale)
    ends = np.vstack([array[:, :2], array[:, :2] + array[:, 2:]])
    axes.update_datalim(ends[np.isfinite(ends).all(axis=1)])
    axes.autoscale_view()


def _points(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    axes.scatter(
        array[:, 0], array[:, 1], color=colour, s=70 if below else 16, alpha=0.6 if below else 0.9
    )


def _groups(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    """Write each point's group: what is expected on the left, yours on the right."""
    for x, y, group in array:
        axes.annotate(
            f"{group:g}", (x, y), (-9 if below else 9, 6), textcoords="offset points",
            color=colour, ha="center", va="center", weight="bold",
        )  # fmt: skip
    axes.scatter(array[:, 0], array[:, 1], color="black", s=12)


def _histogram(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    every = [each.ravel() for each in (panel.yours, panel.expected) if each is not None]
    known = np.concatenate(every)
    bins = np.histogram_bin_edges(known[np.isfinite(known)], bins=30).tolist()
    finite = array[np.isfinite(array)]
    weights = np.full(finite.size, 1 / max(1, finite.size))
    filled = below or panel.expected is None
    form: Literal["stepfilled", "step"] = "stepfilled" if filled else "step"
    axes.hist(finite, bins, weights=weights, color=colour, histtype=form, lw=2)


def _shapes(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    for corners in array:
        look = {"alpha": 0.7, "ec": colour} if below else {"alpha": 0.35, "ec": colour, "lw": 1.5}
        axes.fill(*corners.T, fc=colour, **look)
    axes.set_aspect("equal", adjustable="datalim")


def _against(axes: Axes, array: np.ndarray, colour: str, below: bool, panel: Panel) -> None:
    if below:
        axes.plot(array, array, color=colour, lw=3)
    else:
        along = array if panel.expected is None else panel.expected
        many = min(len(along), len(array))
        axes.plot(along[:many], array[:many], "o", color=colour, ms=5)
    axes.set_xlabel("expected")


_DRAWERS: dict[str, Callable[[Axes, np.ndarray, str, bool, Panel], None]] = {
    "against": _against,
    "arrows": _arrows,
    "bars": _bars,
    "curves": _curves,
    "groups": _groups,
    "histogram": _histogram,
    "path": _path,
    "points": _points,
    "shapes": _shapes,
}
