"""Make figures: for a file, a window or a notebook."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from botschool.errors import BotschoolError
from botschool.output import cannot_write, check_output, written_whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PICTURE_SUFFIXES = (".png", ".svg", ".pdf", ".jpg")
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
"""Okabe and Ito's palette: colour-blind readers can distinguish its colours, too."""


class NoDisplay(BotschoolError):
    """Raised if there is no screen to draw on."""


def cycle() -> Iterator[str]:
    while True:
        yield from COLOURS


def _layout(height: float, width: float) -> dict[str, Any]:
    from matplotlib.layout_engine import ConstrainedLayoutEngine

    engine = ConstrainedLayoutEngine(w_pad=0.12, h_pad=0.12)
    return {"figsize": (width, height), "dpi": 100, "layout": engine}


def check_picture(output: Path | str | None) -> None:
    """Check a picture's name before the work for it begins. Raises BotschoolError."""
    if output is not None:
        check_output(output, PICTURE_SUFFIXES)


def tidy(axes: Any, grid: Any = "both", sides: Sequence[str] = ("top", "right")) -> None:
    """Draw a light grid below the data, and no frame on these sides."""
    axes.grid(axis=grid, color="#DDDDDD", lw=0.6)
    axes.set_axisbelow(True)
    axes.spines[list(sides)].set_visible(False)


def tidy_rows(axes: Any, labels: Sequence[str], above: float, below: float) -> None:
    """Finish a picture with a row for each label, from the top to the bottom."""
    axes.set_yticks(range(len(labels)), labels)
    axes.set_ylim(len(labels) - 1 + below, -above)
    axes.ticklabel_format(axis="x", useOffset=False)
    tidy(axes, "x", ("top", "right", "left"))
    axes.tick_params(axis="y", length=0)


@contextmanager
def new_figure(
    output: Path | str | None, height: float = 5.0, width: float = 8.0, shown: bool = True
) -> Iterator[Figure]:
    """Yield a figure of `width` by `height` inches; when the block ends, write it to `output`, or
    show it if there is none (not with shown=False).
    """
    if output is None and shown:
        with _shown_figure(height, width) as figure:
            yield figure
        return
    from matplotlib.figure import Figure

    class Picture(Figure):
        def _repr_png_(self) -> bytes:  # notebooks show it
            self.savefig(content := BytesIO(), format="png")
            return content.getvalue()

    if output is not None:
        output = check_output(output, PICTURE_SUFFIXES)
    figure = Picture(**_layout(height, width))
    yield figure
    if output is None:
        return
    with written_whole(output) as temporary:
        try:
            figure.savefig(temporary, format=output.suffix[1:].lower())
        except OSError as error:
            raise cannot_write(output, error.strerror or str(error)) from error


@contextmanager
def _shown_figure(height: float, width: float) -> Iterator[Figure]:
    import matplotlib
    from matplotlib import pyplot

    headless = NoDisplay(
        "there is no display to show the picture on: write it to a file with `-o FILE.png`."
    )
    try:
        figure = pyplot.figure(**_layout(height, width))
    except Exception as error:  # each window toolkit raises its own kind
        raise headless from error
    try:
        if matplotlib.get_backend().lower() in ("agg", "cairo", "pdf", "pgf", "ps", "svg"):
            raise headless
        yield figure
        pyplot.show()
    finally:
        pyplot.close(figure)
