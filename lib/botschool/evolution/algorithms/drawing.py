"""Draw candidates around centres, so that another machine can draw the same again.

The algorithm draws them, and a cluster's workers draw the same again before they evaluate them
(docs/specification.md, "On a cluster").
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from botschool.seeds import Numbers, Place, generator

STRIDE = 16
"""Samples between two positions in the stream that a cloud remembers."""


def mirrored(centres: np.ndarray, samples: np.ndarray, deviation: float) -> np.ndarray:
    """Return candidates on both sides of each centre, shape (..., 2 * samplesize, parameters).

    centres: (..., parameters); samples: (..., samplesize, parameters). Candidates 2 b and 2 b + 1
    are centre + deviation * e_b and centre - deviation * e_b.
    """
    perturbations = deviation * samples
    candidates = np.empty((*samples.shape[:-2], 2 * samples.shape[-2], samples.shape[-1]))
    candidates[..., 0::2, :] = centres[..., None, :] + perturbations
    candidates[..., 1::2, :] = centres[..., None, :] - perturbations
    return candidates


@dataclass(eq=False)
class Cloud:
    """Candidates around centres, described by a few numbers from which they can be drawn again."""

    centres: np.ndarray
    """float64 (count, parameters)."""
    samplesize: int
    """Directions drawn for each centre."""
    deviation: float | np.ndarray
    """Standard deviation of the candidates: one number, or one for each axis."""
    both: bool
    """Whether there are candidates on both sides of a centre: see `mirrored`."""
    stream: Place
    """Where in a stream the directions begin, centre by centre."""
    places: list[Place] = field(default_factory=list)
    """Positions in the stream after 0, STRIDE, 2 STRIDE ... directions, as far as known."""

    def __len__(self) -> int:
        return len(self.centres) * self.samplesize * (2 if self.both else 1)

    def rows(self, numbers: np.ndarray) -> np.ndarray:
        """Return the candidates with these numbers, sorted: float64 (n, parameters)."""
        sides = 2 if self.both else 1
        first, last = int(numbers[0]) // sides, int(numbers[-1]) // sides + 1
        parts = []
        while first < last:  # centre by centre
            centre = first // self.samplesize
            end = min(last, (centre + 1) * self.samplesize)
            around: Any = mirrored if self.both else candidates_of
            parts.append(around(self.centres[centre], self._directions(first, end), self.deviation))
            first = end
        candidates = parts[0] if len(parts) == 1 else np.concatenate(parts)
        places = numbers - sides * (int(numbers[0]) // sides)
        if places[-1] - places[0] + 1 == len(places):
            return candidates[places[0] : places[-1] + 1]
        return candidates[places]

    def _directions(self, first: int, last: int) -> np.ndarray:
        """Return the directions from number `first` up to, but without, `last`."""
        size = self.centres.shape[1]
        found = np.empty((last - first, size))
        self.places = self.places or [self.stream]
        numbers = generator(0, 0)
        # follow the stream to the block of the first direction, and on to the last
        block = min(len(self.places) - 1, first // STRIDE)
        while block * STRIDE < last:
            numbers.place = self.places[block]
            begin, end = block * STRIDE, (block + 1) * STRIDE
            if first <= begin and end <= last:
                numbers.standard_normal(out=found[begin - first : end - first])
            else:
                drawn = numbers.standard_normal((STRIDE, size))
                own = drawn[max(first - begin, 0) : last - begin]
                found[max(begin - first, 0) :][: len(own)] = own
            block += 1
            if block == len(self.places):
                self.places.append(numbers.place)
        return found


class Drawn(np.ndarray):
    """Candidates with a recipe for drawing them again; slices and results have none.

    A cluster reads only `recipe` from what an algorithm evaluates.
    """

    recipe: tuple | None = None
    """The candidates' Cloud; or the start of an ascent (ascent.Start) and the fitness of each
    step.
    """

    def reshape(self, *shape, **options) -> np.ndarray:
        """Reshape as numpy does; the same candidates in the same order keep their recipe."""
        found = super().reshape(*shape, **options)
        if found.shape[-1:] == self.shape[-1:]:
            found.recipe = self.recipe
        return found


def candidates_of(centres: np.ndarray, samples: np.ndarray, deviation) -> np.ndarray:
    """Return one candidate for each direction: centre + deviation * e."""
    return centres + deviation * samples


def draw(
    numbers: Numbers, centres: np.ndarray, samplesize: int, deviation, both: bool = True
) -> tuple[np.ndarray, Drawn]:
    """Draw directions, shape (count, samplesize, parameters), and candidates around the centres.

    centres: (count, parameters). With `both`, the candidates are as in `mirrored`; otherwise there
    is one for each direction, (count, samplesize, parameters).
    """
    directions = np.empty((len(centres) * samplesize, centres.shape[1]))
    places = []
    for first in range(0, len(directions), STRIDE):
        places.append(numbers.place)
        numbers.standard_normal(out=directions[first : first + STRIDE])
    cloud = Cloud(centres, samplesize, deviation, both, places[0], places=places)
    samples = directions.reshape(len(centres), samplesize, -1)
    if both:
        candidates = mirrored(centres, samples, deviation)
    else:
        candidates = candidates_of(centres[:, None], samples, deviation)
    drawn = candidates.reshape(-1, centres.shape[1]).view(Drawn)
    drawn.recipe = (cloud,)
    return samples, drawn
