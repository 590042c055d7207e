"""Draw candidates around centres."""

from __future__ import annotations

import numpy as np

from botschool.seeds import Numbers


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


def draw(
    numbers: Numbers, centres: np.ndarray, samplesize: int, deviation, both: bool = True
) -> tuple[np.ndarray, np.ndarray]:
    """Draw directions, shape (count, samplesize, parameters), and candidates around the centres.

    centres: (count, parameters). With `both`, the candidates are as in `mirrored`; otherwise there
    is one for each direction, centre + deviation * e. Their shape is (candidates, parameters).
    """
    samples = numbers.standard_normal((len(centres), samplesize, centres.shape[1]))
    if both:
        candidates = mirrored(centres, samples, deviation)
    else:
        candidates = centres[:, None] + deviation * samples
    return samples, candidates.reshape(-1, centres.shape[1])
