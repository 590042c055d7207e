"""The run loop: what it computes, and what its files say (docs/specification.md, "Evaluation"
and "Run files")."""

import math
from itertools import pairwise

import numpy as np
import pytest

from botschool import problems
from botschool.evolution.record import STAT
from botschool.evolution.run import Run, evolve
from botschool.policies.policy import Policy
from botschool.problems.base import Episodes
from botschool.render.watch import PostEvaluation
from running import ALGORITHMS, experiment, run_seeds, same

EVERY = [("CartPole-v1", algo) for algo in ALGORITHMS]
EVERY += [pytest.param("tiny_envs:Tiny-v0", algo, marks=pytest.mark.slow) for algo in ALGORITHMS]
every = pytest.mark.parametrize(("environment", "algo"), EVERY)


def small(folder, environment="CartPole-v1", algo="SSS", normalize=1, **options):
    maxmsteps = 0.01 if environment == "CartPole-v1" else 0.004
    policy = {"normalize": normalize, "clip": normalize, "episodes": 3, "pepisodes": 4}
    options = {"maxmsteps": maxmsteps} | options
    return experiment(folder, environment, algo, policy, **options)


class Evaluations:
    """What a run asked of its problem, and what came back, in order."""

    def __init__(self, run):
        self.asked = []
        evaluate = run.problem.evaluate

        def spying(policy, genotypes, normalisation, episodes, *rest):
            kept = None if normalisation is None else normalisation.copy()
            outcome = evaluate(policy, genotypes, normalisation, episodes, *rest)
            self.asked.append((genotypes.copy(), kept, episodes, outcome))
            return outcome

        run.problem.evaluate = spying

    def generations(self):
        """Pairs of an evaluation of all candidates and a post-evaluation."""
        assert len(self.asked) % 2 == 0
        return list(zip(self.asked[0::2], self.asked[1::2], strict=True))


def observed(folder, *arguments, **options):
    run = Run(small(folder, *arguments, **options), seed=7)
    evaluations = Evaluations(run)
    assert evolve(run, folder)
    if not run.problem.native:
        evaluations.asked.pop()  # the best robot once more, at the end
    evaluations.asked.pop()  # the best robot in fresh episodes
    return run, evaluations.generations()


@every
def test_files_have_the_names_and_shapes_of_the_format(environment, algo, tmp_path):
    run, _ = observed(tmp_path, environment, algo)
    expected = {"own.ini", "S7.fit", "bestS7.npy", "bestgS7.npy", "statS7.npy"}
    expected |= {"checkpointS7.npz", "tensorboardS7", "freshS7.txt"}
    assert {path.name for path in tmp_path.iterdir()} == expected
    inputs = run.problem.interface.observations
    size = run.policy.genotype_size + 2 * inputs
    for name in ("bestS7.npy", "bestgS7.npy"):
        saved = np.load(tmp_path / name)
        assert (saved.shape, saved.dtype) == ((size,), np.float64)
    flat = np.load(tmp_path / "statS7.npy")
    assert (flat.ndim, flat.dtype, flat.size % 6) == (1, np.float64, 0)
    words = (tmp_path / "S7.fit").read_text().split()
    fit = dict(zip(words[0::2], map(float, words[1::2]), strict=True))
    stat = flat.reshape(-1, 6)
    assert fit == {
        "seed": 7,
        "gen": len(stat),
        "steps": stat[-1, 0],
        "bestfit": stat[-1, 1],
        "bestgfit": stat[-1, 2],
    }
    assert (tmp_path / "S7.fit").read_text().count("\n") == 1


@every
def test_the_stat_file_says_what_happened(environment, algo, tmp_path):
    run, generations = observed(tmp_path, environment, algo)
    stat = np.load(tmp_path / "statS7.npy").reshape(-1, 6)
    assert len(stat) == len(generations) > 3
    steps, best, bestg = 0, -np.inf, -np.inf
    for row, (measured, post) in zip(stat, generations, strict=True):
        returns = measured[3].fitness.reshape(-1, 3).tolist()
        fitness = [math.fsum(three) / 3 for three in returns]
        steps += int(measured[3].steps.sum()) + int(post[3].steps.sum())
        best = max(best, max(fitness))
        bestg = max(bestg, math.fsum(post[3].fitness.tolist()) / 4)
        assert row[:4].tolist() == [steps, best, bestg, max(fitness)]
        assert row[4] == pytest.approx(sum(fitness) / len(fitness), rel=1e-14)
        # the generation's best is what is post-evaluated
        assert np.array_equal(post[0], measured[0][[int(np.argmax(fitness))]])
    # averages of parameters: before the last generation's change they were its candidates'
    if algo == "SSS":
        sizes = [np.abs(measured[0]).mean() for measured, _ in generations[1:]]
        assert stat[:-1, 5] == pytest.approx(sizes)
    assert stat[-1, 5] == run.algorithm.average_parameter() > 0


@every
def test_steps_stop_at_the_budget_and_not_before(environment, algo, tmp_path):
    run, _ = observed(tmp_path, environment, algo)
    steps = np.load(tmp_path / "statS7.npy").reshape(-1, 6)[:, 0]
    assert steps[-1] >= run.max_steps > steps[-2]
    assert run.record.steps == steps[-1]


@pytest.mark.parametrize("normalize", [0, 1])
@every
def test_saved_robots_have_the_fitness_that_was_recorded(environment, algo, normalize, tmp_path):
    """By a fresh problem, from the files alone, bit for bit."""
    experiment = small(tmp_path, environment, algo, normalize)
    assert run_seeds(experiment, tmp_path, [7])
    stat = np.load(tmp_path / "statS7.npy").reshape(-1, 6)
    problem = problems.make(environment)
    policy = Policy(problem.name, problem.interface, experiment.policy)

    def fitness(name, seed, episodes):
        genotype, vectors = policy.split(np.load(tmp_path / name))
        assert (vectors is None) == (normalize == 0)
        outcome = problem.evaluate(
            policy, genotype[None], vectors, Episodes.of([seed], episodes), 60
        )
        return math.fsum(outcome.fitness.tolist()) / episodes

    assert fitness("bestgS7.npy", 7 + 100_000, 4) == stat[-1, 2]
    generation = int(np.argmax(stat[:, 3]))
    seeds = [7 + generation]
    if algo == "OpenAI-ES":
        seeds = [7 + 3 * generation + pair for pair in range(3)]
    assert stat[-1, 1] in [fitness("bestS7.npy", seed, 3) for seed in seeds]

    shown = PostEvaluation(experiment, 7, np.load(tmp_path / "bestgS7.npy"))
    for episode in range(4):
        for _ in shown.play(episode):
            pass
    assert np.mean(shown.fitness) == pytest.approx(stat[-1, 2], rel=1e-12)


@every
def test_normalisation_data_come_from_one_percent_of_the_episodes(environment, algo, tmp_path):
    """... in post-evaluations only, and from the first one on."""
    _, generations = observed(tmp_path, environment, algo, maxmsteps=0.03)
    evaluated = collected = 0
    for measured, post in generations:
        assert measured[2].collect is None or not measured[2].collect.any()
        evaluated += len(measured[2])
        collected += int(post[2].collect.sum())
        assert 0 <= collected - 0.01 * evaluated < 1
    assert collected > 3


@every
def test_vectors_change_once_a_generation(environment, algo, tmp_path):
    """They follow the running statistics of docs/specification.md, "Policy network"."""
    run, generations = observed(tmp_path, environment, algo)
    inputs = run.problem.interface.observations
    count, total, squares = 0.01, np.zeros(inputs), np.full(inputs, 0.01)
    expected = np.repeat([0.0, 1.0], inputs)
    for measured, post in generations:
        assert np.array_equal(measured[1], post[1])
        np.testing.assert_allclose(post[1], expected, rtol=1e-6, atol=1e-7)
        for i in np.flatnonzero(post[2].collect):
            played = run.problem.play(
                run.policy, post[0][0], post[1], 7 + 100_000, int(post[2].episode[i]), 60
            )
            seen = np.array([moment.observation for moment in played])
            assert len(seen) == post[3].steps[i]
            count += len(seen)
            total += seen.sum(axis=0)
            squares += (seen**2).sum(axis=0)
        mean = total / count
        std = np.sqrt(np.maximum(squares / count - mean**2, 0.01))
        expected = np.concatenate([mean, std])
    assert np.array_equal(run.evaluator.normalisation, run.evaluator.state()["normalisation"])
    np.testing.assert_allclose(run.evaluator.normalisation, expected, rtol=1e-6, atol=1e-7)
    before = [measured[1] for measured, _ in generations]
    assert any(not np.array_equal(one, two) for one, two in pairwise(before))


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_replications_are_runs_with_consecutive_seeds(algo, tmp_path):
    experiment = small(tmp_path, algo=algo)
    assert run_seeds(experiment, tmp_path / "three", [4, 5, 6])
    for seed in (4, 5, 6):
        assert run_seeds(experiment, tmp_path / "each", [seed])
    assert same(tmp_path / "three", tmp_path / "each")
    best = [np.load(tmp_path / "three" / f"bestS{seed}.npy") for seed in (4, 5, 6)]
    assert not np.array_equal(best[0], best[1]) and not np.array_equal(best[1], best[2])


@pytest.mark.parametrize("stopped", [False, True])
def test_event_files_hold_the_curves_of_the_stat_file(stopped, tmp_path):
    from tensorboard.backend.event_processing.event_accumulator import EventAccumulator

    experiment = small(tmp_path)
    if stopped:  # the curves of a resumed run are whole, and no point is there twice
        assert run_seeds(experiment, tmp_path, steps=3000)
    assert run_seeds(experiment, tmp_path, resume=stopped)
    (file,) = (tmp_path / "tensorboardS1").iterdir()
    events = EventAccumulator(str(file)).Reload()
    stat = np.load(tmp_path / "statS1.npy").reshape(-1, 6).astype(np.float32)
    assert set(events.Tags()["scalars"]) == {*STAT[1:], "generation"}
    for column, tag in enumerate(STAT[1:], 1):
        points = events.Scalars(tag)
        assert [point.step for point in points] == stat[:, 0].tolist()
        assert [np.float32(point.value) for point in points] == stat[:, column].tolist()
    numbers = [point.value for point in events.Scalars("generation")]
    assert numbers == list(range(1, len(stat) + 1))


@pytest.mark.parametrize(
    "environment", ["Pendulum-v1", pytest.param("MountainCar-v0", marks=pytest.mark.slow)]
)
def test_post_evaluations_may_have_longer_episodes(environment, tmp_path):
    """pmaxsteps; here no episode ends by itself. With workers, and resumed, it is the same."""
    policy = {"maxsteps": 20, "pmaxsteps": 50}
    own = experiment(tmp_path, environment, policy=policy, maxmsteps=0.001)
    assert run_seeds(own, tmp_path / "one")
    generation = 6 * 2 * 20 + 3 * 50
    steps = np.load(tmp_path / "one" / "statS1.npy").reshape(-1, len(STAT))[:, 0]
    assert steps.tolist() == [generation, 2 * generation, 3 * generation]
    assert run_seeds(own, tmp_path / "two", workers=2, steps=1)
    assert run_seeds(own, tmp_path / "two", workers=2, resume=True)
    assert same(tmp_path / "one", tmp_path / "two")
    saved = np.load(tmp_path / "one" / "bestgS1.npy")
    shown = PostEvaluation(own, 1, saved)
    for episode in range(3):
        assert len(list(shown.play(episode))) == 50
    best = run_fitness(tmp_path / "one" / "S1.fit")
    assert np.mean(shown.fitness) == pytest.approx(best)


def run_fitness(path):
    """The best post-evaluated fitness that a .fit file names."""
    words = path.read_text().split()
    return float(words[words.index("bestgfit") + 1])
