"""MAP-Elites against plain Python that follows docs/specification.md, "MAP-Elites";
what robots do, told by the run; `botschool plotelites`.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from botschool import problems
from botschool.analysis.elites import Elites, Map
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.mapelites import MapElites, MapElitesConfig
from botschool.evolution.evaluate import Evaluator
from botschool.evolution.run import Run
from running import experiment, run_seeds

SIZE = 5
SMALL = {"batch": 20, "behaviour": "mean 2 (lean), spread 0", "lowest": "-0.2, 0",
         "highest": "0.2, 1", "cells": 6, "mutrate": 0.3}  # fmt: skip


def initial(index):
    return np.random.default_rng(index).normal(size=SIZE)


def done_by(candidates):
    """Fitness and behaviour of made-up robots with three observations."""
    means = np.stack([candidates[:, 0], candidates[:, 1], candidates[:, 2] / 2], axis=1)
    fitness = -np.abs(candidates).sum(axis=1)
    return fitness, np.stack([means, np.abs(means[:, ::-1])], axis=1)


def test_it_agrees_with_plain_python():
    own = MapElitesConfig(batch=7, behaviour="mean 2, spread 0", lowest="-1, 0", highest="1, 2",
                          cells=3, mutrate=0.4, linerate=0.3)  # fmt: skip
    algorithm, cells, empty = MapElites(own, initial, 5), {}, True
    for generation in range(40):
        children, seeds = algorithm.ask()
        assert seeds.tolist() == [5] * 7
        if empty:
            expected = [initial(generation * 7 + i) for i in range(7)]
        else:
            numbers = np.random.Generator(np.random.Philox(key=[5, generation]))
            there = sorted(cells)
            ones, others = numbers.integers(len(there), size=(2, 7)).tolist()
            noise, along = numbers.standard_normal((7, SIZE)), numbers.standard_normal(7)
            expected = []
            for i in range(7):
                one, other = cells[there[ones[i]]][1], cells[there[others[i]]][1]
                expected.append(one + 0.4 * noise[i] + 0.3 * along[i] * (other - one))
        np.testing.assert_allclose(children, expected, rtol=1e-12)
        fitness, behaviour = done_by(children)
        fitness[3] = math.nan if generation == 2 else fitness[3]
        behaviour[4, 0, 2] = math.nan if generation == 3 else behaviour[4, 0, 2]
        algorithm.tell(fitness, behaviour)
        for i in range(7):
            place = behaviour[i, 0, 2], behaviour[i, 1, 0]
            if math.isnan(fitness[i]) or math.isnan(place[0]):
                continue
            row = min(max(math.floor((place[0] + 1) / 2 * 3), 0), 2)
            column = min(max(math.floor(place[1] / 2 * 3), 0), 2)
            if (row, column) not in cells or fitness[i] > cells[row, column][0]:
                cells[row, column] = fitness[i], children[i]
        empty = not cells
        found = {divmod(int(i), 3) for i in np.flatnonzero(algorithm.fitness > -np.inf)}
        assert found == set(cells)
        for (row, column), (best, genotype) in cells.items():
            assert algorithm.fitness[3 * row + column] == best
            assert np.array_equal(algorithm.elites[3 * row + column], genotype)
    assert len(cells) > 5


@pytest.mark.parametrize("environment", ["CartPole-v1", "tiny_envs:Tiny-v0"])
def test_behaviour_is_mean_and_spread_of_what_the_robot_observes(environment, tmp_path):
    own = experiment(tmp_path, environment, "MAP-Elites", {"episodes": 2, "maxsteps": 30})
    problem = problems.of(own)
    policy = problem.policy(own.policy)
    candidates = np.array([policy.initial(3, i) for i in range(4)])
    seeds = np.array([8, 8, 9, 10], dtype=np.uint64)
    told = Evaluator(problem, policy, 1, behaviour=True).measure(candidates, seeds)
    plain = Evaluator(problem, policy, 1).measure(candidates, seeds)
    assert plain.behaviour is None and np.array_equal(plain.fitness, told.fitness)
    for i in range(4):
        episodes = []
        for episode in range(2):
            robot = candidates[i], None, int(seeds[i]), episode, 30
            if problem.native:
                genotype, *rest = robot
                seen = problem.engine(policy).record(genotype[None], *rest)["observations"]
            else:
                seen = [policy.network.observation.copy() for _ in problem.play(policy, *robot)]
            seen = np.asarray(seen, dtype=np.float64)
            episodes.append([seen.mean(axis=0), seen.std(axis=0)])
        np.testing.assert_allclose(told.behaviour[i], np.mean(episodes, axis=0), atol=1e-6)


@pytest.mark.parametrize(
    ("policy", "algo", "says"),
    [
        ({"normalize": 1}, {}, "set normalize = 0"),
        ({}, {"behaviour": "mean 2, spread 4"}, "observation 4, but a robot here has 4 of them"),
        ({}, {"behaviour": "mean 2"}, "does not name two features"),
        ({}, {"behaviour": "median 2, mean 1"}, "does not name two features"),
        ({}, {"lowest": "0"}, "not two numbers"),
        ({}, {"highest": "1, nan"}, "not two finite numbers"),
        ({}, {"lowest": "0, 2"}, "from 2 to 1"),
    ],
)
def test_a_map_that_cannot_be_is_refused(policy, algo, says, tmp_path):
    with pytest.raises(BotschoolError, match=says):
        Run(experiment(tmp_path, "CartPole-v1", "MAP-Elites", policy, **SMALL | algo), 1)


@pytest.fixture
def run(tmp_path):
    own = experiment(tmp_path, "CartPole-v1", "MAP-Elites", maxmsteps=0.05, **SMALL)
    assert run_seeds(own, tmp_path / "run")
    return tmp_path / "run"


@pytest.mark.slow
def test_elites_are_drawn_and_play(run, command, tmp_path):
    picture, page = tmp_path / "map.png", tmp_path / "map.html"
    code, said, _ = command("plotelites", run, "-s", 1, "-o", picture, "--replay", page)
    elites = Map(run, 1)
    count = len(elites.chosen())
    assert code == 0 and f"{len(elites.fitness)} of 36 cells have an elite" in said
    assert 1 < count <= 9 and f"episode {count}  elite {count}: lean " in said
    assert picture.read_bytes().startswith(b"\x89PNG") and "elite 2: lean" in page.read_text()


def test_an_elite_does_again_what_the_map_says(run):
    elites = Map(run, 1)
    own = replace(elites.experiment, policy=replace(elites.experiment.policy, episodes=1))
    elites.experiment = own
    problem = problems.of(own)
    robots = Elites(elites, 1, list(range(len(elites.fitness))))
    for episode in range(robots.available):
        list(robots.play(episode))
    policy = problem.policy(own.policy)
    seeds = np.ones(len(elites.genotypes), dtype=np.uint64)
    told = Evaluator(problem, policy, 1).measure(elites.genotypes, seeds)
    assert robots.fitness == told.fitness.tolist()


def test_a_folder_without_a_map_is_refused(run, refused, tmp_path):
    refused("plotelites", tmp_path, "-o", tmp_path / "a.png", says="no run of seed 1")
    refused("plotelites", run, "-s", 2, "-o", tmp_path / "a.png", says="no run of seed 2")
    refused("plotelites", run, "-o", tmp_path / "a.txt", says=".png")
    other = experiment(tmp_path / "sss", "CartPole-v1", "SSS")
    run_seeds(other, tmp_path / "sss")
    refused("plotelites", tmp_path / "sss", "-o", tmp_path / "a.png", says="only MAP-Elites")
    (run / "checkpointS1.npz").write_bytes(b"PK")
    refused("plotelites", run, "-o", tmp_path / "a.png", says="damaged")
