"""The figures of exercise 8 step as OpenAI-ES of the command does, bit by bit."""

from functools import partial

import numpy as np
import pytest

from botschool.evolution.algorithms.openaies import OpenAIES, OpenAIESConfig
from living import slide, state

TOP = np.array([1.5, 1.2])


def hill(candidates):
    """What candidates are worth on the hill and on the plateau."""
    return np.exp(-((candidates - TOP) ** 2).sum(axis=1) / 7)


def plateau(candidates):
    """The same on the plateau."""
    return np.maximum(0.1, 1 - ((candidates - TOP) ** 2).sum(axis=1) / 4)


def followed(landscape, start, generations, lucky=False, **settings):
    """The centres of a run of the command's algorithm with the page's chance."""
    config = OpenAIESConfig(**{"samplesize": 10, "noiseStdDev": 0.5, "stepsize": 0.15} | settings)
    algorithm = OpenAIES(config, lambda index: np.array(start), 1)
    centres = [algorithm.centre]
    for _ in range(generations):
        fitness = landscape(algorithm.ask()[0])
        fitness[0] += 100 * lucky
        algorithm.tell(fitness)
        centres.append(algorithm.centre)
    return np.array(centres).tolist()


@pytest.mark.parametrize("ground", [hill, plateau])
def test_the_centre_climbs_as_with_the_command(page, ground):
    run = partial(followed, ground, [-1.7, -1.2])
    page.run(f"figures.cloud.press('ground-{ground.__name__}')")
    page.run("figures.cloud.advance(6)")
    assert state(page, "cloud")["trail"] == run(6)
    page.run("figures.cloud.reset()")
    page.run(f"figures.cloud.press('ground-{ground.__name__}')")
    for key, value in (("samplesize", 1), ("noise", 1.5), ("stepsize", 0.8)):
        slide(page, "cloud", key, value)
    page.run("figures.cloud.press('lucky')")
    page.run("figures.cloud.press('once'), figures.cloud.press('once')")
    s = state(page, "cloud")
    assert s["trail"] == run(2, True, samplesize=1, noiseStdDev=1.5, stepsize=0.8)
