"""The master tournament of co-evolved populations: files, meetings, progress."""

import numpy as np
import pytest

from botschool import config
from botschool.analysis import coevolution
from botschool.analysis.populations import Populations, read_population
from botschool.analysis.tournament import (
    Contest,
    global_progress,
    historical_progress,
    master_tournament,
    play,
    progress,
    summarised,
    verdict,
)
from botschool.errors import BotschoolError
from botschool.seeds import POST_EVALUATION_SEED
from duels import (
    STILL,
    STRAIGHT,
    experiment,
    policy_of,
    random_populations,
    write_run,
)


@pytest.fixture
def results(tmp_path):
    return write_run(tmp_path / "results")


# Files


def damage():
    yield "no populations", lambda path: path.write_bytes(b"words")
    yield "no populations", lambda path: np.save(path, np.zeros(50))
    yield "no populations", lambda path: np.save(path, np.full((6, 50), np.nan))
    yield "as many predators as prey", lambda path: np.save(path, np.zeros((5, 50)))
    yield "have 50", lambda path: np.save(path, np.zeros((6, 49)))
    yield "cannot be read", lambda path: (path.unlink(), path.mkdir())
    yield "not from one run", lambda path: np.save(path.parent / "S12FitG10.npy", np.zeros((4, 2)))
    yield "no fitness", lambda path: (path.parent / "S12FitG10.npy").write_bytes(b"")


@pytest.mark.parametrize(("says", "spoil"), list(damage()))
def test_a_damaged_file_is_refused_in_a_sentence(results, says, spoil):
    path = results / "S12G10.npy"
    spoil(path)
    with pytest.raises(BotschoolError, match=says) as refused:
        read_population(path, policy_of(results / "own.ini"), "generation 10")
    assert "G10.npy" in str(refused.value)


# Who meets whom


def test_the_tables_are_by_generation_and_the_preys_is_seen_from_the_other_side(tmp_path):
    contest = Contest(config.load(experiment(tmp_path)), seed=1)
    fitness = play(
        contest,
        [np.array([STILL, STILL]), np.array([STILL, STRAIGHT])],
        [np.array([STILL, STILL]), np.array([STRAIGHT, STRAIGHT])],
    )
    assert fitness.shape == (2, 2, 2, 2)
    caught = 1 - 21 / 60
    assert fitness[1, 0].tolist() == [[0, 0], [caught, caught]]
    predators, prey = summarised(fitness, seed=1)
    assert predators.mean[0, 0] == 0 and predators.mean[1, 0] == pytest.approx(caught / 2)
    # Rows of the prey's table are the prey's generations.
    assert prey.mean[0, 1] == pytest.approx(1 - caught / 2)
    np.testing.assert_allclose(prey.mean, 1 - predators.mean.T)
    np.testing.assert_allclose(prey.interval[0], 1 - predators.interval[1].T)


@pytest.mark.parametrize("pepisodes", [1, 2])
def test_a_tournament_is_what_playing_each_pair_gives(tmp_path, pepisodes):
    loaded = config.load(experiment(tmp_path, nhiddens=2, pepisodes=pepisodes))
    contest = Contest(loaded, seed=3)
    populations = [np.split(random_populations(contest.policy, g, 2), 2) for g in (1, 2, 3)]
    fitness = play(contest, [p for p, _ in populations], [q for _, q in populations])
    for i, j, n, m in np.ndindex(fitness.shape):
        pair = np.stack([populations[i][0][n], populations[j][1][m]])
        returns = [
            list(
                contest.problem.play(
                    contest.policy, pair, None, 3 + POST_EVALUATION_SEED, episode, 60
                )
            )[-1].total
            for episode in range(pepisodes)
        ]
        assert fitness[i, j, n, m] == pytest.approx(np.mean(returns), abs=1e-12)


def test_workers_change_nothing_and_neither_does_a_second_time(results):
    def found(workers):
        contest = Contest(config.load(results / "own.ini"), 12, workers)
        populations = Populations(results, 12, contest.policy)
        return master_tournament(contest, coevolution.select(populations, [0, 10, 20]))

    for one, other in zip(found(1), found(3), strict=True):
        np.testing.assert_array_equal(one.mean, other.mean)
        np.testing.assert_array_equal(one.samples, other.samples)


# Progress


def arms_race(own, other):
    """Fitness of generations with these strengths, mean 0.5 for equal ones."""
    return 0.5 + np.subtract.outer(np.asarray(own, float), np.asarray(other, float))


def test_steady_progress_is_its_slope_times_the_mean_distance_of_two_generations():
    steps = 0.02 * np.arange(10)
    table = arms_race(steps, steps)  # contemporaries are always equal
    assert np.ptp(table.diagonal()) < 1e-12
    distance = (10 + 1) / 3
    assert historical_progress(table) == pytest.approx(0.02 * distance)
    assert global_progress(table) == pytest.approx(0.02 * distance)
    assert historical_progress(table[::-1]) == pytest.approx(-0.02 * distance)


def test_indices_are_the_sums_that_their_docstrings_say():
    table = np.random.default_rng(5).random((3, 5, 5))
    pairs = [(i, j) for j in range(5) for i in range(j)]
    gains = [table[:, j] - table[:, i] for i, j in pairs]
    ancient = [gain[:, : i + 1].mean(1) for (i, _), gain in zip(pairs, gains, strict=True)]
    np.testing.assert_allclose(historical_progress(table), np.mean(ancient, axis=0))
    np.testing.assert_allclose(global_progress(table), np.mean(gains, axis=(0, 2)))


def noisy(own, other, individuals, seed):
    """Fitness (g, g, n, n) of individuals that scatter around their generation's strength."""
    rng = np.random.default_rng(seed)
    a = np.asarray(own)[:, None] + rng.normal(0, 0.1, (len(own), individuals))
    b = np.asarray(other)[:, None] + rng.normal(0, 0.1, (len(other), individuals))
    return 0.5 + a[:, None, :, None] - b[None, :, None, :]


@pytest.mark.slow
def test_intervals_hold_the_true_progress_about_as_often_as_they_say():
    steps = 0.01 * np.arange(5)
    truth, held = 0.01 * (5 + 1) / 3, []
    for seed in range(30):
        table, _ = summarised(noisy(steps, steps, 8, seed), seed)
        found = progress(table)["global progress"]
        held.append(found.low <= truth <= found.high)
        assert found.low < found.value < found.high
    assert np.mean(held) >= 0.8


@pytest.mark.parametrize(
    ("slope", "says"), [(0.1, "do better against"), (0.0, "neither"), (-0.1, "do worse against")]
)
def test_the_verdict_follows_the_interval_of_the_historical_progress(slope, says):
    steps = slope * np.arange(6)
    for table, other in zip(
        summarised(noisy(steps, steps, 8, 1), 1), ("prey", "predators"), strict=True
    ):
        sentence = verdict(table, [f"generation {g}" for g in range(6)])
        assert sentence.startswith(f"Later {table.role} do ") and f"ancient {other}" in sentence
        assert says in sentence and "generation 5 reach" in sentence
