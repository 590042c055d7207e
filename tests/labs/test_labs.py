"""Laboratories: sheets, seeds, refusals, reports, statistics."""

import json
import os
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.evolution.record import RunFiles
from botschool.labs.check import Check
from botschool.labs.commands import lead_to, run_command
from botschool.labs.declare import NUMBERS, PARTS, WORDS, load_lab
from botschool.labs.fields import Field
from botschool.labs.folder import Place, skeletons, start
from botschool.labs.measuring import interval, load_runs, paired_test, permutation_test
from botschool.labs.report import write_report
from botschool.labs.runs import changed, make_runs
from botschool.labs.saved import stat_of
from botschool.labs.sheet import Sheet, Unreadable, base_seed, numbers_in, seeds_of
from lab_students import WHY, answer, edit, fill, guesses, predicted, small

ROOT = Path(__file__).parents[2]
NUMBER = Field("a", "number", "How many?", False)


def sheet(text):
    return Sheet("\n".join(text.splitlines()))


@pytest.mark.parametrize("number", NUMBERS)
def test_a_laboratory_is_complete(number, tmp_path):
    """Points add up; the sheet has every field and row, teaches to measure, and ends openly."""
    lab, files = load_lab(number), skeletons(load_lab(number))
    assert sum(PARTS.values()) + WORDS == 100 and lab.title.endswith("?")
    assert sum(s.points for s in lab.statements.values()) == PARTS["conclusion"]
    assert {*lab.statements} <= {id for id, field in lab.fields.items() if not field.predicts}
    start(Place(lab, tmp_path), "Ada", "botschool")
    read = Sheet.read(tmp_path / "sheet.md")
    found, missing = read.values(lab.fields.values())
    assert not found and len(missing) == len(lab.fields) > len(lab.statements)
    for field, said in zip(lab.fields.values(), missing, strict=True):
        assert field.what[-1] in "?.:)" and said.startswith(field.what)
    for condition in lab.conditions:
        assert len(read.row(condition.name)) == len(lab.columns) == len(lab.titles)
    text, script = files["sheet.md"], files["measure.py"]
    last = text[text.rindex("\n## ") :]
    assert last.startswith("\n## An open question") and "No points: " in last and "?" in last
    assert "<!-- field:" not in last and "interval(" in script
    assert "p =" in script or "permutation test" in text
    assert "a point" in text[text.index("## Figure") : text.index("## Conclusion")]
    (exercise,) = ROOT.glob(f"exercises/ex{number:02}_*/README.md")
    assert f"botschool lab {number} start" in exercise.read_text(encoding="utf-8")


@pytest.mark.parametrize("number", NUMBERS)
def test_a_sheet_says_all_that_decides_its_runs(number):
    lab = load_lab(number)
    rows = dict(re.findall(r"^\| (\[\w+\] \| `\w+`) \| (.*) \|$", skeletons(lab)["sheet.md"], re.M))
    for condition in lab.conditions:
        for section, named in condition.experiment.items():
            for name, value in named.items() if isinstance(named, dict) else ():
                if name == "maxmsteps" and condition.generations:
                    name, value = "generations", condition.generations
                said, value = rows[f"[{section.upper()}] | `{name}`"], str(value).strip("[]")
                assert re.search(rf"(^|; ){re.escape(value)}( \(|;| in|$)", said), (name, said)


@pytest.mark.parametrize("number", [1, 3, 10, 14])
def test_show_leads_to_a_laboratory_where_there_is_one(number, capsys):
    lead_to(number)
    named = f"botschool lab {number} start" in capsys.readouterr().out
    assert named == (number in NUMBERS) == (number in (3, 14))


@pytest.mark.parametrize("given", ["answer: 1.5\r\n", "answer:1.5 \n", "Answer: 1.5\n"])
def test_a_number_is_read_however_it_is_typed(given):
    assert sheet(f"How many? <!-- field: a --> {given}\nmore").value(NUMBER) == 1.5


ODD = {
    "": "empty",
    "1,5": "a point instead of the comma",
    "much": "cannot be read",
    "1 2": "cannot be read",
    "1" * 5000: "cannot be read",
    "1." * 3000: "cannot be read",
    "-" * 5000: "cannot be read",
    "1e9" * 2000: "cannot be read",
    "1e999": "cannot be read",
}


@pytest.mark.parametrize("given", ODD, ids=lambda given: given[:9])
def test_what_is_no_number_is_said(given):
    with pytest.raises(Unreadable, match=rf"^How many\? .*{ODD[given]}.{{0,99}}$"):
        sheet(f"<!-- field: a --> answer: {given}").value(NUMBER)
    with pytest.raises(Unreadable, match=r"is not in sheet\.md"):
        sheet(given).value(NUMBER)


def test_choices_texts_and_intervals_are_read():
    choice, text = (Field(kind, kind, "What?", False) for kind in ("choice", "text"))
    read = sheet("<!-- field: choice -->\n[ ] left   [X] right\n<!-- field: text -->\n> one\n> two")
    assert read.value(choice) == "right"
    with pytest.raises(Unreadable, match="at least 10 words"):
        read.value(text)
    assert sheet(f"<!-- field: text -->\n> {WHY[:40]}\n> {WHY[40:]}").value(text).endswith("on.")
    with pytest.raises(Unreadable, match="more than one box"):
        sheet("<!-- field: choice --> [x] left [x] right").value(choice)
    assert numbers_in("-1.5 to -0.5", "it", 2) == (-1.5, -0.5)
    assert numbers_in("[2; 3]", "it", 2) == (2, 3)


def test_a_comment_that_does_not_end_stays_in_the_prediction():
    """As before: seeds follow from it."""
    text = "## Prediction\na <!-- x\n --> b <!-- <!-- y --> c <!-- z <!---> d --> e <!-- f\n"
    assert Sheet(text).prediction == "a b c d --> e <!-- f"


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


def test_seeds_are_those_of_earlier_versions():
    """Runs that students have made stay theirs."""
    text = "<!-- field: name --> answer: Ada\n<!-- field: course --> answer: C 1\n## Prediction\nX"
    assert base_seed(sheet(text), load_lab(3)) == SEED_OF_ADA


SEED_OF_ADA = 704372868


def test_run_refuses_before_the_prediction_is_specific(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(BotschoolError, match="lab 9 start makes it"):
        run_command("9", False, 1)
    place = Place.of(9)
    start(place, "Ada", "botschool")
    for id, value in guesses(place).items():
        with pytest.raises(BotschoolError, match="Write your prediction first"):
            run_command("9", False, 1)
        answer(place, {id: value})
    (place.folder / "strategy.py").write_text("")
    with pytest.raises(BotschoolError, match=r"copy your finished openai_es\.py of exercise 8"):
        run_command("9", False, 1)
    edit(place, lambda text: fill(text, "name", ""))
    with pytest.raises(BotschoolError, match="Write your name first"):
        run_command("9", False, 1)
    assert not place.runs.exists()


def test_runs_of_another_prediction_are_not_mixed_in(tmp_path):
    place = predicted(small(9), tmp_path)
    place.runs.mkdir()
    before = place.sheet().prediction.replace("answer: 0", "answer: 0.08")
    (place.runs / "runs.json").write_text(json.dumps({"seed": 5, "prediction": before}))
    with pytest.raises(
        BotschoolError, match=r"has changed .* '\.\.\. .*answer: 0\.08 .*To start anew"
    ):
        make_runs(place.lab, place.sheet(), place.runs, 1, 1)
    with pytest.raises(BotschoolError, match="bonus 0 has no runs yet: botschool lab 9 run"):
        load_runs(place.folder)


def test_nothing_is_read_through_links_and_pipes(tmp_path):
    lab, precious = load_lab(9), tmp_path / "precious"
    precious.write_text("of somebody else")
    for make in (lambda path: path.symlink_to(precious), os.mkfifo):
        folder = tmp_path / make.__name__ / lab.name
        folder.mkdir(parents=True)
        make(folder / "sheet.md")
        with pytest.raises(BotschoolError, match=r"no link|There is no"):
            Place(lab, folder).sheet()
        files = RunFiles(folder / "runs" / lab.conditions[0].name, 7)
        files.stat.parent.mkdir(parents=True)
        make(files.stat)
        make(folder / "runs" / "runs.json")
        assert stat_of(files.stat) is None
        assert changed(lab, sheet("## Prediction"), folder / "runs") == ""


def test_what_is_empty_is_said_once(tmp_path):
    place = Place(replace(small(7), replications=1), tmp_path / "lab07")
    start(place, "Ada", "botschool")
    assert len(Check(place).all().parts["conclusion"].messages) == 1


def test_the_command_starts_grades_and_names_what_exists(command, tmp_path, monkeypatch):
    """`lab N ACTION` and the commands of exercises do the same."""
    monkeypatch.chdir(tmp_path)
    code, _, error = command("lab", "1", "start")
    assert code == 2 and "There is no laboratory 1: the laboratories that exist are 3" in error
    code, out, _ = command("start", "lab9", "--name", "Ada")
    assert code == 0 and "write your prediction" in out
    assert command("lab", "3", "start")[0] == 0
    assert "answer: Ada" in (tmp_path / "lab03" / "sheet.md").read_text()
    for words in (("lab", "9", "check"), ("lab", "9"), ("grade", "lab9")):
        code, out, _ = command(*words)
        assert code == 1 and "0 of 90 points" in out
    code, out, _ = command("grade", "lab9", "--json")
    tasks = json.loads(out)["tasks"]
    assert code == 1 and [task["title"] for task in tasks] == [*PARTS, "words"]
    assert "0 of 90" in command("show", "lab9")[1] and (tmp_path / "lab09/report.html").exists()
    assert command("lab", "9", "dance")[0] == 2


def test_one_rule_for_all_robots_is_refused():
    separate = load_lab(9).separate
    far, near = {"metres": 20.0, "statue": 0.0}, {"metres": 1.0, "statue": 1.0}
    assert separate([far, near]) == ""
    assert "the same" in separate([far | {"statue": 1.0}, near])


def test_a_report_begins_with_prediction_and_findings_and_repeats_no_instruction(tmp_path):
    """Answers and code are escaped; the table is the student's own, with its intervals."""
    place = Place(load_lab(3), tmp_path / "lab03")
    start(place, "Ada <b>", "botschool")
    row = "| CartPole 20 | 9 | 100 | 499 | 498 to 500 |"
    edit(place, lambda text: text.replace("| CartPole 20 | | | | |", row))
    answer(place, {"best-cartpole": "20", "p-cartpole": 0.5, "words": "`a < b` is *it*"})
    page = write_report(place, Check(place).all(), tmp_path).read_text()
    order = ["You predicted", "Which population solves CartPole with", "You found", "0.5",
             "498 to 500", "Points"]  # fmt: skip
    assert [page.index(each) for each in order] == sorted(page.index(each) for each in order)
    assert "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src" in page
    assert "Ada &lt;b&gt;" in page and '<b class="answer">20</b>' in page
    assert "Write it before you run" not in page and "measure(run)" not in page.split("Points")[0]
    assert "<code>a &lt; b</code> is <em>it</em>" in page


def test_statistics():
    rng = np.random.default_rng(3)
    one, other = rng.normal(0, 1, 10), rng.normal(3, 1, 10)
    assert permutation_test(one, other) < 0.001 < 0.2 < permutation_test(one, one[::-1])
    low, high = interval(one)
    assert low < np.median(one) < high
    for wrong in (np.zeros(9), np.zeros(1), 0.0):  # would be stretched silently
        with pytest.raises(BotschoolError, match="the same runs, not 10 and"):
            paired_test(np.zeros(10), wrong)
