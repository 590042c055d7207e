"""Laboratories: honest sheets get all points, each wrong one loses exactly what it should.

The simulated students of tests/lab_answers do each laboratory with small budgets, once. The runs of
the first one are then spoiled in each way. `-k lab09` proves laboratory 9 alone.
"""

import shutil
from dataclasses import replace

import numpy as np
import pytest

from botschool.evolution.record import RunFiles
from botschool.labs.check import Check
from botschool.labs.declare import NUMBERS
from botschool.labs.folder import Place, start
from botschool.labs.runs import make_runs, own_runs
from lab_cheats import FULL, IF_DRAWN, NOTHING, SPOILED, conclusions_against_their_data, without
from lab_students import PEOPLE, answer, conclude, copied, honest, predicted, small

pytestmark = pytest.mark.course
each_lab = pytest.mark.parametrize("number", NUMBERS, ids=lambda number: f"lab{number:02}")
KINDS = (3, 9, 12, 15)
"""A laboratory of each kind of runs: our evolution, the student's, trainings, two sides."""
PAIRS = [
    *((number, spoil) for number in KINDS for spoil in SPOILED + IF_DRAWN),
    *((number, conclusions_against_their_data) for number in NUMBERS if number not in KINDS),
]


def checked(place):
    """The points of each part, and all messages."""
    parts = Check(place).all().parts.values()
    return {p.name: p.points for p in parts}, " ".join(m for p in parts for m in p.messages)


def points(place):
    return checked(place)[0]


@pytest.fixture(scope="module")
def students(tmp_path_factory):
    """A function that gives three students' finished laboratories, made once."""
    made = {}

    def of(number):
        if number not in made:
            lab, folder = small(number), tmp_path_factory.mktemp(f"lab{number:02}")
            made[number] = [honest(lab, folder / name, name) for name in PEOPLE]
        return made[number]

    return of


@each_lab
def test_three_honest_sheets_with_different_outcomes_get_all_points(number, students):
    outcomes = set()
    for place in students(number):
        found = Check(place).all()
        told = [message for part in found.parts.values() for message in part.messages]
        assert {name: part.points for name, part in found.parts.items()} == FULL, told
        assert found.picture.startswith(b"\x89PNG")
        answers = [str(found.answers[id]) for id in place.lab.statements]
        table = [cell for c in place.lab.conditions for cell in place.sheet().row(c.name)]
        outcomes.add((*answers, *table))
    assert len(outcomes) == 3


@each_lab
def test_an_empty_sheet_gets_nothing(number, tmp_path):
    place = Place(small(number), tmp_path / f"lab{number:02}")
    start(place, "Ada", "botschool")
    assert points(place) == NOTHING


@pytest.mark.parametrize(
    ("number", "spoil"), PAIRS, ids=[f"lab{number:02}-{spoil.__name__}" for number, spoil in PAIRS]
)
def test_a_spoiled_sheet_loses_exactly_what_it_should(number, spoil, students, tmp_path):
    place, other = students(number)[:2]
    place = copied(place, tmp_path)
    if spoil in IF_DRAWN:
        place = all_redone(place)
    left, says = spoil(place, other)
    found, told = checked(place)
    assert found == left, told
    assert says in told


# --- figures and measures, on one laboratory
@pytest.fixture
def spoiled(students, tmp_path):
    """A copy of Ada's laboratory 9, to spoil."""
    return copied(students(9)[0], tmp_path)


def all_redone(place):
    """All runs are made again."""
    return replace(place, lab=replace(place.lab, redone=1000))


def test_a_tipping_point_that_is_not_marked_costs_three_points(spoiled):
    figure = replace(spoiled.lab.figure, mark=lambda data: 0.7)
    spoiled = replace(spoiled, lab=replace(spoiled.lab, figure=figure))
    assert points(spoiled) == FULL | {"figure": 7}
    path = spoiled.folder / "figure.py"
    path.write_text(path.read_text().replace("return pic", "axes.axvline(0.7)\n    return pic"))
    assert points(spoiled) == FULL


def test_a_figure_of_means_costs_the_figure(spoiled):
    path = spoiled.folder / "figure.py"
    runs = '[x] * len(values["metres"]), values["metres"]'
    path.write_text(path.read_text().replace(runs, 'x, values["metres"].mean()'))
    found, told = checked(spoiled)
    assert found == FULL | {"figure": 0} and "not their means" in told


@pytest.mark.parametrize(
    ("change", "says"),
    [
        (("metres < RULE", "metres > RULE"), "statue"),
        (('"metres": metres', '"metres": metres + 1'), "of a run of ours"),
        (('"ground": seen["feet"].mean(), ', ""), "returns no 'ground'"),
        (("seen = record", "import os; os._exit(0)\n    seen = record"), "ended"),
    ],
)
def test_a_wrong_measure_costs_measure_alone(spoiled, change, says):
    path = spoiled.folder / "measure.py"
    path.write_text(path.read_text().replace(*change))
    found, told = checked(spoiled)
    assert found == FULL | {"measurements": 15} and says in told


# --- curves, strategies and rules
def drawn_by_hand(place, column):
    """A number of a run's curve changed, in the first condition."""
    file = next((place.runs / place.lab.conditions[0].name).glob("statS*.npy"))
    stat = np.load(file)
    stat[column] += 1
    np.save(file, stat)
    most = len(place.lab.conditions)
    return round(10 * (most - 1) / most, 1)


@pytest.mark.parametrize("number", [3, 9])
def test_a_curve_that_was_drawn_by_hand_is_found_when_its_run_is_drawn(number, students, tmp_path):
    """Of the tool's algorithm; of the student's strategy."""
    place = all_redone(copied(students(number)[0], tmp_path))
    assert points(place) == FULL
    left = drawn_by_hand(place, column=4)
    found, told = checked(place)
    assert found["runs"] == left, told


def test_stopped_runs_go_on_and_are_the_same(students, tmp_path):
    done = students(3)[0]
    place = predicted(small(3), tmp_path)
    folder = place.runs / "Pendulum 4"
    shutil.copytree(done.runs, place.runs)
    before = {file.name: file.read_bytes() for file in folder.glob("*.npy")}
    for file in sorted(folder.glob("*S*")):
        shutil.rmtree(file) if file.is_dir() else file.unlink()
    assert make_runs(place.lab, place.sheet(), place.runs, 1, place.lab.replications)
    assert {file.name: file.read_bytes() for file in folder.glob("*.npy")} == before
    conclude(place)
    assert points(place) == FULL


def test_a_strategy_that_changed_after_the_runs_costs_its_runs(spoiled):
    path = spoiled.folder / "strategy.py"
    path.write_text(path.read_text().replace("default_rng(seed)", "default_rng(seed + 1)"))
    found, told = checked(all_redone(spoiled))
    assert found == NOTHING and "strategy.py" in told


@pytest.mark.parametrize("spoil", ["swapped", "edited", "missing"])
def test_a_checkpoint_that_is_not_the_runs_own_costs_the_run(spoil, spoiled):
    name = spoiled.lab.conditions[0].name
    one, two = own_runs(spoiled.lab, spoiled.sheet(), spoiled.runs)[name][:2]
    file, other = (RunFiles(spoiled.runs / name, run.seed).checkpoint for run in (one, two))
    if spoil == "edited":
        with np.load(file) as saved:
            content = dict(saved)
        content["algorithm.told"][-1] += 1
        np.savez(file, **content)
    else:
        file.write_bytes(other.read_bytes()) if spoil == "swapped" else file.unlink()
    found, told = checked(all_redone(spoiled))
    assert found == without(spoiled.lab, name, evidence=0), told
    assert f"{name}, seed {one.seed}" in told and str(two.seed) not in told


def test_runs_of_other_rules_than_the_students_are_not_his(students, tmp_path):
    place = all_redone(copied(students(12)[0], tmp_path))
    path = place.folder / "learn.py"
    path.write_text(path.read_text().replace(">= bound", "> bound"))
    found, told = checked(place)
    assert found["runs"] == 2.5 and "it comes out differently" in told


def test_seconds_that_no_machine_needs_cost_their_points_alone(students, tmp_path):
    """What follows from them is judged by the checker's own in their place."""
    place = copied(students(14)[0], tmp_path)
    answer(place, {"seconds-long-evolution": 9999})
    found, told = checked(place)
    assert found == FULL | {"conclusion": 21}, told
    assert "long evolution: 9999 is more than ten times off" in told
