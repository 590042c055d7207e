"""A term: three assignments of a class of 40, as Moodle and Canvas export them, joined."""

import csv
import io
import random
import shutil
from dataclasses import dataclass, field

import pytest

from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.trust import trust
from exports import saved, written
from running import call
from tiny_course import FILE, FOLDER, GRADER, SOLUTION, make_course

NUMBERS = (3, 4, 5)
DUE = "2026-10-{:02} 23:59"
GIVEN = {  # what students hand in, and its points
    100: SOLUTION,
    40: SOLUTION.replace("2 * numbers_of", "3 * numbers_of"),
    60: SOLUTION.replace("np.sum", "np.mean"),
    0: skeleton(SOLUTION),
}


@dataclass
class Pupil:
    """A student of the class."""

    name: str
    id: str
    mail: list[str]
    """In each assignment."""
    canvas: str
    numbers: list[str]
    """Moodle's, in each assignment."""
    points: dict = field(default_factory=dict)
    """Exercise -> points of what the student handed in."""
    late: dict = field(default_factory=dict)
    """Exercise -> days."""


def file_of(number):
    return FILE.replace("tiny", f"tiny{number}")


def text_of(points, number):
    return GIVEN[points].replace("task 3.", f"task {number}.").encode()


@pytest.fixture(scope="module")
def course(tmp_path_factory):
    """Three small exercises: 3, 4, 5."""
    root = make_course(tmp_path_factory.mktemp("term") / "course")
    shutil.rmtree(root / "exercises" / FOLDER)
    shutil.rmtree(root / "solutions" / FOLDER)
    for number in NUMBERS:
        folder = f"ex{number:02}_tiny"
        named = f'Exercise({number}, "Tiny {number}", file="{file_of(number)}")'
        grader = GRADER.replace('Exercise(3, "Tiny", file="tiny.py")', named)
        files = {
            f"solutions/{folder}/{file_of(number)}": text_of(100, number),
            f"exercises/{folder}/{file_of(number)}": text_of(0, number),
            f"exercises/{folder}/test_tiny.py": grader.replace('"3.', f'"{number}.').encode(),
            f"exercises/{folder}/README.md": b"# Tiny\n",
        }
        written(root, files)
    trust(root)
    return root


@pytest.fixture
def here(course, tmp_path, monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(course))
    return tmp_path


def pupils():
    """The class of 40: two of one name, one who changes mail; new numbers in each assignment."""
    draw = random.Random(7)
    numbers = [draw.sample(range(10**5 * n, 10**5 * (n + 1)), 40) for n in NUMBERS]
    found = []
    for at in range(40):
        name = "Kim Lee" if at in (5, 6) else f"P{chr(97 + at // 26)}{chr(97 + at % 26)} Son{at}"
        mail = [f"s{at}@x.org"] * 3
        found.append(Pupil(name, f"{7000 + at}", mail, f"{400 + at}",
                           [str(numbers[n][at]) for n in range(3)]))  # fmt: skip
        for number in NUMBERS:
            if at == 39 or (at + number) % 13 == 0:  # one hands in nothing, others now and then
                continue
            found[-1].points[number] = list(GIVEN)[(at * 7 + number) % 4]
            if (at + 2 * number) % 9 == 0:
                found[-1].late[number] = 1 + at % 7
    found[8].mail = ["s8@x.org", "married@y.org", "married@y.org"]
    for at, number in ((10, 5), (20, 5)):  # the other one of the group hands in
        found[at].points.pop(number, None)
        found[at + 1].points[number] = 100
        found[at + 1].late.pop(number, None)
    found[12].points |= {3: 100}
    found[12].late.pop(3, None)
    found[13].points |= {3: 100, 4: 100, 5: 100}
    found[13].late = {}
    return found


def moodle_of(class_, number):
    """Return Moodle's download of an assignment, and its worksheet."""
    at, files = NUMBERS.index(number), {}
    stream = io.StringIO()
    writer = csv.writer(stream)
    head = "Identifier,Full name,Email address,Status,Grade,Maximum Grade,Grade can be changed"
    writer.writerow([*head.split(","), "Last modified (submission)", "Feedback comments"])
    for one in class_:
        handed = one.points.get(number)
        day = 9 + at * 7 + one.late.get(number, 0)
        when = f"Friday, {day} October 2026, 11:10 PM" if handed is not None else "-"
        writer.writerow([f"Participant {one.numbers[at]}", one.name, one.mail[at], "Submitted", "",
                         "20.00", "Yes", when, ""])  # fmt: skip
        if handed is not None:
            top = f"{one.name}_{one.numbers[at]}_assignsubmission_file_"
            files[f"{top}/{file_of(number)}"] = text_of(handed, number)
    return files, stream.getvalue()


def canvas_of(class_, number):
    """Return Canvas's download of an assignment: those who are late are marked."""
    files = {}
    for one in class_:
        if number in one.points:
            short = "".join(reversed(one.name.lower().split()))
            late = "LATE_" * (number in one.late)
            name = f"{short}_{late}{one.canvas}_{number}{one.canvas}_{file_of(number)}"
            files[name] = text_of(one.points[number], number)
    return files


def canvas_book(class_):
    lines = ["Student,ID,SIS User ID,SIS Login ID,Section,Term (90)", "    Points Possible,,,,,50"]
    for one in class_:
        first, last = one.name.split()
        lines.append(f'"{last}, {first}",{one.canvas},{one.id},{one.mail[0]},A,')
    return "\n".join(lines) + "\n"


def settings(folder, class_, canvas=False):
    """Write class.yaml and its tables; each way to name a student is used once."""
    names = {at: class_[at].canvas if canvas else f"Participant {class_[at].numbers[0]}"
             for at in (12, 14)}  # fmt: skip
    day = {number: DUE.format(9 + 7 * at) for at, number in enumerate(NUMBERS)}
    written(folder, {
        "changes.csv": (
            "student,exercise,points,reason\n"
            f"{names[12]},3,+30,more than there is\n{class_[13].mail[0]},4,-10,copied\n"
            f"{class_[39].name},5,=80,an oral exam\n{class_[15].name},total,+2.5,helped others\n"
        ).encode(),
        "groups.csv": (
            f"group,student,exercise\nRed,{class_[10].mail[0]},5\nRed,{class_[11].mail[0]},5\n"
            f"Blue,{class_[20].name},5\nBlue,{class_[21].name},5\n"
        ).encode(),
        "class.yaml": (
            "due:\n" + "".join(f"  {n}: {d}\n" for n, d in day.items())
            + "late: 10 per day, at most 50\nadjustments: changes.csv\ngroups: groups.csv\n"
            + f"extensions:\n  {names[14]}: {{3: 2026-10-30}}\n"
            + "weights: {3: 1, 4: 2, 5: 1}\ntotal: 50\n"
        ).encode(),
    })  # fmt: skip


def totals(class_, canvas=False):
    """Return each student's points and total, summed independently of botschool."""
    found = []
    for at, one in enumerate(class_):
        points = {}
        for number, given in one.points.items():
            days = one.late.get(number, 0)
            if at == 14 and number == 3:
                days = 0  # the extension
            off = min(50, 10 * (min(days, 1) if canvas else days))
            points[number] = max(0, given - off)
        if at in (10, 20):
            points[5] = 100  # the group's
        if at == 12:
            points[3] = 100  # and not 130
        if at == 13:
            points[4] = 90
        if at == 39:
            points[5] = 80
        total = sum({3: 1, 4: 2, 5: 1}[n] * p for n, p in points.items()) * 50 / 400
        if at == 15:
            total = min(50, total + 2.5)
        found.append((points, round(total, 2) if points else None))
    return found


def read(path):
    with open(path, encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def check(rows, class_, canvas=False):
    """Compare a table of the term with the independent sums."""
    assert len(rows) == 40
    for at, (points, total) in enumerate(totals(class_, canvas)):
        one = class_[at]
        keys = {*one.mail, one.id, one.canvas}
        (row,) = [r for r in rows if set(r.values()) & keys or (
            r["student"] == one.name and one.name != "Kim Lee")]  # fmt: skip
        for number in NUMBERS:
            shown = row[f"exercise {number}"]
            assert shown == ("" if number not in points else f"{points[number]:g}"), (row, points)
        assert row["total"] == ("" if total is None else f"{total:g}"), (row, points)


@pytest.mark.slow
def test_three_assignments_of_moodle_become_one_row_for_each_person(here):
    class_ = pupils()
    settings(here / "class", class_)
    outputs = []
    for number in NUMBERS:
        files, sheet = moodle_of(class_, number)
        saved(here / "class" / f"a{number}.zip", files)
        (here / "class" / f"sheet{number}.csv").write_text(sheet)
        outputs.append(here / f"out{number}")
        code, out, errors = call(
            "grade-all", here / "class" / f"a{number}.zip", "-e", number, "-o", outputs[-1],
            "-w", 1, "--gradebook", here / "class" / f"sheet{number}.csv",
        )  # fmt: skip
        assert code in (0, 1) and not errors and "Not on the roster" not in out
        marks = [row["Grade"] for row in read(outputs[-1] / "moodle.csv")]
        expected = [points.get(number) for points, _ in totals(class_)]
        assert marks == ["" if p is None else f"{p / 5:.2f}" for p in expected]
        assert max(float(mark) for mark in marks if mark) <= 20
    last = here / "class" / "sheet5.csv"
    code, out, errors = call("gradebook", *outputs, "-o", here / "term", "--gradebook", last)
    assert (code, errors) == (1, "")  # the student of the oral exam handed in nothing
    assert f"Nothing from: {class_[39].name}." in out and "41 people, 3 exercises" in out, out
    assert "says Pai Son8, but the column 'Email address' differs" in out
    (here / "class" / "people.csv").write_text("identifier,folder\nmarried@y.org,Pai Son8\n")
    code, out, errors = call("gradebook", *outputs, "-o", here / "term", "--gradebook", last)
    assert (code, errors) == (1, "") and "40 people" in out and "Whose" not in out
    check(read(here / "term" / "gradebook.csv"), class_)
    marks = [row["Grade"] for row in read(here / "term" / "moodle.csv")]
    assert marks == ["" if t is None else f"{t * 20 / 50:.2f}" for _, t in totals(class_)]
    changes = here / "class" / "changes.csv"
    changes.write_text(changes.read_text() + f"{class_[0].name},3,+1,more\n")
    assert (
        f"{outputs[0]} was graded with other settings"
        in call("gradebook", *outputs, "-o", here / "term")[1]
    )


@pytest.mark.slow
def test_without_worksheets_people_of_one_name_are_listed(here):
    class_ = pupils()
    outputs = []
    for number in NUMBERS:
        saved(here / f"a{number}.zip", moodle_of(class_, number)[0])
        outputs.append(here / f"out{number}")
        call("grade-all", here / f"a{number}.zip", "-e", number, "-o", outputs[-1], "-w", 1)
    code, out, errors = call("gradebook", *outputs, "-o", here / "term")
    assert (code, errors) == (1, "") and "several have the column 'part 1' 'Kim Lee'" in out
    lines = [
        f"{one.numbers[0]},Kim Lee_{number}_assignsubmission_file_"
        for one in class_[5:7]
        for number in one.numbers[1:]
    ]
    (here / "term" / "people.csv").write_text("\n".join(["identifier,folder", *lines]))
    code, out, errors = call("gradebook", *outputs, "-o", here / "term")
    assert (code, errors) == (0, ""), out
    lees = class_[5:7]
    rows = read(here / "term" / "gradebook.csv")
    assert len(rows) == 39  # nobody knows of the one who handed in nothing
    found = sorted(float(row["total"]) for row in rows if row["student"].startswith("Kim Lee"))
    assert found == sorted(float(sum(one.points.values())) for one in lees)


@pytest.mark.slow
def test_downloads_side_by_side_make_one_row_for_each_person(here):
    class_ = pupils()[:12]
    lines = ["name,id,email", *(f"{one.name},{one.id},{one.mail[0]}" for one in class_)]
    written(
        here, {"students.csv": "\n".join(lines).encode(), "class.yaml": b"roster: students.csv\n"}
    )
    for number in NUMBERS:
        (here / "all").mkdir(exist_ok=True)
        saved(here / "all" / f"a{number}.zip", moodle_of(class_, number)[0])
    code, out, errors = call("grade-all", here / "all", "-e", "3-5", "-o", here / "out", "-w", 1)
    assert (code, errors) == (1, "") and "several have the column 'name' 'Kim Lee'" in out
    lines = [
        f"{one.id},Kim Lee_{number}_assignsubmission_file_"
        for one in class_[5:7]
        for number in one.numbers
    ]
    (here / "people.csv").write_text("\n".join(["identifier,folder", *lines]))
    code, out, _ = call("grade-all", here / "all", "-e", "3-5", "-o", here / "out", "-w", 1)
    assert "Whose" not in out
    rows = {row["id"]: row for row in read(here / "out" / "grades.csv")}
    assert len(rows) == 12
    for one in class_:
        assert float(rows[one.id]["total"]) == sum(one.points.values()), (one, rows[one.id])
    for number in NUMBERS:
        assert (here / "out" / f"moodle-feedback-a{number}.zip").is_file()


@pytest.mark.slow
def test_three_assignments_of_canvas(here):
    class_ = pupils()
    settings(here / "class", class_, canvas=True)
    (here / "class" / "book.csv").write_text(canvas_book(class_))
    book = ("--gradebook", here / "class" / "book.csv", "--column", "Term")
    outputs = []
    for number in NUMBERS:
        saved(here / "class" / f"a{number}.zip", canvas_of(class_, number))
        outputs.append(here / f"out{number}")
        code, _, errors = call(
            "grade-all", here / "class" / f"a{number}.zip", "-e", number, "-o", outputs[-1],
            "-w", 1, *book,
        )  # fmt: skip
        assert code in (0, 1) and not errors
    code, _, errors = call("gradebook", *outputs, "-o", here / "term", *book)
    assert (code, errors) == (1, "") and not (here / "class" / "people.csv").exists()
    check(read(here / "term" / "gradebook.csv"), class_, canvas=True)
    table = {row["ID"]: row["Term (90)"] for row in read(here / "term" / "canvas.csv")}
    for one, (_, total) in zip(class_, totals(class_, canvas=True), strict=True):
        assert table.get(one.canvas, "") == ("" if total is None else f"{total:g}")
