"""Laboratories: honest sheets get all points, each wrong one loses exactly what it should.

The simulated students of tests/lab_answers do each laboratory with small budgets, once. The runs of
the first one are then spoiled in each way. `-k lab09` proves laboratory 9 alone.
"""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from botschool.labs.check import Check
from botschool.labs.declare import NUMBERS, PARTS
from botschool.labs.folder import Place, start
from botschool.labs.runs import make_runs, own_runs
from botschool.labs.sheet import seeds_of
from lab_students import answer, conclude, copied, edit, honest, predicted, small, student

pytestmark = pytest.mark.course
FULL = {name: float(most) for name, most in PARTS.items()}
NOTHING = dict.fromkeys(FULL, 0)
each_lab = pytest.mark.parametrize("number", NUMBERS, ids=lambda number: f"lab{number:02}")


def checked(place):
    """The points of each part, and all messages."""
    parts = Check(place).all().parts
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
            made[number] = [
                honest(lab, folder / name, name, **told) for name, told in student(number).HONEST
            ]
        return made[number]

    return of


@each_lab
def test_three_honest_sheets_with_different_outcomes_get_all_points(number, students):
    outcomes = set()
    for place in students(number):
        found = Check(place).all()
        told = [message for part in found.parts for message in part.messages]
        assert {part.name: part.points for part in found.parts} == FULL, told
        assert found.picture.startswith(b"\x89PNG")
        answers = [str(found.answers[statement.field]) for statement in place.lab.statements]
        table = [cell for c in place.lab.conditions for cell in place.sheet().row(c.name)]
        outcomes.add((*answers, *table))
    assert len(outcomes) == 3


@each_lab
def test_an_empty_sheet_gets_nothing(number, tmp_path):
    place = Place(small(number), tmp_path / f"lab{number:02}")
    start(place, "Ada", "botschool")
    assert points(place) == NOTHING


# --- each gives what is left of the points, and a part of what is said
def no_runs(place, other):
    shutil.rmtree(place.runs)
    return NOTHING, "There are no runs yet"


def runs_of_another(place, other):
    """As they are: their seeds follow from another name."""
    shutil.rmtree(place.runs)
    shutil.copytree(other.runs, place.runs)
    return NOTHING, "belong to"


def runs_of_another_renamed(place, other):
    """Under the seeds of this student."""
    shutil.rmtree(place.runs)
    mine, his = (seeds_of(each.sheet(), each.lab) for each in (place, other))
    for name, seeds in mine.items():
        (place.runs / name).mkdir(parents=True)
        for seed, old in zip(seeds, his[name], strict=True):
            for path in (other.runs / name).glob(f"*S{old}*.np*"):
                shutil.copy(path, place.runs / name / path.name.replace(str(old), str(seed)))
    there = own_runs(place.lab, place.sheet(), place.runs)
    assert all(len(runs) == place.lab.replications for runs in there.values())
    return NOTHING, "Evolving from the same seeds gives other files"


def another_robot(place, other):
    """A genotype edited, in the best run of the last condition."""
    name = place.lab.conditions[-1].name
    runs = own_runs(place.lab, place.sheet(), place.runs)[name]
    best = max(runs, key=lambda run: run.stat[-1, 2])
    file = place.runs / name / f"bestgS{best.seed}.npy"
    genotype = np.load(file)
    genotype[: len(genotype) // 2] = 0
    np.save(file, genotype)
    return without(place.lab, name, evidence=0), f"{name}, seed {best.seed}"


def too_few(place, other):
    name = place.lab.conditions[-1].name
    next((place.runs / name).glob("statS*.npy")).unlink()
    left = place.lab.replications - 1
    return without(place.lab, name, evidence=15), f"{name} has {left}"


def another_prediction(place, other):
    answer(place, {"why": "I knew it before because somebody has told me the result of it all."})
    return NOTHING, "The prediction has changed since the runs were made"


def invented_number(place, other):
    """A cell of the table."""
    lab = place.lab
    name = lab.conditions[-1].name
    at = next(i for i, column in enumerate(lab.columns) if column.only(name))
    row = [*place.sheet().row(name)]
    row[at] = re.sub(r"[-\d.]+", "-77777", row[at])
    line = f"| {name} | {' | '.join(row)} |"
    edit(place, lambda text: re.sub(rf"^\| {re.escape(name)} \|.*$", line, text, flags=re.M))
    most = len(cells(lab))
    left = FULL | {"measurements": round(10 + 15 * (most - 1) / most, 1)}
    return left, f"The table, {name}, {lab.columns[at].title}: your runs give"


def one_choice_against_its_data(place, other):
    """The first choice of the conclusion."""
    kinds = {field.id: field.kind for field in place.lab.fields}
    statement = next(s for s in place.lab.statements if kinds[s.field] == "choice")
    contradict(place, [statement])
    return FULL | {"conclusion": 25 - statement.points}, f"{statement.field}: "


def conclusions_against_their_data(place, other):
    """Every one."""
    contradict(place, place.lab.statements)
    return FULL | {"conclusion": 0}, f"{place.lab.statements[-1].field}: "


SPOILED = [
    no_runs,
    runs_of_another,
    runs_of_another_renamed,
    another_robot,
    too_few,
    another_prediction,
    invented_number,
    one_choice_against_its_data,
    conclusions_against_their_data,
]


def contradict(place, statements):
    """Answer what the student's own data do not support."""
    found = Check(place).all()
    fields = {field.id: field for field in place.lab.fields}
    for statement in statements:
        field = fields[statement.field]
        offered = re.findall(r"\[.\] (.+?)(?=   |$)", place.sheet().raw(field.id), re.M)
        if field.kind == "number":
            offered = np.linspace(field.low, field.high, 7)

        def wrong(given, judge=statement.judge, id=field.id):
            right, _ = judge(found.data, found.answers | {id: given})
            return not right(given)

        found.answers[field.id] = next(filter(wrong, offered))
        answer(place, {field.id: found.answers[field.id]})


def cells(lab):
    """The condition of each cell of the table."""
    return [c.name for c in lab.conditions for column in lab.columns if column.only(c.name)]


def without(lab, condition, evidence):
    """The points that are left where a condition lacks a run; evidence: for the other runs."""
    most, all_cells = len(lab.conditions), cells(lab)
    kept = sum(name != condition for name in all_cells)
    return FULL | {
        "runs": round(evidence + 10 * (most - 1) / most, 1),
        "measurements": round(10 + 15 * kept / len(all_cells), 1),
        "conclusion": sum(s.points for s in lab.statements if condition not in s.needs),
    }


@each_lab
@pytest.mark.parametrize("spoil", SPOILED, ids=lambda spoil: spoil.__name__)
def test_a_wrong_sheet_loses_exactly_what_it_should(number, spoil, students, tmp_path):
    place, other = students(number)[:2]
    place = copied(place, tmp_path)
    if spoil is runs_of_another_renamed:
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


@pytest.mark.parametrize("number", [6, 9])
def test_a_curve_that_was_drawn_by_hand_is_found_when_its_run_is_drawn(number, students, tmp_path):
    """Of the tool's algorithm; of the student's strategy."""
    place = all_redone(copied(students(number)[0], tmp_path))
    assert points(place) == FULL
    left = drawn_by_hand(place, column=4)
    found, told = checked(place)
    assert found["runs"] == left, told


def test_stopped_runs_go_on_and_are_the_same(students, tmp_path):
    done = students(3)[0]
    place = predicted(small(3), tmp_path, "Ada", **student(3).HONEST[0][1])
    folder = place.runs / "Pendulum 4"
    shutil.copytree(done.runs, place.runs)
    before = {file.name: file.read_bytes() for file in folder.glob("*.npy")}
    for file in sorted(folder.glob("*S*")):
        shutil.rmtree(file) if file.is_dir() else file.unlink()
    assert make_runs(place.lab, place.sheet(), place.runs, 1, place.lab.replications)
    assert {file.name: file.read_bytes() for file in folder.glob("*.npy")} == before
    conclude(place)
    assert points(place) == FULL


@pytest.mark.parametrize("number", [8, 9])
def test_a_strategy_that_changed_after_the_runs_costs_its_runs(number, students, tmp_path):
    place = all_redone(copied(students(number)[0], tmp_path))
    path = place.folder / "strategy.py"
    path.write_text(path.read_text().replace("default_rng(seed)", "default_rng(seed + 1)"))
    found, told = checked(place)
    expected = FULL | {"runs": 5, "measurements": 17.5, "figure": 0, "conclusion": 5}
    assert found == (expected if number == 8 else NOTHING), told
    assert "strategy.py" in told


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
    assert "long evolution: 9999 is far from" in told
