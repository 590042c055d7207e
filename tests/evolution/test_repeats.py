"""Fitness is pure, or it is said: environments that draw, keep or count on their own; and rules
that environments break (docs/specification.md, "Fitness is a pure function").
"""

import random
import re

import numpy as np
import pytest

from botschool import problems
from botschool.config import load
from botschool.policies.hyperparameters import PolicyConfig
from botschool.problems import Episodes
from botschool.problems.base import say
from running import call, experiment, run_seeds, same, write_experiment

NOTE = "does not repeat"


@pytest.fixture(autouse=True)
def nothing_was_said():
    say.cache_clear()


@pytest.mark.slow
@pytest.mark.parametrize(
    "name",
    [
        pytest.param("BipedalWalker-v3", marks=pytest.mark.long),
        pytest.param("BipedalWalkerHardcore-v3", marks=pytest.mark.long),
        *("odd_envs:DrawsGlobally-v0", "odd_envs:SeedsOnce-v0", "odd_envs:GetsHarder-v0"),
    ],
)
def test_they_repeat(name, tmp_path, command, capfd):
    own = experiment(tmp_path, name, maxmsteps=0.0008)
    assert run_seeds(own, tmp_path / "one")
    assert run_seeds(own, tmp_path / "two", workers=2)
    assert run_seeds(own, tmp_path / "parts", steps=300)
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert same(tmp_path / "one", tmp_path / "two") and same(tmp_path / "one", tmp_path / "parts")
    robot = ("-p", "-g", tmp_path / "one" / "bestgS1.npy", "--render", "none")
    assert NOTE not in capfd.readouterr().err
    code, out, errors = command("es", "-f", tmp_path / "own.ini", *robot)
    assert code == 0 and NOTE not in errors
    shown = [float(fitness) for fitness in re.findall(r"fitness (\S+)", out)]
    recorded = float((tmp_path / "one" / "S1.fit").read_text().split()[-1])
    assert np.mean(shown) == pytest.approx(recorded, rel=1e-2)


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize("name", ["CountsForAll", "DrawsOnItsOwn"])
def test_or_it_is_said_once(name, workers, tmp_path, capfd):
    own = experiment(tmp_path, f"odd_envs:{name}-v0", maxmsteps=0.0005)
    assert run_seeds(own, tmp_path / "run", seeds=(1, 2), workers=workers)
    errors = capfd.readouterr().err
    assert errors.count(f"odd_envs:{name}-v0 {NOTE}") == 1 and "self.np_random" in errors


@pytest.mark.slow
def test_what_is_kept_in_a_process_changes_each_run_alike(tmp_path, capfd):
    own = experiment(tmp_path, "odd_envs:CountsForAll-v0", maxmsteps=0.0008)
    for folder in ("one", "other"):
        say.cache_clear()
        assert run_seeds(own, tmp_path / folder, workers=2)
        assert capfd.readouterr().err.count(NOTE) == 1
    assert same(tmp_path / "one", tmp_path / "other")


def test_a_world_of_box2d_is_new_in_each_episode():
    """Its environment shows what it keeps after more episodes than a first look has."""
    pytest.importorskip("Box2D")
    problem = problems.make("odd_envs:KeepsAWorld-v0")
    policy = problem.policy(PolicyConfig(nhiddens=0))
    episodes = Episodes.of([1], 60)
    episodes.episode[:] = 0
    returns = problem.evaluate(policy, policy.initial(1)[None], None, episodes, 10).fitness
    assert len(set(returns.tolist())) == 1


@pytest.mark.slow
def test_what_differs_between_processes_is_said(tmp_path, capfd):
    own = experiment(tmp_path, "odd_envs:HashesTexts-v0", maxmsteps=0.0005)
    assert run_seeds(own, tmp_path / "two", workers=2)
    assert capfd.readouterr().err.count(NOTE) == 1
    words = ("es", "-f", tmp_path / "own.ini", "-s", 1, "-o", tmp_path / "parts")
    assert call(*words, "--generations", 1)[0] == 0
    say.cache_clear()
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert capfd.readouterr().err.count(NOTE) == 1


def test_nobody_else_s_draws_change():
    problem = problems.make("odd_envs:DrawsGlobally-v0")
    policy = problem.policy(PolicyConfig(nhiddens=0))
    drawn = []
    for plays in (False, True):
        random.seed(1)
        np.random.seed(1)  # noqa: NPY002
        if plays:
            rows = policy.initial(1)[None]
            problem.evaluate(policy, rows, None, Episodes.of([1], 3), 10)
            list(problem.play(policy, rows[0], None, 1, 0, 10))
        drawn.append((random.random(), np.random.random()))  # noqa: NPY002
    assert drawn[0] == drawn[1]


@pytest.mark.parametrize("around", ["", "wrappers = FlattenObservation"])
@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("Alone", ["reset", "(observation, info)"]),
        ("Pair", ["reset", ""]),
        ("Seedless", ["reset", "def reset(self, seed=None, options=None)"]),
        ("Optionless", ["reset", "def reset(self, seed=None, options=None)"]),
        ("Four", ["step 1", "(observation, reward, terminated, truncated, info)"]),
        ("Ends", ["step 1", "mend the environment"]),
        ("Quits", ["cannot be made: no licence"]),
    ],
)
def test_a_broken_rule_gets_a_sentence(name, says, around, refused, tmp_path):
    path = write_experiment(tmp_path, f"odd_envs:{name}-v0")
    path.write_text(path.read_text().replace("algo =", f"{around}\nalgo ="))
    says = [f"odd_envs:{name}-v0", *(says if "" not in says else [])]
    errors = refused("es", "-f", path, "-o", tmp_path / "run", says=says)
    assert name != "Outside" or "stepsize" not in errors  # no action had been given


@pytest.mark.parametrize("algo", ["OpenAI-ES", "SSS", "CMA-ES"])
@pytest.mark.parametrize("reward", ["3e307", "-1e101", "1e99"])
def test_rewards_whose_sums_overflow(algo, reward, command, tmp_path):
    path = write_experiment(tmp_path, "odd_envs:Pays-v0", algo, maxmsteps=0.0005)
    path.write_text(path.read_text().replace("algo =", f"options = reward={reward}\nalgo ="))
    code, _, errors = command("es", "-f", path, "-o", tmp_path / "run")
    assert code == (0 if reward == "1e99" else 2) and "Traceback" not in errors
    assert code == 0 or "above 1e+100: scale rewards down" in errors


@pytest.mark.slow
def test_an_environment_that_must_draw_is_filmed(tmp_path, command, refused):
    pytest.importorskip("pygame")
    path = write_experiment(tmp_path, "MountainCar-v0", maxmsteps=0.0002)
    around = "wrappers = AddRenderObservation(render_only=True), ResizeObservation(shape=(8, 12))"
    plain = path.read_text()
    path.write_text(plain.replace("algo =", f"{around}\nalgo ="))
    refused("es", "-f", path, "-o", tmp_path / "run", says=["options = render_mode='rgb_array'"])
    path.write_text(plain.replace("algo =", f"options = render_mode='rgb_array'\n{around}\nalgo ="))
    assert run_seeds(load(path), tmp_path / "run")
    film = ("-p", "--episodes", 1, "--video", tmp_path / "film.gif")
    code, _, errors = command("es", "-f", path, *film, "-g", tmp_path / "run" / "bestgS1.npy")
    assert code == 0, errors
