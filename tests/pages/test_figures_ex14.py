"""The figure of exercise 14 races the command's evolution against the command's PPO."""

import numpy as np
import pytest

from botschool import config
from botschool.evolution.run import Run
from botschool.page import training
from botschool.paths import material
from botschool.rl.native import training as native
from living import ROOT, state

RACES = {
    "cartpole": ("CartPole-v1", "cartpole_openaies.ini"),
    "pendulum": ("Pendulum-v1", "pendulum.ini"),
    "acrobot": ("Acrobot-v1", "acrobot.ini"),
}


@pytest.fixture(scope="module")
def curve_of():
    pytest.importorskip("tensorboard")
    names = {"__name__": "solution"}
    exec((ROOT / "solutions/ex14_training_ppo/training_ppo.py").read_text(), names)
    return names["curve_of"]


def raced(page, rounds):
    """Let a race go on, and return its state."""
    for _ in range(rounds):
        page.run("figures.race.advance(10)")
    return state(page, "race")


@pytest.mark.parametrize(
    ("problem", "rounds"), [("cartpole", 12), ("pendulum", 5), ("acrobot", 16)]
)
def test_both_sides_are_the_command_s(page, curve_of, problem, rounds, tmp_path):
    env, ini = RACES[problem]
    for button in (f"problem-{problem}", "other"):
        page.run(f"figures.race.buttons['{button}'].element.click()")
    s = raced(page, rounds)
    assert s["seed"] == 2 and len(s["es"]) >= 3 and len(s["ppo"]) >= 2

    experiment = config.load(material() / "data/experiments" / ini)
    experiment.policy.pepisodes = 20
    run = Run(experiment, 2)
    for _ in s["es"]:
        run.advance()
    assert s["es"] == run.record.rows()[:, [0, 2]].tolist()
    assert page.run("[...figures.race.runs.es.bestg]") == run.record.bestg.tolist()

    settings = training.settings_of(env, 2)
    made, _ = native.learn(settings, tmp_path / "run", lambda steps, found: None)
    curve = curve_of(made.path)
    found = np.array(s["ppo"])
    assert found[:, 1].tolist() == curve["best"][: len(found)].tolist()
    # of Acrobot's episodes that end early, the last step costs nothing
    close = {"rtol": 0, "atol": 20 * len(found) if problem == "acrobot" else 1e-6}
    np.testing.assert_allclose(found[:, 0], curve["steps"][: len(found)], **close)
