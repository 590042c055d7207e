"""The figures of exercise 8 step as OpenAI-ES of the command does, bit by bit."""

from functools import partial

import numpy as np
import pytest

from botschool.evolution.algorithms.openaies import OpenAIES, OpenAIESConfig
from living import ROOT, drag, grip_of, slide, state

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


def test_the_centre_is_dragged(page):
    x, y = grip_of(page, "cloud", "centre")
    scale = page.run("parts(figures.cloud).map.box[2]") / 6
    page.run("figures.cloud.advance(3), figures.cloud.reset()")
    drag(page, "cloud", (x, y), (x + 90, y - 30))
    s = state(page, "cloud")
    np.testing.assert_allclose(s["x"], [-1.7 + 90 / scale, -1.2 + 30 / scale], atol=1e-6)
    page.run("figures.cloud.advance(5)")
    assert state(page, "cloud")["trail"] == followed(hill, s["x"], 5)


def test_bars_become_steps_of_adam(page):
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex08_openai_es/openai_es.py").read_text(), names)
    page.run("figures.stride.press('kind-sudden')")
    slide(page, "stride", "before", 3000)
    x, y = grip_of(page, "stride", "d20")
    up = page.run("rows(figures.stride).bars.box[3]") / 2
    drag(page, "stride", (x, y), (x, y + up))
    s = state(page, "stride")
    np.testing.assert_allclose(s["d"], 15 * [0] + 4 * [0.8] + [-0.2] + 20 * [0.8], atol=1e-6)
    centre = m = v = np.zeros(1)
    for i, d in enumerate(s["d"]):
        after, m, v = names["adam"](centre, np.array([d]), m, v, 3001 + i, 1.0)
        assert s["steps"][i] == pytest.approx((after - centre)[0], rel=1e-4)
        centre = after
    assert max(map(abs, s["steps"])) > 3.2
