"""The figure of exercise 5: brains and bodies in the page walk as the command's do."""

import numpy as np

from botschool import config
from botschool.page.figures.ex05 import WALKERS
from living import ROOT, Stepped, state

EXPERIMENT = config.load(ROOT / "data/experiments/planarbodybrain.ini")


def saved(walker):
    """The numbers of a walker, in single precision as in the page."""
    values = np.load(ROOT / f"data/genotypes/{WALKERS[walker - 1]}.npy")
    return values.astype(np.float32).astype(float)


def walk(brain, body):
    """What the first post-evaluation of seed 1 pays, stepped in Python."""
    return Stepped(EXPERIMENT, saved(brain), 400, body=body).run(400).total


def body_of(walker):
    return saved(walker)[-134:-70]


def test_a_swapped_body_is_the_command_s(page):
    assert page.run("figures.body.whole") == walk(1, body_of(1))
    page.run("figures.body.press('from-2')")
    assert state(page, "body")["body"] == body_of(2).tolist()
    assert page.run("figures.body.whole") == walk(1, body_of(2))
    page.run("figures.body.press('brain-3')")
    assert page.run("figures.body.whole") == walk(3, body_of(2))
    page.run("figures.body.press('from-stick')")
    assert page.run("figures.body.whole") == walk(3, np.zeros(64))
