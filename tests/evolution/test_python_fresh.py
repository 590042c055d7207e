"""The number to report of a run: its best robot in fresh episodes."""

import numpy as np
import pytest

from botschool import config, problems
from botschool.evolution import fresh
from botschool.problems import Episodes
from running import call, contents, experiment, run_seeds, write_experiment


def single(folder, **changed):
    """A run whose post-evaluations have a single episode."""
    return write_experiment(folder, policy={"pepisodes": 1} | changed, maxmsteps=0.003)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("environment", "pepisodes", "normalize"),
    [
        *(("CartPole-v1", 1, 0), ("CartPole-v1", 30, 0)),
        *(("Pendulum-v1", 3, 1), ("tiny_envs:Tiny-v0", 2, 1)),
    ],
)  # fmt: skip
def test_they_are_the_episodes_of_the_specification(environment, pepisodes, normalize, tmp_path):
    policy = {"pepisodes": pepisodes, "normalize": normalize, "pmaxsteps": 70}
    own = experiment(tmp_path, environment, "SSS", policy)
    assert run_seeds(own, tmp_path / "runs", (4,))
    found = np.loadtxt(tmp_path / "runs/freshS4.txt")
    assert len(found) == max(20, pepisodes)
    problem = problems.of(own)
    made = problem.policy(own.policy)
    genotype, vectors = made.split(np.load(tmp_path / "runs/bestgS4.npy"))
    episodes = Episodes.of([200_004], len(found))
    again = problem.evaluate(made, genotype[None], vectors, episodes, 70).fitness
    assert found.tolist() == again.tolist()  # the text keeps every bit


@pytest.mark.slow
@pytest.mark.parametrize("workers", [1, 2])
def test_the_last_line_reports_them_with_an_interval(workers, tmp_path):
    code, out, _ = call("es", "-f", single(tmp_path), "-o", tmp_path / "o", "-w", workers, "-n", 2)
    assert code == 0
    ends = sorted(line for line in out.splitlines() if ": best " in line)
    for seed, line in zip((1, 2), ends, strict=True):
        returns = np.loadtxt(tmp_path / f"o/freshS{seed}.txt")
        told = f"{fresh.told(returns)} in 20 fresh episodes (95 % interval)"
        assert line.startswith(f"seed {seed}: ") and line.endswith(told)


def test_a_run_that_goes_on_measures_its_new_best_robot(tmp_path):
    own = experiment(tmp_path, maxmsteps=0.02)
    assert run_seeds(own, tmp_path / "parts", steps=500)
    first = (tmp_path / "parts/freshS1.txt").read_text()
    assert run_seeds(own, tmp_path / "parts", resume=True)
    assert run_seeds(own, tmp_path / "whole")
    assert contents(tmp_path / "parts") == contents(tmp_path / "whole")
    assert (tmp_path / "whole/freshS1.txt").read_text() != first
    assert run_seeds(own, tmp_path / "parts", force=True, steps=500)
    assert (tmp_path / "parts/freshS1.txt").read_text() == first


@pytest.mark.slow
@pytest.mark.parametrize(
    ("pepisodes", "remove", "says"),
    [
        (1, "freshS*", "seed 1 and 2: the number is the best of many post-evaluations of 1 epis"),
        (3, "freshS2*", "seed 2: the number is the best of many post-evaluations of 3 episodes,"),
        (3, "", ""),
        (1, "", ""),
        (1, "[fc]*", ""),  # an older library's files tell nothing of episodes
    ],
)  # fmt: skip
def test_plotave_reports_them_and_warns_of_lucky_numbers(pepisodes, remove, says, tmp_path):
    own = config.load(single(tmp_path, pepisodes=pepisodes))
    assert run_seeds(own, tmp_path / "o", (1, 2))
    values = [np.loadtxt(tmp_path / f"o/freshS{seed}.txt").mean() for seed in (1, 2)]
    for path in (tmp_path / "o").glob(remove) if remove else ():
        path.unlink()
    _, out, errors = call("plotave", tmp_path / "o", "-o", tmp_path / "a.png")
    assert (says in errors) if says else not errors, errors
    title = out.splitlines()[0].strip()
    if not remove:
        assert title == "best robots in fresh episodes"
        half = 12.706 * np.std(values, ddof=1) / np.sqrt(2)
        row = out.splitlines()[-2].split()
        assert float(row[1]) == pytest.approx(np.mean(values), abs=0.06)
        assert float(row[2]) == pytest.approx(half, abs=0.06)
    else:
        mixed = "best robots, in fresh episodes or post-evaluated"
        assert title == (mixed if "2" in remove else "best post-evaluated fitness")


def test_intervals_are_students(tmp_path):
    stats = pytest.importorskip("scipy.stats")
    rng = np.random.default_rng(1)
    for n in (2, 3, 4, 5, 6, 10, 20, 100):
        values = rng.normal(size=n)
        right = stats.t.ppf(0.975, n - 1) * values.std(ddof=1) / np.sqrt(n)
        assert fresh.half_width(values) == pytest.approx(right, rel=0.002)
    assert np.isnan(fresh.half_width(values[:1])) and fresh.told(np.array([2.0])) == "2.00"
