"""Laboratories: honest sheets get all points, each wrong one loses exactly what it should."""

import re
import shutil
from dataclasses import replace

import numpy as np
import pytest

from botschool.labs.check import Check
from botschool.labs.declare import NUMBERS, PARTS
from botschool.labs.runs import make_runs, own_runs
from botschool.labs.sheet import base_seed
from lab_students import answer, conclude, copied, edit, honest, predicted, small, student

pytestmark = pytest.mark.course
FULL = {name: float(most) for name, most in PARTS.items()}


def points(place):
    """The points of each part."""
    return {part.name: part.points for part in Check(place).all().parts}


def messages(place):
    return " ".join(m for part in Check(place).all().parts for m in part.messages)


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """Ada's laboratory 9."""
    return honest(small(9), tmp_path_factory.mktemp("ada"))


@pytest.fixture
def spoiled(done, tmp_path):
    """A copy of hers, to spoil."""
    return copied(done, tmp_path)


@pytest.mark.parametrize("number", NUMBERS)
def test_three_honest_sheets_with_different_outcomes_get_all_points(number, tmp_path):
    outcomes = set()
    for name, predictions in student(number).HONEST:
        lab = small(number, replications=5)
        place = honest(lab, tmp_path / name, name, **predictions)
        checked = Check(place).all()
        assert {part.name: part.points for part in checked.parts} == FULL, messages(place)
        assert checked.picture.startswith(b"\x89PNG")
        ids = [statement.field for statement in lab.statements]
        outcomes.add(tuple(checked.answers[id] for id in ids))
    assert len(outcomes) == 3


@pytest.mark.parametrize("number", NUMBERS)
def test_an_empty_sheet_gets_nothing(number, tmp_path):
    from botschool.labs.folder import Place, start

    place = Place(small(number), tmp_path / f"lab{number:02}")
    start(place, "Ada", "botschool")
    assert set(points(place).values()) == {0}


def test_numbers_without_runs_get_nothing(spoiled):
    shutil.rmtree(spoiled.runs)
    assert set(points(spoiled).values()) == {0}
    assert "There are no runs yet" in messages(spoiled)


def test_an_invented_number_costs_its_cell(spoiled):
    edit(spoiled, lambda text: re.sub(r"^\| bonus 1 \| [^|]*", "| bonus 1 | 99 ", text, flags=re.M))
    assert points(spoiled) == FULL | {"measurements": round(10 + 15 * 20 / 21, 1)}
    assert "The table, bonus 1, median metres: your runs give" in messages(spoiled)


def test_runs_of_somebody_else_get_nothing(spoiled, tmp_path):
    other = honest(small(9), tmp_path / "bo", "Bo")
    shutil.rmtree(spoiled.runs)
    shutil.copytree(other.runs, spoiled.runs)
    assert set(points(spoiled).values()) == {0}
    assert "belong to another name" in messages(spoiled)


def test_runs_of_somebody_else_under_own_seeds_get_nothing(spoiled, tmp_path):
    other = honest(small(9), tmp_path / "bo", "Bo")
    mine, his = (base_seed(each.sheet(), each.lab) for each in (spoiled, other))
    shutil.rmtree(spoiled.runs)
    for path in other.runs.glob("*/*.npy"):
        name, seed = re.fullmatch(r"(\D+)(\d+)\.npy", path.name).groups()
        place = spoiled.runs / path.parent.name
        place.mkdir(parents=True, exist_ok=True)
        shutil.copy(path, place / f"{name}{int(seed) - his + mine}.npy")
    assert sum(map(len, own_runs(spoiled.lab, spoiled.sheet(), spoiled.runs).values())) == 28
    assert set(points(spoiled).values()) == {0}
    assert "gives other files" in messages(spoiled)


def test_an_edited_genotype_costs_the_evidence_and_what_rests_on_the_run(spoiled):
    file = next((spoiled.runs / "bonus 1").glob("bestgS*.npy"))
    genotype = np.load(file)
    genotype[0] += 0.5
    np.save(file, genotype)
    assert points(spoiled) == FULL | {
        "runs": round(10 * 6 / 7, 1),
        "measurements": round(10 + 15 * 18 / 21, 1),
        "conclusion": 9,
    }


def test_a_curve_that_was_drawn_by_hand_is_found_when_its_run_is_made_again(spoiled):
    spoiled = type(spoiled)(
        small(9).__class__(**vars(spoiled.lab) | {"redone": 28}), spoiled.folder
    )
    file = next((spoiled.runs / "bonus 1").glob("statS*.npy"))
    stat = np.load(file)
    stat[4] += 1
    np.save(file, stat)
    assert points(spoiled)["runs"] == round(10 * 6 / 7, 1)


def test_too_few_replications_cost_their_condition(spoiled):
    next((spoiled.runs / "bonus 1").glob("statS*.npy")).unlink()
    assert points(spoiled) == FULL | {
        "runs": round(15 + 10 * 6 / 7, 1),
        "measurements": round(10 + 15 * 18 / 21, 1),
        "conclusion": 9,
    }
    assert "bonus 1 has 3" in messages(spoiled)


def test_a_prediction_that_changed_afterwards_has_no_runs(spoiled):
    answer(spoiled, {"tipping": 0.5})
    assert set(points(spoiled).values()) == {0}
    assert "The prediction has changed since the runs were made" in messages(spoiled)


def test_a_conclusion_against_its_own_data_costs_its_points(spoiled):
    right = Check(spoiled).all().answers["further"]
    wrong = next(each for each in ("bonus 0", "bonus 2") if each != right)
    answer(spoiled, {"further": wrong})
    assert points(spoiled) == FULL | {"conclusion": 20}
    assert "permutation test" in messages(spoiled)


def test_a_tipping_point_that_is_not_marked_costs_three_points(spoiled):
    spoiled = type(spoiled)(
        replace(spoiled.lab, figure=replace(spoiled.lab.figure, mark=lambda data: 0.7)),
        spoiled.folder,
    )
    assert points(spoiled) == FULL | {"figure": 7}
    path = spoiled.folder / "figure.py"
    path.write_text(path.read_text().replace("return pic", "axes.axvline(0.7)\n    return pic"))
    assert points(spoiled) == FULL


def test_a_figure_of_means_costs_the_figure(spoiled):
    path = spoiled.folder / "figure.py"
    runs = '[x] * len(values["metres"]), values["metres"]'
    path.write_text(path.read_text().replace(runs, 'x, values["metres"].mean()'))
    assert points(spoiled) == FULL | {"figure": 0}
    assert "not their means" in messages(spoiled)


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
    assert points(spoiled) == FULL | {"measurements": 15}
    assert says in messages(spoiled)


def test_stopped_runs_go_on_and_are_the_same(done, tmp_path):
    place = predicted(small(9), tmp_path)
    folder = place.runs / "bonus 0"
    shutil.copytree(done.runs, place.runs)
    files = sorted(folder.glob("*S*"))
    before = {file.name: file.read_bytes() for file in folder.glob("*.npy")}
    for file in files:
        shutil.rmtree(file) if file.is_dir() else file.unlink()
    assert make_runs(place.lab, place.sheet(), place.runs, 1, place.lab.replications)
    assert {file.name: file.read_bytes() for file in folder.glob("*.npy")} == before
    conclude(place)
    assert points(place) == FULL


def test_a_strategy_that_changed_after_the_runs_costs_its_runs(tmp_path):
    place = honest(small(8, replications=2), tmp_path)
    place = type(place)(replace(place.lab, redone=12), place.folder)
    assert points(place) == FULL, messages(place)
    path = place.folder / "strategy.py"
    path.write_text(path.read_text().replace("default_rng(seed)", "default_rng(seed + 1)"))
    assert points(place) == FULL | {"runs": 5, "measurements": 17.5, "figure": 0, "conclusion": 5}
    assert "strategy.py" in messages(place)


# --- what each laboratory takes off, as its declaration says
@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    """A function that gives a finished laboratory, made once."""
    made = {}

    def of(number):
        if number not in made:
            made[number] = honest(small(number), tmp_path_factory.mktemp("finished"))
        return made[number]

    return of


def without(lab, condition, evidence):
    """The points that are left where a condition has a run too few; evidence: for the others."""
    most = len(lab.conditions)
    cells = [
        (c.name, column) for c in lab.conditions for column in lab.columns if column.only(c.name)
    ]
    kept = sum(name != condition for name, _ in cells)
    return FULL | {
        "runs": round(evidence + 10 * (most - 1) / most, 1),
        "measurements": round(10 + 15 * kept / len(cells), 1),
        "conclusion": sum(s.points for s in lab.statements if condition not in s.needs),
    }


def with_other_genotype(place):
    """A robot exchanged, in the first run of the last condition."""
    name = place.lab.conditions[-1].name
    file = next((place.runs / name).glob("bestgS*.npy"))
    genotype = np.load(file)
    genotype[: len(genotype) // 2] = 0
    np.save(file, genotype)
    return without(place.lab, name, 0)


def with_a_run_too_few(place):
    name = place.lab.conditions[-1].name
    next((place.runs / name).glob("statS*.npy")).unlink()
    return without(place.lab, name, 15)


def with_another_prediction(place):
    answer(place, {"why": "I knew it before because somebody has told me the result of it all."})
    return dict.fromkeys(FULL, 0)


def with_an_invented_number(place):
    name = place.lab.conditions[-1].name
    row = rf"^(\| {re.escape(name)} \| )[^|]*"
    edit(place, lambda text: re.sub(row, r"\g<1>-77777 ", text, flags=re.M))
    cells = sum(col.only(c.name) for c in place.lab.conditions for col in place.lab.columns)
    return FULL | {"measurements": round(10 + 15 * (cells - 1) / cells, 1)}


def with_a_conclusion_against_its_data(place):
    """The first choice says what the student's own data do not support."""
    checked, lab = Check(place).all(), place.lab
    kinds = {field.id: field.kind for field in lab.fields}
    statement = next(s for s in lab.statements if kinds[s.field] == "choice")
    right, _ = statement.judge(checked.data, checked.answers)
    labels = re.findall(r"\[.\] (.+?)(?=   |$)", place.sheet().raw(statement.field), re.M)
    answer(place, {statement.field: next(label for label in labels if not right(label))})
    return FULL | {"conclusion": 25 - statement.points}


@pytest.mark.parametrize("number", [12, 14, 15])
@pytest.mark.parametrize(
    "spoil",
    [
        with_other_genotype,
        with_a_run_too_few,
        with_another_prediction,
        with_an_invented_number,
        with_a_conclusion_against_its_data,
    ],
)
def test_a_wrong_sheet_loses_exactly_what_it_should(finished, tmp_path, number, spoil):
    place = copied(finished(number), tmp_path)
    expected = spoil(place)
    assert points(place) == expected, messages(place)


def test_runs_of_other_rules_than_the_students_are_not_his(finished, tmp_path):
    place = copied(finished(12), tmp_path)
    path = place.folder / "learn.py"
    path.write_text(path.read_text().replace(">= bound", "> bound"))
    place = replace(place, lab=replace(place.lab, redone=16))
    assert points(place)["runs"] == 2.5
    assert "it comes out differently" in messages(place)
