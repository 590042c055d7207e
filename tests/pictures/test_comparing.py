"""compare, plotstat --box, landscape and plotmatrix."""

import itertools

import numpy as np
import pytest

from botschool.analysis import comparison
from botschool.analysis.comparison import compare, verdict

INI = "[EXP]\nenvironment = CartPole-v1\n[POLICY]\nepisodes = 1\n[ALGO]\nmaxmsteps = 0.002\n"


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Two folders of results of which b is better than a."""
    base = tmp_path_factory.mktemp("compare")
    for name, better in (("a", 0), ("b", 50)):
        (base / name).mkdir()
        for seed in range(5):
            row = np.array([1000.0, 1, 10 * seed + better, 1, 1, 1])
            np.save(base / name / f"statS{seed}.npy", row)
    return base


def test_a_test_of_all_assignments_is_exact():
    first, second = np.array([1.0, 2, 3, 5]), np.array([4.0, 6, 7, 8])
    found = compare(first, second)
    both = np.concatenate([first, second])  # their ranks are 1 to 8
    sums = [sum(both[list(rows)]) for rows in itertools.combinations(range(8), 4)]
    assert found.p == np.mean([abs(each - 18) >= abs(first.sum() - 18) for each in sums])
    assert found.least == 2 / 70
    assert found.better == 15 / 16
    assert found.medians == (2.5, 6.5) and found.difference == 4
    assert found.intervals[0][0] >= 1 and found.intervals[0][1] <= 5


@pytest.mark.parametrize("n", [3, 8, 40])
def test_equal_samples_do_not_differ_and_far_ones_do(n):
    values = np.arange(n, dtype=float)
    same, far = compare(values, values), compare(values, values + 1000)
    assert (same.p, same.better) == (1.0, 0.5)
    assert far.better == 1 and far.interval[0] > 0
    assert (far.p <= comparison.LEVEL) == (n > 3)
    assert compare(values, values + 1000) == far  # the seed is fixed


def test_the_sentence_says_what_the_numbers_mean():
    few = compare(np.arange(3.0), np.arange(3.0) + 10)
    assert "cannot show a difference" in verdict(few, "a", "b", 3, 3)
    clear = compare(np.arange(9.0), np.arange(9.0) + 100)
    assert verdict(clear, "a", "b", 9, 9).startswith("b is better than a, a large effect")
    unclear = compare(np.arange(9.0), np.arange(9.0) + 0.5)
    assert "That does not prove them equal" in verdict(unclear, "a", "b", 9, 9)


def test_the_command_compares_and_draws(runs, command, refused, tmp_path):
    picture = tmp_path / "boxes.png"
    code, said, _ = command("compare", runs / "a", runs / "b", "-o", picture)
    assert code == 0 and "b is better than a" in said and picture.stat().st_size > 5000
    code, _, _ = command("plotstat", "--box", runs / "a", runs / "b", "-o", tmp_path / "box.svg")
    assert code == 0 and (tmp_path / "box.svg").is_file()
    refused("compare", runs / "a", runs / "a", says="itself")
    refused("compare", runs / "a", runs / "no", says="no folder")
    refused("compare", runs / "a", runs / "b", "-o", tmp_path / "x.txt", says=".png")


@pytest.mark.slow
def test_brains_do_best_in_their_own_bodies(tmp_path, monkeypatch, command, refused):
    monkeypatch.chdir(tmp_path)
    walker = "[EXP]\nenvironment = PlanarBodyBrain-v0\n[POLICY]\nmaxsteps = 100\nepisodes = 1\n"
    (tmp_path / "w.ini").write_text(walker + "[ALGO]\nmaxmsteps = 0.02\n")
    assert command("es", "-f", "w.ini", "-s", 1, "-n", 2, "-o", "w")[0] == 0
    code, said, _ = command("plotmatrix", "w", "-o", "m.png")
    assert code == 0 and "in its own body" in said and (tmp_path / "m.png").stat().st_size > 5000
    (tmp_path / "c.ini").write_text(INI)
    assert command("es", "-f", "c.ini", "-s", 1, "-o", "c")[0] == 0
    refused("plotmatrix", "c", "-o", "m.png", says="evolves no bodies")
    refused("plotmatrix", ".", "-o", "m.png", says="no checkpoint")


def test_predators_and_prey_give_a_matrix(tmp_path, monkeypatch, command, refused):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "p.ini").write_text(
        "[EXP]\nenvironment = ErPredprey\nalgo = coevo2\n[POLICY]\nnrobots = 2\n"
        "heterogeneous = 1\nmaxsteps = 20\nnhiddens = 2\n"
        "[ALGO]\npopsize = 4\nselsize = 2\nsamplesize = 2\n"
    )
    assert command("es", "-f", "p.ini", "-s", 1, "-o", "p", "--generations", 1)[0] == 0
    code, said, _ = command("plotmatrix", "p", "-o", "m.png")
    assert code == 0 and "mean return of the predators" in said
    for path in (tmp_path / "p").glob("S1FitG*.npy"):
        path.write_bytes(b"x")
    refused("plotmatrix", "p", "-o", "m.png", says="damaged")
