"""class.yaml: all errors at once, every platform's ids, groups, and settings without effect."""

import csv

import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes.policy import read_policy
from botschool.grading.declare.trust import trust
from exports import Handed, canvas, moodle, saved, written
from running import call
from tiny_course import FILE, SOLUTION, make_course

HALF = SOLUTION.replace("2 * numbers_of_the_students", "3 * numbers_of_the_students")


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    trust(root)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return tmp_path


def rows_of(path):
    with open(path, encoding="utf-8-sig", newline="") as file:
        return {row["student"]: row for row in csv.DictReader(file)}


WRONG = """\
due:
  3: tomorrow
  x: 2026-11-20
late: soon
deadline: 5
weights:
  3: heavy
  4: -1
extensions:
  ada: {3: never}
bonus: perhaps
total: all
adjustments: changes.csv
groups: none.csv
late: 10 per day
"""
SAID = (
    "line 2: 'tomorrow' is not a time", "line 3: 'x' is neither", "line 5: 'deadline' is not",
    "line 7: write under 'weights'", "line 8: write under 'weights'", "line 10: 'never' is not",
    "line 11: 'bonus: perhaps' is neither", "line 12: 'total: all' is not",
    "changes.csv, row 2: 'many' are not points", "changes.csv, row 3: names no student",
    "line 14: ", "none.csv cannot be read", "line 15: 'late' stands there twice",
)  # fmt: skip


@pytest.mark.slow
def test_all_that_is_wrong_is_said_at_once_with_its_place(course):
    (course / "changes.csv").write_text("student,exercise,points\nAda,3,many\n,3,+1\nAda,3,+2\n")
    (course / "class.yaml").write_text(WRONG)
    with pytest.raises(BotschoolError) as error:
        read_policy(course / "class.yaml")
    said = str(error.value).splitlines()
    for words in SAID:
        assert any(words in line for line in said), (words, said)
    assert len(said) == len(SAID) - 1 and all("class.yaml" in s or "csv" in s for s in said)
    (course / "class.yaml").write_text(
        "late: soon\nextensions:\n  eve: {3: 2026-11-20}\n  8: {4: 2026-11-20}\n"
    )
    written(course / "all", {f"ada/{FILE}": SOLUTION.encode()})
    code, _, errors = call("grade-all", course / "all", "-o", course / "out")
    assert code == 2 and errors.count("\n") == 2, errors  # 8 matters to no exercise that is graded
    assert "line 1: 'late: soon'" in errors and "line 3 names eve, who is not in the" in errors


IDS = {
    "Moodle's number": (moodle, "1234561"),
    "as Moodle writes it": (moodle, "Participant 1234561"),
    "Canvas's number": (canvas, "401"),
    "a name": (moodle, "Bob Gauss"),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", IDS)
def test_settings_name_people_as_their_platform_does(course, kind):
    platform, name = IDS[kind]
    people = [Handed(each, {FILE: HALF.encode()}) for each in ("Ada Byron", "Bob Gauss")]
    saved(course / "x.zip", platform(people))
    (course / "changes.csv").write_text(f"student,exercise,points\n{name},3,+7\n")
    (course / "class.yaml").write_text("adjustments: changes.csv\n")
    assert call("grade-all", course / "x.zip", "-o", course / "out", "-w", 1)[0] == 0
    rows = rows_of(course / "out" / "grades.csv")
    assert sorted(row["total"] for row in rows.values()) == ["40", "47"]
    assert [row["total"] for key, row in rows.items() if "ob" in key] == ["47"]


@pytest.mark.slow
def test_no_mark_is_above_the_maximum_unless_the_class_says_so(course):
    written(course / "all", {f"ada/{FILE}": SOLUTION.encode()})
    (course / "changes.csv").write_text("student,exercise,points\nada,3,+30\n")
    for text, total in (("", "100"), ("bonus: no\n", "100"), ("bonus: yes\n", "130")):
        (course / "class.yaml").write_text(f"adjustments: changes.csv\n{text}")
        call("grade-all", course / "all", "-o", course / "out")
        row = rows_of(course / "out" / "grades.csv")["ada"]
        assert row["total"] == total and ("130 points: 100 count." in row["notes"]) == (
            total == "100"
        )


@pytest.mark.slow
def test_a_groups_file_counts_for_each_member_as_canvas_and_clones_name_it(course):
    people = [
        Handed("Ada Byron", {FILE: SOLUTION.encode()}),
        Handed("Eve Cho", {FILE: HALF.encode()}),
    ]
    files = {name.replace("byronada", "redteam"): each for name, each in canvas(people).items()}
    files = {name.replace("_400_", "_777_"): each for name, each in files.items()}
    saved(course / "x.zip", files)
    lines = ["name,id,canvas", "Ada Byron,7,1", "Bob Gauss,8,2", "Eve Cho,9,401", "Finn Dorn,10,3"]
    (course / "students.csv").write_text("\n".join(lines))
    (course / "groups.csv").write_text("team,id\nRed Team,7\nRed Team,8\nBlue,9\nBlue,10\n")
    (course / "class.yaml").write_text("roster: students.csv\ngroups: groups.csv\n")
    code, out, errors = call("grade-all", course / "x.zip", "-o", course / "out", "-w", 1)
    assert (code, errors) == (0, ""), out
    rows = rows_of(course / "out" / "grades.csv")
    totals = {name: row["total"] for name, row in rows.items()}
    assert totals == {"Ada Byron": "100", "Bob Gauss": "100", "Eve Cho": "40", "Finn Dorn": "40"}
    assert "Handed in by Eve Cho, group Blue." in rows["Finn Dorn"]["notes"]
    similar = (course / "out" / "similar.html").read_text()
    assert "Finn Dorn" not in similar and "Bob Gauss" not in similar  # a group's file is no copy


@pytest.mark.slow
def test_settings_without_effect_are_said(course):
    written(course / "all", {f"ada/{FILE}": SOLUTION.encode(), "class.yaml": b"late: 1 per day\n"})
    code, out, _ = call("grade-all", course / "all", "-o", course / "out")
    assert code == 0 and "class.yaml inside the download has no effect" in out
    text = "late: 10 per day\ndue: {3: 2026-11-20}\nweights: {33: 2}\n"
    (course / "class.yaml").write_text(text)
    _, out, _ = call("grade-all", course / "all", "-o", course / "out")
    assert "The deadline of exercise 3 has no effect, because nothing tells when anybody" in out
    assert "class.yaml, line 3: there is no exercise 33." in out
    (course / "class.yaml").write_text("late: 10 per day\n")
    _, out, _ = call("grade-all", course / "all", "-o", course / "out")
    assert "'late' has no effect without a deadline" in out


@pytest.mark.slow
def test_a_worksheet_tells_who_of_one_name_is_who_on_the_class_list(course):
    people = [Handed("Kim Lee", {FILE: text.encode()}) for text in (HALF, SOLUTION)]
    saved(course / "x.zip", moodle(people))
    sheet = (
        "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Last modified (submission)\n"
    )
    for at, mail in enumerate(("lee@x.org", "kim@x.org")):
        when = '"Friday, 20 November 2026, 9:14 PM"'
        sheet += f"Participant {1234560 + at},Kim Lee,{mail},Submitted,,10.00,{when}\n"
    (course / "sheet.csv").write_text(sheet)
    lines = ["name,id,email", "Kim Lee,1,kim@x.org", "Kim Lee,2,lee@x.org", "Eve Cho,3,eve@x.org"]
    (course / "students.csv").write_text("\n".join(lines))
    (course / "class.yaml").write_text(
        "roster: students.csv\ndue: {3: 2026-11-19}\nlate: 10 per day\n"
        "extensions: {2: {3: 2026-11-21}}\n"
    )
    book = ("--gradebook", course / "sheet.csv")
    code, out, errors = call("grade-all", course / "x.zip", "-o", course / "out", "-w", 1, *book)
    assert (code, errors) == (1, "") and "Nothing from: Eve Cho." in out and "Whose" not in out, out
    with open(course / "out" / "grades.csv", encoding="utf-8-sig", newline="") as file:
        totals = {row["id"]: row["total"] for row in csv.DictReader(file)}
    assert totals == {"1": "90", "2": "40", "3": ""}
    with open(course / "out" / "moodle.csv", newline="") as file:
        assert [row["Grade"] for row in csv.DictReader(file)] == ["4.00", "9.00"]
