"""How candidates are drawn around centres, in one place: where they are asked for, and again where
they are evaluated, on another machine (docs/specification.md, "On a cluster")."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.random import Generator, Philox

STRIDE = 64
"""Samples between two places in the stream that a cloud remembers."""


def mirrored(centres: np.ndarray, samples: np.ndarray, deviation: float) -> np.ndarray:
    """Candidates on both sides of each centre, shape (..., 2 * samplesize, parameters).

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
    """Candidates around centres, as few numbers: enough to draw any of them again."""

    centres: np.ndarray
    """float64 (count, parameters)."""
    samplesize: int
    """Directions drawn for each centre."""
    deviation: float | np.ndarray
    """Of the candidates, or along each axis."""
    both: bool
    """Whether there are candidates on both sides of a centre: see `mirrored`."""
    stream: dict
    """State of the Philox generator that gives the directions, centre by centre."""
    origin: tuple | None = None
    """Of an ascent (ascent.py): its start, and the fitness of each step so far."""
    _places: list[dict] = field(default_factory=list)
    """The stream after 0, STRIDE, 2 STRIDE ... directions, as far as it has been followed."""

    def __len__(self) -> int:
        return len(self.centres) * self.samplesize * (2 if self.both else 1)

    def rows(self, numbers: np.ndarray) -> np.ndarray:
        """The candidates with these numbers, sorted: float64 (n, parameters)."""
        directions = numbers // 2 if self.both else numbers
        needed, where = np.unique(directions, return_inverse=True)
        samples = self._directions(needed)
        centres = self.centres[needed // self.samplesize]
        if not self.both:
            return candidates_of(centres, samples, self.deviation)[where]
        pairs = mirrored(centres, samples[:, None], self.deviation)
        return pairs[where, numbers % 2]

    def _directions(self, needed: np.ndarray) -> np.ndarray:
        """Directions with these numbers, sorted and each once."""
        found = np.empty((len(needed), self.centres.shape[1]))
        self._places = self._places or [self.stream]
        numbers = Generator(Philox(0))
        edges = np.arange(needed[0] // STRIDE, needed[-1] // STRIDE + 1)
        # follow the stream to the first block, then draw the blocks with directions in them
        for block in range(min(len(self._places) - 1, edges[0]), edges[-1] + 1):
            numbers.bit_generator.state = self._places[block]
            drawn = numbers.standard_normal((STRIDE, self.centres.shape[1]))
            if block + 1 == len(self._places):
                self._places.append(numbers.bit_generator.state)
            first, last = np.searchsorted(needed, (block * STRIDE, (block + 1) * STRIDE))
            found[first:last] = drawn[needed[first:last] - block * STRIDE]
        return found


class Drawn(np.ndarray):
    """Candidates that can be drawn again; parts of them, or what is computed from them, cannot."""

    cloud: Cloud | None = None


def candidates_of(centres: np.ndarray, samples: np.ndarray, deviation) -> np.ndarray:
    """One candidate a direction: centre + deviation * e."""
    return centres + deviation * samples


def draw(
    numbers: Generator, centres: np.ndarray, samplesize: int, deviation, both: bool = True
) -> tuple[np.ndarray, Drawn]:
    """Directions, shape (count, samplesize, parameters), and candidates around the centres.

    centres: (count, parameters). Candidates: with `both` as `mirrored` gives them, else one for
    each direction, (count, samplesize, parameters).
    """
    cloud = Cloud(centres, samplesize, deviation, both, numbers.bit_generator.state)
    samples = numbers.standard_normal((len(centres), samplesize, centres.shape[1]))
    if both:
        candidates = mirrored(centres, samples, deviation)
    else:
        candidates = candidates_of(centres[:, None], samples, deviation)
    return samples, remembering(candidates.reshape(-1, centres.shape[1]), cloud)


def remembering(candidates: np.ndarray, cloud: Cloud | None) -> Drawn:
    """The same candidates, which remember the cloud that they are from."""
    drawn = candidates.view(Drawn)
    drawn.cloud = cloud
    return drawn
