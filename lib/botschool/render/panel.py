"""Draw beside a frame: the neurons' activations, and a caption."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from botschool.problems.transition import Transition
from botschool.render.canvas import BLACK, GREY, WHITE, blank, to_frame, write_text

if TYPE_CHECKING:
    import pygame

PANEL_WIDTH = 240
PANEL_MIN_HEIGHT = 240
CAPTION_HEIGHT = 26
CAPTION_WIDTH = 300
"""Smallest width of a caption in pixels."""
POSITIVE = (213, 94, 0)
NEGATIVE = (0, 114, 178)
"""Blue and orange: colour-blind readers can distinguish them, too."""

STILL = 2.0
"""Seconds in which nothing moves before a film leaves pictures out."""
_MARGIN = 12
_LABEL = 22
_SCALE_BAR = 62
_LARGEST_CELL = 43
_CELL_WITH_NUMBER = 34


def with_activations(
    frame: np.ndarray,
    activations: np.ndarray,
    ninputs: int | Sequence[int],
    noutputs: int | Sequence[int],
    robots: Sequence[str] = ("",),
) -> np.ndarray:
    """Return the frame with a panel at its right: one coloured cell for each neuron.

    `frame` is (height, width, 3) uint8, `activations` (neurons,): inputs, hidden, outputs of each
    of the robots. White is 0, orange +1 and beyond, blue -1 and beyond; a black border marks values
    beyond. Large cells show their number. The new frame has even sides, which video formats need.
    Raises ValueError if there are fewer neurons than inputs and outputs.
    """
    activations = np.asarray(activations, dtype=np.float64).ravel()
    groups, first = {}, 0
    for label, size in neuron_groups(len(activations), ninputs, noutputs, robots):
        groups[label] = activations[first : first + size]
        first += size
    height = _even(max(len(frame), PANEL_MIN_HEIGHT))
    panel = blank(PANEL_WIDTH, height)
    panel.fill(GREY, (0, 0, 1, height))
    _draw_groups(panel, groups)
    _draw_scale(panel, height - _SCALE_BAR)
    return np.hstack([_padded(frame, height), to_frame(panel)])


def neuron_groups(
    neurons: int,
    ninputs: int | Sequence[int],
    noutputs: int | Sequence[int],
    robots: Sequence[str] = ("",),
) -> list[tuple[str, int]]:
    """Return labels and sizes of the groups in a vector of activations, without empty groups.

    ninputs and noutputs: of one robot's network if all are alike, else of each network. All
    networks have the same number of hidden neurons. Raises ValueError if there are fewer neurons
    than inputs and outputs.
    """
    inputs, outputs = (np.broadcast_to(n, len(robots)).tolist() for n in (ninputs, noutputs))
    nhiddens, rest = divmod(neurons - sum(inputs) - sum(outputs), len(robots))
    if nhiddens < 0 or rest:
        raise ValueError(
            f"{neurons} activations for {ninputs} inputs and {noutputs} outputs "
            f"of {len(robots)} robot(s)"
        )
    hidden = [nhiddens] * len(robots)
    return [
        (f"{robot} {kind}".strip(), size)
        for robot, *sizes in zip(robots, inputs, hidden, outputs, strict=True)
        for kind, size in zip(("inputs", "hidden", "outputs"), sizes, strict=True)
        if size
    ]


def with_caption(frame: np.ndarray, episode: int, transition: Transition) -> np.ndarray:
    """Return the frame with a line below: episode, step, reward and return.

    `frame` is (height, width, 3) uint8. The new frame has even sides. If a frame is too narrow for
    the caption, like Atari's, each pixel becomes a square of pixels.
    """
    larger = -(-CAPTION_WIDTH // frame.shape[1])
    frame = frame.repeat(larger, axis=0).repeat(larger, axis=1)
    frame = _padded(frame, _even(len(frame)))
    width = frame.shape[1]
    strip = blank(width, CAPTION_HEIGHT)
    size = 20 if width >= 400 else 14
    texts = caption(episode, transition)
    for column, text in zip((0.0, 0.22, 0.42, 0.68), texts, strict=True):
        write_text(strip, text, (8 + column * (width - 8), (CAPTION_HEIGHT - size) // 2 + 2), size)
    return np.vstack([frame, to_frame(strip)])


def lively(seen: Iterable[tuple[np.ndarray, int, Transition]], fps: float) -> Iterator[np.ndarray]:
    """Yield pictures with captions, without those in which nothing has moved for a while.

    seen: pictures, and the number of the episode and the transition of each. After STILL seconds
    pictures are left out until something moves.
    """
    before, episode, still = None, 0, 0
    for picture, number, step in seen:
        same = before is not None and number == episode and not _moves(before, picture)
        before, episode, still = picture.copy(), number, still + 1 if same else 0
        if still <= STILL * fps:
            yield with_caption(picture, number, step)


def _moves(before: np.ndarray, picture: np.ndarray) -> bool:
    """Return whether a pixel differs visibly, of each fourth row and column."""
    one, other = (each[::4, ::4].astype(np.int16) for each in (before, picture))
    return bool((np.abs(one - other) > 8).any())


def with_title(frame: np.ndarray, title: str) -> np.ndarray:
    """Return the frame with a line above it. Returns a new frame; its sides stay even."""
    strip = blank(frame.shape[1], CAPTION_HEIGHT)
    size = 20 if frame.shape[1] >= 400 else 14
    write_text(strip, title, (8, (CAPTION_HEIGHT - size) // 2 + 2), size)
    return np.vstack([to_frame(strip), frame])


def caption(episode: int, transition: Transition) -> tuple[str, str, str, str]:
    """Return the texts of `with_caption`."""
    returns = f"return {transition.total:.1f}"
    if transition.totals:
        returns = "returns " + " : ".join(f"{total:.1f}" for total in transition.totals)
    return (
        f"episode {episode}",
        f"step {transition.step}",
        f"reward {transition.reward:.2f}",
        returns,
    )


def _even(length: int) -> int:
    return length + length % 2


def _padded(frame: np.ndarray, height: int) -> np.ndarray:
    """Return the frame on a white background of this height and of even width."""
    padding = height - len(frame), frame.shape[1] % 2
    return np.pad(frame, [(0, padding[0]), (0, padding[1]), (0, 0)], constant_values=255)


def _draw_groups(panel: pygame.Surface, groups: dict[str, np.ndarray]) -> None:
    room = panel.get_height() - _SCALE_BAR - _MARGIN
    cell = _cell_size([len(group) for group in groups.values()], room)
    columns = _columns(cell)
    top = _MARGIN // 2
    for name, group in groups.items():
        write_text(panel, f"{name} ({len(group)})", (_MARGIN, top + 4))
        top += _LABEL
        for neuron, activation in enumerate(group):
            row, column = divmod(neuron, columns)
            _draw_cell(panel, (_MARGIN + column * cell, top + row * cell), cell, activation)
        top += -(-len(group) // columns) * cell


def _columns(cell: int) -> int:
    return (PANEL_WIDTH - 2 * _MARGIN) // cell


def _cell_size(counts: list[int], room: int) -> int:
    """Return the largest side of a cell, in pixels, that leaves room for all groups and labels."""
    for cell in range(_LARGEST_CELL, 1, -1):
        rows = sum(-(-count // _columns(cell)) for count in counts)
        if len(counts) * _LABEL + rows * cell <= room:
            return cell
    return 1


def _draw_cell(
    panel: pygame.Surface, left_top: tuple[int, int], cell: int, activation: float
) -> None:
    side = cell - 1 if cell > 3 else cell
    box = (*left_top, side, side)
    if not np.isfinite(activation):
        panel.fill(BLACK, box)
    elif abs(activation) > 1.0 and cell >= 6:
        border = 1 if cell < 12 else 2
        panel.fill(BLACK, box)
        inner = side - 2 * border
        panel.fill(
            colour_of(activation), (left_top[0] + border, left_top[1] + border, inner, inner)
        )
    else:
        if cell > 7:
            panel.fill(GREY, box)
            box = (left_top[0] + 1, left_top[1] + 1, side - 2, side - 2)
        panel.fill(colour_of(activation), box)
    if cell >= _CELL_WITH_NUMBER:
        text = f"{activation:.1f}" if abs(activation) >= 10 else f"{activation:.2f}"
        write_text(panel, text, (left_top[0] + 4, left_top[1] + cell // 2 - 6), 18)


def colour_of(activation: float) -> tuple[int, int, int]:
    """Return a colour: white for 0, towards NEGATIVE at -1 and POSITIVE at +1."""
    share = min(abs(activation), 1.0)
    end = POSITIVE if activation > 0 else NEGATIVE
    red, green, blue = (
        round(white + share * (full - white)) for white, full in zip(WHITE, end, strict=True)
    )
    return red, green, blue


def _draw_scale(panel: pygame.Surface, top: int) -> None:
    width = PANEL_WIDTH - 2 * _MARGIN
    for x in range(width):
        panel.fill(colour_of(2.0 * x / (width - 1) - 1.0), (_MARGIN + x, top + 8, 1, 10))
    write_text(panel, "-1", (_MARGIN, top + 24), 18)
    write_text(panel, "0", (PANEL_WIDTH // 2 - 4, top + 24), 18)
    write_text(panel, "+1", (PANEL_WIDTH - _MARGIN - 14, top + 24), 18)
    write_text(panel, "black frame: beyond -1 or +1", (_MARGIN, top + 42), 17)
