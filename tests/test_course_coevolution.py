"""What exercise 15 is given ready-made."""

import re

import numpy as np
import pytest

from botschool import arena as arenas
from botschool.course.coevolution import (
    _touching,
    draw_chases,
    draw_red_queen,
    draw_tournament,
    load_run,
    play,
    robot,
)
from botschool.errors import BotschoolError

PARAMETERS = 4977


def robots(count, seed=1):
    """They drive fast and nearly straight on, so that some meet."""
    genotypes = 0.05 * np.random.default_rng(seed).normal(size=(count, PARAMETERS))
    genotypes[:, 25:27] += 0.8
    return genotypes


def stepped(predator, prey, maxsteps):
    arena = arenas.make("predprey", max_steps=maxsteps)
    networks, fitness = (robot(predator), robot(prey)), 0.0
    while not arena.done:
        seen = np.split(arena.observation.copy(), 2)
        for network, observation in zip(networks, seen, strict=True):
            network.observation = observation
        arena.action = np.concatenate([network.step() for network in networks])
        fitness += arena.step()
    return fitness


def test_play_is_what_stepping_gives():
    predators, prey = robots(3), robots(2, seed=2)
    pairs = np.array([(2, 1), (0, 0), (1, 0), (2, 1)])
    fitness = play(predators, prey, pairs, 60)
    expected = [stepped(predators[i], prey[j], 60) for i, j in pairs]
    np.testing.assert_allclose(fitness, expected, atol=1e-9)
    assert np.count_nonzero(fitness) > 0


@pytest.mark.parametrize(
    ("predators", "pairs", "said"),
    [
        (robots(2)[0], [(0, 0)], "The predators have the shape (4977,)"),
        (robots(2)[:, 1:], [(0, 0)], "but (individuals, 4977)"),
        (robots(2), [(0.0, 0.0)], "whole numbers"),
        (robots(2), [0, 1], "shape (chases, 2)"),
        (robots(2), [(2, 0)], "there are 2 predators and 3 prey"),
        (robots(2), [(0, -1)], "somebody who is not there"),
    ],
)
def test_play_says_what_is_wrong(predators, pairs, said):
    with pytest.raises(BotschoolError, match=re.escape(said)):
        play(predators, robots(3), np.array(pairs))


def save(folder, seed, generations, individuals=3):
    folder.mkdir(parents=True, exist_ok=True)
    for generation in generations:
        both = robots(2 * individuals, seed=generation)
        np.save(folder / f"S{seed}G{generation}.npy", both)
        np.save(folder / f"S{seed}FitG{generation}.npy", np.zeros((6, 3)))


@pytest.fixture
def course(tmp_path, monkeypatch):
    (tmp_path / "exercises").mkdir()
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path))
    return tmp_path


def test_own_run_comes_first(course):
    save(course / "data/genotypes/predprey", 12, (0, 7))
    save(course / "run", 3, range(0, 200, 10))
    run = load_run("run", most=5, best=2)
    assert list(run) == [0, 50, 100, 140, 190]
    predators, prey = run[50]
    np.testing.assert_array_equal(predators, robots(6, seed=50)[:2])
    np.testing.assert_array_equal(prey, robots(6, seed=50)[3:5])


def test_else_that_of_the_course(course):
    save(course / "data/genotypes/predprey", 12, (0, 7))
    assert list(load_run("run")) == [0, 7]
    save(course / "run", 3, (0,))
    assert list(load_run("run")) == [0, 7]
    assert len(load_run("run")[7][0]) == 3


def test_runs_that_cannot_be_used(course):
    with pytest.raises(BotschoolError, match="predprey"):
        load_run("run")
    (course / "data/genotypes/predprey").mkdir(parents=True)
    with pytest.raises(BotschoolError, match="holds no populations: evolve some"):
        load_run("run")
    save(course / "run", 3, (0, 1))
    save(course / "run", 4, (0, 1))
    with pytest.raises(BotschoolError, match=re.escape("several seeds (3, 4)")):
        load_run("run")


def test_a_caught_prey_is_drawn_touching():
    places = np.array([[[0.0, 0.0], [900.0, 0.0]], [[300.0, 0.0], [300.0, 200.0]]])
    drawn = _touching(places, 170.0)
    assert drawn[-1].tolist() == [[300.0, 30.0], [300.0, 200.0]]
    assert np.array_equal(drawn[:-1], places[:-1])
    assert places[-1, 0].tolist() == [300.0, 0.0], "the recorded chase stays as it is"


def test_pictures(tmp_path):
    sides, parts = ("predators", "prey"), ("change", "own", "others")
    matrices = {side: np.eye(3) for side in sides}
    spans = {"ancient": np.zeros(2), "present": np.ones(3), "future": np.zeros(2)}
    draw_tournament(tmp_path / "a.png", matrices, dict.fromkeys(sides, spans), [0, 10, 20])
    red = {side: {part: np.ones(2) for part in parts} for side in sides}
    draw_red_queen(tmp_path / "b.png", red, [0, 10, 20])
    poses = np.random.default_rng(1).uniform(100, 2900, (5, 2, 3))
    chases = {(0, 0): {"poses": poses, "caught": True}, (0, 9): {"poses": poses, "caught": False}}
    draw_chases(tmp_path / "c.png", chases)
    assert all((tmp_path / name).stat().st_size > 5000 for name in ("a.png", "b.png", "c.png"))
