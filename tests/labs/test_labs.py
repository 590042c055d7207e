"""Laboratories: sheets, seeds, refusals, and the pay for standing of planar runners."""

import importlib
import json
import os
import re
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from botschool import problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.evolution.record import RunFiles
from botschool.grading.packed import pack_module
from botschool.labs import measuring
from botschool.labs.check import Check
from botschool.labs.commands import lead_to, run_command
from botschool.labs.confined import drawn_figure, student_file
from botschool.labs.declare import NUMBERS, PARTS, WORDS, Field, load_lab
from botschool.labs.folder import Place, skeletons, start
from botschool.labs.measuring import _row, interval, paired_test, permutation_test
from botschool.labs.report import _inline, write_report
from botschool.labs.runs import changed, make_runs
from botschool.labs.saved import stat_of
from botschool.labs.sheet import Sheet, Unreadable, base_seed, numbers_in, seeds_of
from botschool.problems import Episodes
from lab_answers import WHY
from lab_students import answer, edit, fill, predicted, small, student
from running import call

ROOT = Path(__file__).parents[2]
NUMBER = Field("a", "number", "The number", 0, 5)


def sheet(text):
    return Sheet("\n".join(text.splitlines()))


@pytest.mark.parametrize("number", NUMBERS)
def test_points_add_up_and_sheets_have_every_field(number, tmp_path):
    lab = load_lab(number)
    assert sum(PARTS.values()) + WORDS == 100
    assert sum(statement.points for statement in lab.statements) == PARTS["conclusion"]
    start(Place(lab, tmp_path), "Ada", "botschool")
    read = Sheet.read(tmp_path / "sheet.md")
    found, missing = read.values(lab.predictions + lab.fields)
    assert not found and len(missing) == len(lab.predictions + lab.fields)
    for condition in lab.conditions:
        assert len(read.row(condition.name)) == len(lab.columns)
    assert f"| | {' | '.join(column.title for column in lab.columns)} |" in read.text
    assert lab.title.endswith("?")


@pytest.mark.parametrize("number", NUMBERS)
def test_sheets_teach_how_to_measure_and_end_with_an_open_question(number):
    files = skeletons(load_lab(number))
    sheet, script = files["sheet.md"], files["measure.py"]
    last = sheet[sheet.rindex("\n## ") :]
    assert last.startswith("\n## An open question") and "No points: " in last and "?" in last
    assert "<!-- field:" not in last
    assert "interval(" in script
    assert "p =" in script or "permutation test" in sheet
    assert "a point" in sheet[sheet.index("## Figure") : sheet.index("## Conclusion")]
    enough = {4: "How many episodes does it take", 9: "Are ten runs enough"}
    assert enough.get(number, "`power") in sheet
    assert number in enough or "power(" in script


@pytest.mark.parametrize("number", NUMBERS)
def test_the_exercises_text_leads_to_its_laboratory(number):
    (text,) = ROOT.glob(f"exercises/ex{number:02}_*/README.md")
    assert f"botschool lab {number} start" in text.read_text(encoding="utf-8")


@pytest.mark.parametrize("number", [1, 3, 10, 14])
def test_show_leads_to_a_laboratory_where_there_is_one(number, capsys):
    lead_to(number)
    named = f"botschool lab {number} start" in capsys.readouterr().out
    assert named == (number in NUMBERS) == (number in (3, 14))


@pytest.mark.parametrize("ends", ["\n", "\r\n"])
@pytest.mark.parametrize("given", ["answer: 1.5", "answer:1.5 ", "Answer: 1.5"])
def test_a_number_is_read_however_it_is_typed(given, ends):
    assert sheet(f"How many? <!-- field: a --> {given}{ends}{ends}more").value(NUMBER) == 1.5


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ("answer:", "empty"),
        ("answer: 1,5", "point instead of the comma"),
        ("answer: 7", "out of range"),
        ("answer: much", "cannot be read"),
        ("answer: 1 2", "cannot be read"),
    ],
)
def test_what_is_no_number_is_said(given, says):
    with pytest.raises(Unreadable, match=says):
        sheet(f"<!-- field: a --> {given}").value(NUMBER)
    with pytest.raises(Unreadable, match=r"is not in sheet\.md"):
        sheet(given).value(NUMBER)


def test_choices_texts_and_intervals_are_read():
    choice, text = Field("c", "choice", "The choice"), Field("t", "text", "The text", words=3)
    read = sheet("<!-- field: c -->\n[ ] left   [X] right\n<!-- field: t -->\n> one two\n> three\n")
    assert read.value(choice) == "right"
    assert read.value(text) == "one two three"
    with pytest.raises(Unreadable, match="more than one box"):
        sheet("<!-- field: c --> [x] left [x] right").value(choice)
    with pytest.raises(Unreadable, match="at least 3 words"):
        sheet("<!-- field: t -->\n> one two").value(text)
    assert numbers_in("-1.5 to -0.5", "it", 2) == (-1.5, -0.5)
    assert numbers_in("[2; 3]", "it", 2) == (2, 3)


def test_seeds_follow_from_name_course_and_prediction_alone(tmp_path):
    place = predicted(small(9), tmp_path)
    seed = base_seed(place.sheet(), place.lab)
    text = (place.folder / "sheet.md").read_text()
    crlf = text.replace("[x]", "[X]").replace("\n", "  \r\n")
    (place.folder / "sheet.md").write_bytes(crlf.encode())
    assert base_seed(place.sheet(), place.lab) == seed
    for id, value in (("observed", 1), ("name", "ADA"), ("rule", 3)):
        assert base_seed(sheet(fill(text, id, value)), place.lab) == seed
    for id, value in (("name", "Bo"), ("course", "B"), ("tipping", 2), ("why", WHY + " So.")):
        assert base_seed(sheet(fill(text, id, value)), place.lab) != seed
    seeds = [each for some in seeds_of(place.sheet(), place.lab).values() for each in some]
    assert len(set(seeds)) == len(seeds) == 35


@pytest.mark.parametrize("number", NUMBERS)
def test_run_refuses_before_the_prediction_is_specific(number, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(BotschoolError, match=f"lab {number} start makes it"):
        run_command(str(number), False, 1)
    place = Place.of(number)
    start(place, "Ada", "botschool")
    for id, value in student(number).PREDICTIONS.items():
        with pytest.raises(BotschoolError, match="Write your prediction first"):
            run_command(str(number), False, 1)
        answer(place, {id: value})
    edit(place, lambda text: fill(text, "name", ""))
    with pytest.raises(BotschoolError, match="Write your name first"):
        run_command(str(number), False, 1)
    assert not place.runs.exists()


def test_a_run_needs_the_strategy_of_the_exercise(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    place = predicted(small(9), tmp_path)
    (place.folder / "strategy.py").write_text("")
    with pytest.raises(BotschoolError, match=r"copy your finished openai_es\.py of exercise 8"):
        run_command("9", False, 1)
    assert not place.runs.exists()


def test_runs_of_another_prediction_are_not_mixed_in(tmp_path):
    place = predicted(small(9), tmp_path)
    place.runs.mkdir()
    now = place.sheet().prediction
    before = now.replace("answer: 0.06", "answer: 0.08")
    (place.runs / "runs.json").write_text(json.dumps({"seed": 5, "prediction": before}))
    with pytest.raises(
        BotschoolError, match=r"has changed .* '\.\.\. .*answer: 0\.08 .*To start anew"
    ):
        make_runs(place.lab, place.sheet(), place.runs, 1, 1)


def test_nothing_is_read_through_links_and_pipes(tmp_path):
    lab, precious = load_lab(9), tmp_path / "precious"
    precious.write_text("of somebody else")
    for make in (lambda path: path.symlink_to(precious), os.mkfifo):
        folder = tmp_path / make.__name__ / lab.name
        folder.mkdir(parents=True)
        make(folder / "sheet.md")
        with pytest.raises(BotschoolError, match=r"no link|There is no"):
            Place(lab, folder).sheet()
        first = lab.conditions[0]
        files = RunFiles(folder / "runs" / first.name, 7)
        files.stat.parent.mkdir(parents=True)
        make(files.stat)
        make(folder / "runs" / "runs.json")
        assert stat_of(files.stat) is None
        assert changed(lab, sheet("## Prediction"), folder / "runs") == ""


FIGURE_OF_NAMES = """
from matplotlib.figure import Figure


def figure(measurements):
    picture = Figure()
    axes = picture.subplots()
    for name, values in measurements.items():
        axes.plot([name] * 2, values["y"], "o")
    axes.axvline("late")
    return picture
"""


def test_a_figure_may_have_names_on_its_horizontal_axis(tmp_path):
    (tmp_path / "figure.py").write_text(FIGURE_OF_NAMES)
    two = {"early": {"y": np.array([1.0, 2.0])}, "late": {"y": np.array([3.0, 4.0])}}
    with student_file(tmp_path / "figure.py") as file:
        drawn = drawn_figure(file, two)
    assert drawn["points"].tolist() == [[0, 1], [0, 2], [1, 3], [1, 4]]
    assert drawn["verticals"].tolist() == [1]


def test_all_runs_beside_measure_are_measured(tmp_path, monkeypatch):
    place = predicted(small(3), tmp_path)
    with pytest.raises(BotschoolError, match="CartPole 4 has no runs yet: botschool lab 3 run"):
        measuring.load_runs(place.folder)
    (place.folder / "measure.py").write_text("def measure(run):\n    return {'twice': 2 * run}\n")
    monkeypatch.syspath_prepend(str(place.folder))
    module = importlib.import_module("measure")
    monkeypatch.delitem(sys.modules, "measure")
    folders = []
    monkeypatch.setattr(
        measuring, "load_runs", lambda folder: folders.append(folder) or {"early": [1, 2]}
    )
    assert measuring.measure_all(module.measure)["early"]["twice"].tolist() == [2, 4]
    assert folders == [place.folder]


def test_what_is_empty_is_said_once(tmp_path):
    place = Place(small(7), tmp_path / "lab07")
    start(place, "Ada", "botschool")
    check = Check(place)
    check.all()
    assert len(check.parts["conclusion"].messages) == 1
    check.runs = {condition.name: [object()] for condition in place.lab.conditions}
    check.lab = replace(check.lab, replications=1)
    check.parts["measurements"].messages.clear()
    check._table()
    assert check.parts["measurements"].messages == [
        "The table is empty: python measure.py prints its rows."
    ]


def test_the_command_starts_and_names_what_exists(tmp_path):
    code, _, error = call("lab", "1", "start", cwd=tmp_path)
    assert code == 2 and "There is no laboratory 1: the laboratories that exist are 3" in error
    code, out, _ = call("lab", "9", "start", "--name", "Ada", cwd=tmp_path)
    assert code == 0 and "write your prediction" in out
    assert call("lab", "3", "start", cwd=tmp_path)[0] == 0
    assert "answer: Ada" in (tmp_path / "lab03" / "sheet.md").read_text()
    code, out, _ = call("lab", "9", "check", cwd=tmp_path)
    assert code == 1 and "0 of 90 points" in out
    assert call("lab", "9", "dance", cwd=tmp_path)[0] == 2


def test_one_rule_for_all_robots_is_refused():
    separate = load_lab(9).separate
    far, near = {"metres": 20.0, "statue": 0.0}, {"metres": 1.0, "statue": 1.0}
    assert separate([far, near]) == ""
    assert "the same" in separate([far | {"statue": 1.0}, near])


def test_a_report_begins_with_prediction_and_findings_and_repeats_no_instruction(tmp_path):
    """Answers and code are escaped; the table is the student's own, with its intervals."""
    assert call("lab", "3", "start", "--name", "Ada <b>", cwd=tmp_path)[0] == 0
    place = Place.of(3, tmp_path)
    sheet = place.folder / "sheet.md"
    text = sheet.read_text().replace(
        "| CartPole 20 | | | | |", "| CartPole 20 | 9 | 100 | 499 | 498 to 500 |"
    )
    for line in ("[ ] 4   [ ] 20   [ ] 100   [ ] no difference",):
        text = text.replace(line, line.replace("[ ] 20", "[x] 20"))
    text = text.replace(
        "<!-- field: p-cartpole --> answer:", "<!-- field: p-cartpole --> answer: 0.5"
    )
    sheet.write_text(text)
    checked = Check(place).all()
    page = write_report(place, checked, tmp_path).read_text()
    order = ["You predicted", "Which population solves CartPole first", "You found", "0.5",
             "498 to 500", "Points"]  # fmt: skip
    assert [page.index(each) for each in order] == sorted(page.index(each) for each in order)
    assert "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src" in page
    assert "Ada &lt;b&gt;" in page and '<b class="answer">20</b>' in page
    assert "Write it before you run" not in page and "measure(run)" not in page.split("Points")[0]
    assert "<code>a &lt; b</code> is <em>it</em>" in _inline("`a < b` is *it*")


def test_a_sheet_says_all_that_decides_its_runs(tmp_path):
    for number in NUMBERS:
        lab = load_lab(number)
        sheet = skeletons(lab)["sheet.md"]
        for condition in lab.conditions:
            for section, named in condition.experiment.items():
                for name, value in named.items() if isinstance(named, dict) else ():
                    if name == "maxmsteps" and condition.generations:
                        name, value = "generations", condition.generations
                    row = re.search(
                        rf"^\| \[{section.upper()}\] \| `{name}` \| (.*) \|$", sheet, re.MULTILINE
                    )
                    assert row and str(value).strip("[]") in row[1], (number, name)
        if any("post-evaluated" in line for line in sheet.split("## Measurements")[1].split("\n")):
            assert "*post-evaluated*" in sheet


def test_a_list_where_one_number_belongs_is_refused():
    """In measure_all, and of pairs: lists of other lengths would be stretched silently."""
    assert _row({"fresh": 1.0}, "late") == {"fresh": 1.0}
    for wrong in ([1.0, 2.0], np.zeros(100), [1.0], []):
        with pytest.raises(BotschoolError, match=r"of late returns \d+ numbers .* 'fresh'"):
            _row({"fresh": wrong}, "late")
    with pytest.raises(BotschoolError, match="dict of numbers"):
        _row([1.0], "late")
    for other in (np.zeros(9), np.zeros(1), 0.0):
        with pytest.raises(BotschoolError, match="the same runs, not 10 and"):
            paired_test(np.zeros(10), other)


def test_statistics():
    rng = np.random.default_rng(3)
    one, other = rng.normal(0, 1, 10), rng.normal(3, 1, 10)
    assert permutation_test(one, other) < 0.001 < 0.2 < permutation_test(one, one[::-1])
    low, high = interval(one)
    assert low < np.median(one) < high


def test_a_packed_reference_measures_the_same():
    space = {"__file__": "reference.py", "__name__": "reference"}
    source = "def reference(run, answers):\n    return {'metres': 2 * run}\n"
    packed = pack_module(source)
    assert "metres" not in packed
    exec(packed, space)
    assert space["reference"](4, {}) == {"metres": 8}


def returns(options, name="PlanarHopper-v5", genotype=None):
    problem = problems.make(name, options=options)
    policy = problem.policy(PolicyConfig(nhiddens=5, maxsteps=60))
    genotype = policy.initial(3) if genotype is None else genotype
    batch = Episodes.of(np.array([7], dtype=np.uint64), 3)
    outcome = problem.evaluate(policy, genotype[None], None, batch, 60)
    played = [list(problem.play(policy, genotype, None, 7, k, 60)) for k in range(3)]
    return outcome, played


def test_the_pay_for_standing_is_paid_for_each_step_without_a_fall():
    plain, _ = returns("")
    paid, played = returns("alive=0.5")
    standing = plain.steps - (plain.steps < 60)
    assert (paid.steps == plain.steps).all()
    assert np.array_equal(paid.fitness, plain.fitness + 0.5 * standing)
    assert np.allclose([each[-1].total for each in played], paid.fitness)


def test_version_0_pays_the_same_beside_the_effort():
    one, zero = returns("alive=1")[1], returns("", "PlanarHopper-v0")[1]
    for ours, theirs in zip(one, zero, strict=True):
        for a, b in zip(ours, theirs, strict=True):
            effort = 0.001 * (np.clip(a.action, -1, 1) ** 2).sum()
            assert a.reward == pytest.approx(b.reward + effort, abs=1e-5)


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("CartPole-v1", "alive=1", "CartPole-v1 takes no options"),
        ("PlanarHopper-v5", "bonus=1", "has no option .bonus.: known are alive"),
        ("PlanarHopper-v5", "alive='x'", "a number from -100 to 100"),
        ("PlanarHopper-v5", "alive=1e9", "a number from -100 to 100"),
    ],
)
def test_other_options_are_refused(name, options, says):
    with pytest.raises(BotschoolError, match=says):
        problems.make(name, options=options)
