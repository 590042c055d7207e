"""Write replays: one self-contained page that plays episodes in any browser, without a network.

The page is replay.html with its two scripts and the episodes as JSON. With a scene, an episode
holds the scene's numbers step by step; otherwise it holds the environment's frames.
"""

from __future__ import annotations

import json
import zlib
from base64 import b64encode
from collections.abc import Iterable, Sequence
from dataclasses import asdict
from importlib.resources import files
from io import BytesIO
from itertools import repeat
from pathlib import Path
from typing import NamedTuple

import numpy as np

from botschool.errors import BotschoolError
from botschool.output import check_output, save_bytes
from botschool.problems.transition import Transition
from botschool.render.panel import neuron_groups
from botschool.render.scene import Scene
from botschool.render.shapes import PALETTE

REPLAY_SUFFIXES = (".html",)
MAX_FRAME_BYTES = 16_000_000
"""Largest total size of a page's pictures; above it, every second one goes, repeatedly."""
_FRAME_SIDE = 640
_LEVELS = 65_535


def write_replay(
    path: Path | str,
    title: str,
    about: str,
    episodes: Iterable[Iterable[Transition]],
    fps: float,
    neurons: tuple[int | Sequence[int], int | Sequence[int]],
    scene: Scene | None = None,
    labels: Iterable[str] = repeat(""),
    robots: Sequence[str] = ("",),
) -> None:
    """Write the page.

    title: the problem's name; about: a line on the robot and the experiment. fps: steps per second.
    neurons: inputs and outputs of one robot's network, or of each robot's. Without a scene the
    transitions must hold frames. labels: a distinguishing text for each episode, shown while it
    plays. robots: names of the robots if there is no scene with names. Raises BotschoolError if the
    file cannot be written or there are no steps to show.
    """
    path = check_output(path, REPLAY_SUFFIXES)
    frames = Frames()
    played = []
    count = 0
    for transitions, label in zip(episodes, labels, strict=False):
        steps = [_Step.of(transition, scene, frames, len(played)) for transition in transitions]
        if steps:
            played.append(_episode(steps) | ({"label": label} if label else {}))
            count = len(steps[0].activations)
    if not played:
        raise BotschoolError(f"{path} is not written: there were no steps to show.")
    for number, episode in enumerate(played):
        if scene is None:
            episode["frames"] = frames.of(number)
    charted = scene.charted if scene else ()
    count -= sum(len(lines) for _, lines in charted)
    groups = neuron_groups(count, *neurons, scene.robots if scene else robots) if count else []
    groups += [(label, len(lines)) for label, lines in charted]
    data = {
        "title": title,
        "about": about,
        "fps": float(fps),
        "palette": palette(),
        "scene": None if scene is None else scene_description(scene),
        "groups": [[label, size] for label, size in groups],
        "episodes": played,
    }
    save_bytes(path, _page(data).encode())


def _page(data: dict) -> str:
    folder = files("botschool.render")
    page = (folder / "replay.html").read_text(encoding="utf-8")
    # "<" never appears in the JSON, so nothing in it can end its element.
    text = json.dumps(data, separators=(",", ":")).replace("<", "\\u003c")
    page = page.replace("/*REPLAY*/", (folder / "replay.js").read_text(encoding="utf-8"))
    return page.replace("/*DRAWING*/", drawing(data["scene"])).replace("/*DATA*/", text)


def drawing(scene: dict | None) -> str:
    """Return the scripts that draw a scene, or pictures."""
    names = ["replay_draw.js", *(["replay_space.js"] if scene and "space" in scene else [])]
    return "\n".join((files("botschool.render") / name).read_text("utf-8") for name in names)


def palette() -> dict[str, list[str]]:
    """Return each colour's name and its values on a light and on a dark page, "#rrggbb"."""
    return {name: [_hex(colour) for colour in pair] for name, pair in PALETTE.items()}


def scene_description(scene: Scene) -> dict:
    """Return what replay_draw.js draws, ready for JSON: the view, shapes and close-ups."""
    drawn = {
        "view": scene.view,
        "shapes": [shape.as_dict() for shape in scene.shapes],
        "closeups": scene.closeups,
    }
    return drawn | ({"space": asdict(scene.space)} if scene.space else {})


class _Step(NamedTuple):
    total: float
    activations: np.ndarray
    """Activations of the neurons, then the values that the scene charts."""
    numbers: np.ndarray

    @classmethod
    def of(cls, transition: Transition, scene: Scene | None, frames: Frames, episode: int) -> _Step:
        """Return the stored part of a transition; without a scene its picture goes to `frames`."""
        numbers, activations = np.zeros(0), np.array(transition.activations)
        if scene is None:
            frames.add(episode, transition.step - 1, transition.frame)
        else:
            numbers = scene.numbers(
                transition.state, transition.action, transition.observation, transition.reward
            )
            lines = [numbers[i] for _, chart in scene.charted for i in chart]
            activations = np.concatenate([activations, lines])
        return cls(transition.total, activations, numbers)


def _episode(steps: list[_Step]) -> dict:
    return {
        "fitness": steps[-1].total,
        "totals": [round(step.total, 4) for step in steps],
        "activations": packed(np.array([step.activations for step in steps])),
        "numbers": packed(np.array([step.numbers for step in steps])),
    }


def packed(table: np.ndarray) -> dict:
    """Return a table, (rows, columns), as JSON: each column in 65,536 levels from its least value.

    Levels are stored as differences from the previous row, modulo 65,536: all low bytes, then all
    high bytes, column by column, compressed by zlib, in base 64. Values that are not finite become
    0.
    """
    table = np.nan_to_num(np.asarray(table, dtype=np.float64), posinf=0.0, neginf=0.0)
    low = table.min(axis=0)
    step = (table.max(axis=0) - low) / _LEVELS
    levels = np.rint((table - low) / np.where(step > 0, step, 1.0)).astype(np.uint16)
    differences = np.diff(levels, axis=0, prepend=np.zeros((1, table.shape[1]), np.uint16))
    halves = differences.T.astype("<u2").reshape(-1, 1).view(np.uint8).T
    return {
        "rows": table.shape[0],
        "low": [float(f"{value:.9g}") for value in low],
        "step": [float(f"{value:.9g}") for value in step],
        "data": b64encode(zlib.compress(halves.tobytes(), 9)).decode(),
    }


class Frames:
    """Pictures of episodes as WebP, as many as MAX_FRAME_BYTES hold."""

    def __init__(self) -> None:
        self._every = 1
        self._frames: list[tuple[int, int, bytes]] = []
        self._bytes = 0

    def add(self, episode: int, step: int, frame: np.ndarray) -> None:
        """Add the picture of a step, (height, width, 3) uint8; steps count from 0."""
        if step % self._every:
            return
        content = _webp(frame)
        if self._frames and self._frames[-1][0] == episode and self._frames[-1][2] == content:
            return
        self._frames.append((episode, step, content))
        self._bytes += len(content)
        while self._bytes > MAX_FRAME_BYTES and len(self._frames) > 1:
            self._every *= 2
            self._frames = [kept for kept in self._frames if kept[1] % self._every == 0]
            self._bytes = sum(len(content) for _, _, content in self._frames)

    def of(self, episode: int) -> dict:
        """Return the steps of an episode's pictures, and the pictures in base 64."""
        own = [(step, content) for number, step, content in self._frames if number == episode]
        return {
            "steps": [step for step, _ in own],
            "data": [b64encode(content).decode() for _, content in own],
        }


def _webp(frame: np.ndarray) -> bytes:
    from PIL import Image

    picture = Image.fromarray(frame)
    picture.thumbnail((_FRAME_SIDE, _FRAME_SIDE))
    buffer = BytesIO()
    picture.save(buffer, "WEBP", quality=80, method=2)
    return buffer.getvalue()


def _hex(colour: tuple[int, int, int]) -> str:
    return "#{:02x}{:02x}{:02x}".format(*colour)
