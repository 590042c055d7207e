"""A class: roster, deadlines, adjustments, statistics, similar submissions, gradebooks."""

import csv
import io
import shutil
import subprocess
import zipfile
from datetime import datetime, timedelta
from pathlib import Path

import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes.policy import LateRule, read_policy
from botschool.grading.classes.similar import Program, grouped, similar_pairs, similarity_page
from botschool.grading.classes.statistics import by_task, hardest, statistics_page
from botschool.grading.classes.tables import safe_cell
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.trust import trust
from botschool.grading.report.feedback import page as feedback
from botschool.labs.classes import secret_choice
from botschool.labs.declare import load_lab
from botschool.labs.folder import Place
from exports import Handed, canvas, gradescope, moodle, saved, written, zipped
from lab_students import answer, predicted
from running import call, one_sentence
from tiny_course import FILE, SOLUTION, make_course

HALF = SOLUTION.replace("2 * numbers_of_the_students", "3 * numbers_of_the_students")


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    trust(root)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


def rows_of(path):
    with open(path, encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def roster(tmp_path, text, name="students.csv"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


FORMULAS = (
    "=1+2", "+1", "-1", "@x", "\t=1", "\n=1", " =1", '"=1', "a;=1", "a; =1", 'a;"=1', "a,=1",
    "a\t;\t@x", "a;;=1", "a;b;-1", "\x0b=1", "\uff1d1", "\uff0b1", "\uff0d1", "\uff20x", "\ufe661",
    "\u22121", "a;\uff1d1", "\ufeff=1", "\u200b=1",
)  # fmt: skip


@pytest.mark.parametrize("delimiter", [",", ";", "\t"])
@pytest.mark.parametrize("text", FORMULAS, ids=ascii)
def test_no_cell_is_a_formula_however_a_table_is_split(text, delimiter):
    stream = io.StringIO()
    csv.writer(stream).writerow(["x, y", safe_cell(text), safe_cell(f"{text}, z")])
    (row,) = csv.reader([stream.getvalue().rstrip()], delimiter=delimiter)
    for cell in row:
        begins = cell.lstrip(' "\ufeff\u200b')
        assert not begins.startswith(tuple("=+-@\uff1d\uff0b\uff0d\uff20\ufe66\u2212")), row


def test_other_cells_stay_as_they_are():
    for text in ("x = 1", "ada@x.org", "3-4", "a; b", "a, b - c", "1; 2"):
        assert safe_cell(text) == text


# --- deadlines
def settings(tmp_path, text):
    path = tmp_path / "class.yaml"
    path.write_text(text)
    return path


def test_the_late_rule():
    rule, hour = LateRule(10, "day", 35), timedelta(hours=1)
    assert [rule.points(n * hour) for n in (0, 1, 24, 25, 100)] == [0, 10, 10, 20, 35]


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("late: soon", "'late: soon' is not a rule"),
        ("due: 5", "a line for each exercise"),
        ("due:\n  3: tomorrow", "'tomorrow' is not a time"),
        ("deadline: 5", "'deadline' is not a setting"),
        ("due: [", "is not valid YAML"),
        ("adjustments: none.csv", "cannot be read"),
        ("weights: 5", "under 'weights'"),
        ("syntax: 5", "write 'its task' or 'everything'"),
        ("- 5", "holds no settings"),
    ],
)
def test_settings_that_are_wrong(tmp_path, text, sentence):
    with pytest.raises(BotschoolError, match=sentence):
        read_policy(settings(tmp_path, text))


def result(points=80, graded=True):
    return {"exercise": 3, "points": points, "max_points": 100, "graded": graded, "notes": []}


def test_deadlines_extensions_and_adjustments(tmp_path):
    roster(
        tmp_path,
        "email,exercise,points,reason\nada@x.org,3,+5.5,A good question.\nbob,3,=50,\n",
        "changes.csv",
    )
    policy = read_policy(
        settings(
            tmp_path,
            (
                "due:\n  3: 2026-11-20 23:59\nlate: 10 per day, at most 30\n"
                "adjustments: changes.csv\n"
                "extensions:\n  eve@x.org:\n    3: 2026-11-22\n"
            ),
        )
    )

    def points(name, moment, given=80, graded=True, marked=False):
        found = policy.apply(result(given, graded), [name], moment, marked)
        return found["points"], " ".join(found["notes"])

    def at(day, hour=12):
        return datetime(2026, 11, day, hour)

    assert points("x", at(20)) == (80, "")
    assert points("x", datetime(2026, 11, 20, 23, 59, 40)) == (80, "")
    assert points("x", at(21, 10)) == (70, "Late by 10.0 hours: 10 points off.")
    assert points("x", at(28))[0] == 50 and points("x", at(28), given=20)[0] == 0
    assert points("eve@x.org", at(22, 20)) == (80, "") and points("eve@x.org", at(24))[0] == 60
    assert points("ada@x.org", at(20)) == (85.5, "Adjusted by +5.5 points: A good question.")
    assert points("bob", None, graded=False) == (50, "Set to 50 points: by hand.")
    marked = "The platform marks it late, but not how late. "
    off = f"{marked}Counted as one day: 10 points off."
    assert points("x", None, marked=True) == (70, off)
    found = points("eve@x.org", None, marked=True)
    assert found == (80, f"{marked}The extension until 2026-11-22 23:59 counts: nothing is off.")
    assert points("x", at(21), given=0, graded=False) == (0, "")


# --- a class by the command
@pytest.mark.slow
def test_a_class_with_all_that_happens(course, tmp_path):
    people = [
        Handed("Ada Lovelace", {FILE: SOLUTION.encode()}),
        Handed("Bob =1+1", {FILE: HALF.encode()}),
        Handed("Eve Unknown", {FILE: skeleton(SOLUTION).encode()}),
    ]
    download = saved(tmp_path / "download.zip", moodle(people))
    sheet = roster(
        tmp_path,
        (
            "\ufeffIdentifier,Full name,Email address,Status,Grade,Maximum Grade,"
            "Last modified (submission),Feedback comments\r\n"
            "Participant 1234560,Ada Lovelace,ada@x.org,Submitted,,50.00,"
            '"Friday, 20 November 2026, 9:14 PM",\r\n'
            'Participant 1234561,Bob =1+1,bob@x.org,Submitted,,50.00,"Sunday, 22 November 2026, '
            '9:14 PM",\r\n'
            "Participant 99,Carl Gauss,carl@x.org,No submission,,50.00,-,\r\n"
        ),
        "sheet.csv",
    )
    roster(tmp_path, "student,exercise,points,reason\nAda Lovelace,3,-1,typo\n", "changes.csv")
    settings(tmp_path, "due:\n  3: 2026-11-20 23:59\nlate: 10 per day\nadjustments: changes.csv\n")
    arguments = ("grade-all", download, "-e", "3", "-o", tmp_path / "out", "--gradebook", sheet)
    for _ in range(2):  # adjustments survive regrading, and are made once
        code, out, errors = call(*arguments, "-w", "2")
        out = " ".join(out.split())
        assert (code, errors) == (1, "")
        assert "3 submissions" in out and "Nothing from: Carl Gauss." in out
        assert "Not on the roster: Eve Unknown." in out
        assert "Where the class stumbled: 3.1 Doubling (33%), 3.2 Adding (67%)." in out
        rows = {row["student"]: row for row in rows_of(tmp_path / "out" / "grades.csv")}
        assert {name: row["total"] for name, row in rows.items()} == {
            "Ada Lovelace": "99",
            "Bob =1+1": "20",
            "Eve Unknown": "0",
            "Carl Gauss": "",
        }
    assert "2 days" in rows["Bob =1+1"]["notes"] or "hours" in rows["Bob =1+1"]["notes"]
    assert rows["Carl Gauss"]["notes"] == "Exercise 3: Nothing was handed in."
    assert rows["Ada Lovelace"]["3.1"] == "60"
    assert rows["Ada Lovelace"]["Email address"] == "ada@x.org"
    back = rows_of(tmp_path / "out" / "moodle.csv")
    assert [row["Grade"] for row in back] == ["49.50", "10.00", ""]
    assert back[2]["Email address"] == "carl@x.org" and "typo" in back[0]["Feedback comments"]
    assert (tmp_path / "out" / "moodle.csv").read_bytes().startswith(b"\xef\xbb\xbfIdentifier")
    with zipfile.ZipFile(tmp_path / "out" / "moodle-feedback.zip") as archive:
        names = archive.namelist()
        assert f"{people[0].name}_1234560_assignsubmission_file_/feedback.html" in names
        assert len(names) == 3 and b"Ada Lovelace" in archive.read(names[0])
    page = (tmp_path / "out" / "feedback" / "Ada Lovelace.html").read_text()
    assert "<h1>Ada Lovelace</h1>" in page and "Adjusted by -1 points: typo." in page
    assert "1 handed in nothing: Carl Gauss." in (tmp_path / "out" / "class.html").read_text()
    for name in ("class.html", "similar.html"):
        assert "<script" not in (tmp_path / "out" / name).read_text()


@pytest.mark.slow
def test_canvas_takes_its_gradebook_and_feedback_back(course, tmp_path):
    people = [Handed("Ada Lovelace", {FILE: SOLUTION.encode()}, late=True)]
    download = written(tmp_path / "download", canvas(people))
    book = roster(
        tmp_path,
        (
            "Student,ID,SIS User ID,SIS Login ID,Section,Homework 2 (11),Exercise 3 (12)\n"
            "    Points Possible,,,,,10,20\n"
            '"Lovelace, Ada",400,7,ada,A,9,\n'
            '"Gauss, Carl",401,8,carl,A,5,3\n"Student, Test",402,,,A,,\n'
        ),
    )
    arguments = ("grade-all", download, "-o", tmp_path / "out", "--gradebook", book)
    code, _, errors = call(*arguments)
    one_sentence(code, errors, "name one assignment's column with --column")
    code, out, _ = call(*arguments, "--column", "exercise 3")
    assert code == 1 and "Nothing from: Carl Gauss." in out
    table = list(csv.reader(io.StringIO((tmp_path / "out" / "canvas.csv").read_text())))
    assert table == [
        ["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Exercise 3 (12)"],
        ["    Points Possible", "", "", "", "", "20"],
        ["Lovelace, Ada", "400", "7", "ada", "A", "20"],
    ]
    with zipfile.ZipFile(tmp_path / "out" / "canvas-feedback.zip") as archive:
        assert archive.namelist() == [f"lovelaceada_LATE_400_90400_{FILE}"]
        assert b"Exercise 3. Tiny: 100 of 100" in archive.read(archive.namelist()[0])


def test_settings_name_nobody_unknown(course, tmp_path):
    download = written(tmp_path / "class", {f"ada/{FILE}": HALF.encode()})
    people = roster(tmp_path, "name,id,email\nAda Lovelace,7,ada@x.org\n")
    settings(tmp_path, "extensions:\n  bob:\n    3: 2026-11-20\n")
    arguments = ("grade-all", download, "-o", tmp_path / "out", "--roster", people)
    one_sentence(*call(*arguments)[::2], "class.yaml, line 2 names bob, who is not in the class")


@pytest.mark.slow
def test_gradescopes_times_count(course, tmp_path):
    people = [Handed("Ada Lovelace", {FILE: SOLUTION.encode()})]
    download = saved(tmp_path / "x.zip", gradescope(people))
    settings(tmp_path, "due:\n  3: 2026-11-15\nlate: 1 per day\nweights:\n  3: 0.5\n")
    assert call("grade-all", download, "-o", tmp_path / "out")[0] == 0
    (row,) = rows_of(tmp_path / "out" / "grades.csv")
    assert row["exercise 3"] in ("94", "95") and row["total"] == row["exercise 3"]  # not weighted


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("git") is None, reason="there is no git")
def test_commits_and_nbgraders_times_count(course, tmp_path, monkeypatch):
    ran, class_ = tmp_path / "ran", tmp_path / "class"
    gpg = tmp_path / "gpg"
    gpg.write_text(f"#!/bin/sh\ntouch {ran}\n")
    gpg.chmod(0o755)
    for name, day in (("ada", 21), ("bob", 19)):
        home = written(class_ / f"ex03-{name}", {f"work/{FILE}": SOLUTION.encode()})
        for day_of, file in ((day, FILE), (28, "later.txt")):  # another exercise, weeks later
            (home / "work" / file).touch()
            when = f"2026-11-{day_of}T12:00:00"
            for command in (["init", "-q"], ["add", "-A"], ["commit", "-qm", "x"]):
                monkeypatch.setenv("GIT_COMMITTER_DATE", when)
                git = ["git", "-c", "user.name=x", "-c", "user.email=x@x", *command]
                subprocess.run(git, cwd=home, check=True)
        for setting in (["log.showSignature", "true"], ["gpg.program", str(gpg)]):
            subprocess.run(["git", "config", *setting], cwd=home, check=True)
    subprocess.run(["git", "gc", "-q"], cwd=home, check=True)
    written(
        class_, {f"eve/{FILE}": SOLUTION.encode(), "eve/timestamp.txt": b"2026-11-22 10:00:00.5"}
    )
    settings(
        tmp_path, "due: {3: 2026-11-20}\nlate: 10 per day\nextensions: {ada: {3: 2026-11-21}}\n"
    )
    people = roster(tmp_path, "name,username\nAda,ada\nBob,bob\nEve,eve\n")
    arguments = ("grade-all", class_, "-o", tmp_path / "out", "--roster", people, "-w", "1")
    assert call(*arguments)[::2] == (0, "")

    def found():
        rows = rows_of(tmp_path / "out" / "grades.csv")
        return {row["student"]: row["total"] for row in rows}

    assert found() == {"Ada": "100", "Bob": "100", "Eve": "80"} and not ran.exists()
    settings(tmp_path, "due: {3: 2026-11-20}\nlate: 10 per day\n")
    assert call(*arguments)[0] == 0
    assert found() == {"Ada": "90", "Bob": "100", "Eve": "80"}
    assert "timestamp" not in (tmp_path / "out" / "grades.csv").read_text()


# --- who stumbled, and who is alike
def task(points, message="", id="3.1"):
    return {"id": id, "title": "T", "points": points, "max_points": 10, "message": message}


def test_statistics_of_tasks():
    people = [
        (f"S{points}", f"S{points}.html", [{
            "graded": graded,
            "problem": "",
            "tasks": [task(points, message), task(9, id="3.2")],
        }])
        for graded, points, message in (
            (True, 0, "got 0.5\nYour code takes the sum."),
            (True, 4, "got 4.5 <b>\nYour code takes the sum."),
            (True, 5, "got 5.5 of 7"),
            (True, 10, ""),
            (False, 0, "got"),
        )
    ]  # fmt: skip
    first, second = by_task(people)
    assert first.points == [0, 4, 5, 10] and (first.full, first.none) == (1, 1)
    assert {key: len(each) for key, each in first.mistakes.items()} == {
        "takes the sum.": 2, "got # of #": 1
    }  # fmt: skip
    assert hardest([first, second]) == [first]
    page = statistics_page([first], ["<i>"])
    assert "4.8 <small>of 10" in page and "<b>2 of 4</b>: takes the sum." in page
    assert "Median 4.5, the middle half from 3 to 6.25." in page and "&lt;i&gt;" in page
    assert '<a href="feedback/S0.html">S0</a>' in page and "Your code takes the sum." in page
    assert "<script" not in page and 'name="viewport"' in page


def test_code_stands_beside_its_message_and_the_exercises_text_is_folded():
    undone = '    raise NotImplementedError("task 3.{}: do")'
    lines = [f"# text {n}" for n in range(9)]
    given = "\n".join([*lines, "def f():", undone.format(1), "def g():", undone.format(2)])
    text = given.replace('raise NotImplementedError("task 3.1: do")', "return '<b>'")
    result = {
        "exercise": 3, "title": "T", "points": 0, "max_points": 20, "graded": True, "notes": [],
        "problem": "", "banner": "", "pictures": [], "code": text, "skeleton": given,
        "file": Path("tiny.py"),
        "tasks": [task(0, "wrong answer") | {"printed": ""},
                  task(0, "tiny.py:13 fails", id="3.2") | {"printed": ""}],
    }  # fmt: skip
    made = feedback("Ada", [result])
    assert "9 lines of the exercise" in made and "<b>'" not in made
    beside = "<aside><p><b>3.1</b> wrong answer</p></aside><div>"
    assert f'{beside}<pre class="lines"><span><i>10</i><span>def f():' in made
    fails = made.index("<b>3.2</b> tiny.py:13 fails")
    assert made.index("<i>12</i>") < fails < made.index("<i>13</i>")
    assert made.count("<div") == made.count("</div>")


OTHER = """
import numpy as np

def double(numbers):
    result = []
    for row in np.atleast_2d(numbers):
        line = []
        for value in row:
            line.append(value + value)
        result.append(line)
    return np.array(result).reshape(np.shape(numbers))

def total(numbers):
    count, left = 0.0, list(np.ravel(numbers))
    while left:
        count = count + left.pop(0)
    return count
"""


@pytest.mark.slow
def test_a_copy_with_other_names_is_found_and_the_skeleton_does_not_count():
    copied = OTHER.replace("result", "table").replace("value", "v").replace("    ", "  ")
    copied = "# my own work\n" + copied.replace("count", "s")
    given = skeleton(SOLUTION)
    third = given.replace(
        'raise NotImplementedError("task 3.1: double the numbers")',
        "return np.add(numbers, numbers) if len(numbers) else numbers * 0 + 0",
    )
    programs = [
        Program("ada", OTHER),
        Program("<bob>", copied),
        Program("carl", SOLUTION),
        Program("dora", third),
        Program("eve", given),
        Program("fred", "def (:\n'''"),
    ]
    (pair,) = similar_pairs(programs, given)
    assert {pair.first.student, pair.second.student} == {"ada", "<bob>"} and pair.similarity == 1
    page = similarity_page({3: (6, [pair])})
    assert (
        "100%: ada and &lt;bob&gt;" in page
        and page.count("<mark>") > 20
        and ":target" in page
        and "<bob>" not in page
    )
    assert similar_pairs([Program("a", given), Program("b", given)], given) == []
    same = [Program(f"s{i}", OTHER) for i in range(9)]
    (pair,) = grouped(similar_pairs(programs + same, given))  # and not 55 pairs
    assert len(pair.also) == 9 and "; also " in similarity_page({3: (15, [pair])})


@pytest.mark.slow
def test_a_copy_of_our_solution_is_told_to_the_instructor_alone(course, tmp_path):
    renamed = SOLUTION.replace("numbers", "xs").replace("twice_as_large_as_before", "answer")
    first, second = renamed.index("def double"), renamed.index("def total")
    end = renamed.index("if __name__")
    reordered = renamed[:first] + renamed[second:end] + renamed[first:second] + renamed[end:]
    own = SOLUTION.replace("float(np.sum(np.asarray(xs", "float(np.sum(np.asarray(xs")
    own = (
        own.replace("numbers_of_the_students = np.asarray(numbers)", "found = []")
        .replace(
            "twice_as_large_as_before = 2 * numbers_of_the_students",
            "for row in numbers:\n        found.append(row + row)",
        )
        .replace("return twice_as_large_as_before", "return np.array(found)")
        .replace(
            "return float(np.sum(np.asarray(numbers, dtype=np.float64).ravel()))",
            "result = 0.0\n    for number in numbers:\n        result += number\n    return result",
        )
    )
    files = {"ada": SOLUTION, "bob": f"# mine\n{reordered}", "eve": own}
    written(tmp_path / "class", {f"{name}/{FILE}": text.encode() for name, text in files.items()})
    _, out, errors = call("grade-all", tmp_path / "class", "-e", "3", "-o", tmp_path / "out")
    assert errors == "" and "similar.html: ada, bob." in " ".join(out.split())
    notes = {row["student"]: row["notes"] for row in rows_of(tmp_path / "out" / "grades.csv")}
    assert "100% like our solution" in notes["ada"] and "100% like our" in notes["bob"]
    assert "like our" not in notes["eve"]
    assert "like our" not in (tmp_path / "out" / "feedback" / "ada.html").read_text()
    assert "our solution" in (tmp_path / "out" / "similar.html").read_text()


@pytest.mark.slow
def test_tasks_are_dropped_and_weighed_for_release_and_grading_alike(course, tmp_path):
    settings(tmp_path, "tasks: {3.1: 7, 3.2: 0}\n")
    written(tmp_path / "class", {f"ada/{FILE}": SOLUTION.encode(), f"bob/{FILE}": HALF.encode()})
    assert call("grade-all", tmp_path / "class", "-e", "3", "-o", tmp_path / "out")[0] == 0
    rows = rows_of(tmp_path / "out" / "grades.csv")
    assert [row["total"] for row in rows] == ["7", "0"] and "3.2" not in rows[0]
    copy = tmp_path / "copy"
    arguments = ("release", copy, "--class", tmp_path / "class.yaml", "--no-answers")
    assert call(*arguments, cwd=course)[::2] == (0, "")
    assert (copy / "exercises" / "tasks.txt").read_text() == "3.1=7 3.2=0\n"


@pytest.mark.slow
def test_folders_with_a_dot_and_windows_zip_files(course, tmp_path):
    packed = bytearray(zipped({FILE: SOLUTION.encode()}))
    for sign, at in ((b"PK\x03\x04", 8), (b"PK\x01\x02", 10)):
        packed[packed.index(sign) + at] = 9  # Deflate64
    files = {f"...z/{FILE}": SOLUTION.encode(), "eve/work.zip": bytes(packed)}
    written(tmp_path / "class", files)
    assert call("grade-all", tmp_path / "class", "-o", tmp_path / "out")[0] == 0
    dots, eve = rows_of(tmp_path / "out" / "grades.csv")
    assert (dots["student"], dots["total"]) == ("...z", "100")
    assert "is packed by a method that Python cannot unpack" in eve["notes"]


@pytest.mark.slow
def test_groups_of_another_exercise_stop_nothing(course, tmp_path):
    written(tmp_path / "class", {f"ada/{FILE}": SOLUTION.encode()})
    roster(tmp_path, "group,student,exercise\nRed,nobody@x.org,2\nRed,ada,2\n", "groups.csv")
    people = roster(tmp_path, "name,user\nAda Berg,ada\n")
    settings(tmp_path, "groups: groups.csv\n")
    arguments = ("grade-all", tmp_path / "class", "-e", "3", "-o", tmp_path / "out")
    assert call(*arguments, "--roster", people)[::2] == (0, "")


# --- laboratories
def handed_in(tmp_path):
    """Ada's laboratory without runs, in a folder; Bob's, in a zip file; Carl's sheet is damaged."""
    place = predicted(load_lab(3), tmp_path / "class" / "Ada" / "work", "Ada")
    answer(place, {"words": "The spread surprised me."})
    sheet = (place.folder / "sheet.md").read_bytes()
    files = {"lab03/sheet.md": sheet, "lab03/runs/CartPole 4/statS5.npy": b"no numbers"}
    written(tmp_path / "class", {"Bob.zip": zipped(files), "Carl/sheet (1).md": sheet + b"\xff"})
    return tmp_path / "class"


@pytest.mark.slow
def test_laboratories_are_graded_beside_exercises(course, tmp_path):
    download = handed_in(tmp_path)
    written(download, {f"Ada/{FILE}": SOLUTION.encode()})
    output = tmp_path / "out"
    assert call("grade-all", str(download), "-o", str(output), cwd=tmp_path)[0] == 0
    ada, bob, carl = rows_of(output / "grades.csv")
    assert (ada["student"], ada["exercise 3"], ada["laboratory 3"]) == ("Ada", "100", "0")
    assert ada["lab3.prediction"] == "0" and "laboratory 9" not in ada
    assert bob["laboratory 3"] == "0" and "There is no tiny.py" in bob["notes"]
    assert "Laboratory 3: sheet.md is not UTF-8 text" in carl["notes"]
    page = (output / "feedback" / "Ada.html").read_text()
    assert "Laboratory 3. At equal numbers" in page and "There are no runs yet" in page
    words = rows_of(output / "words.csv")
    assert [row["text"] for row in words] == ["The spread surprised me."] * 2
    words[0] |= {"points": "8", "comment": "Say why"}
    with open(output / "words.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, words[0].keys())
        writer.writeheader()
        writer.writerows(words)
    (tmp_path / "changes.csv").write_text("student,exercise,points,reason\nBob,lab3,+2,a talk\n")
    named = "weights: {3: 1, lab3: 0.5}\nadjustments: [out/words.csv, changes.csv]\n"
    for text in (named, named.replace("out/words.csv, ", "")):  # it counts without being named
        settings(tmp_path, text)
        assert call("grade-all", str(download), "-o", str(output), cwd=tmp_path)[0] == 0
        ada, bob, _ = rows_of(output / "grades.csv")
        assert (ada["laboratory 3"], ada["lab3.words"], ada["total"]) == ("8", "8", "104")
        assert bob["laboratory 3"] == "2" and bob["total"] == "1"
        assert "Say why" in (output / "feedback" / "Ada.html").read_text()
        again = rows_of(output / "words.csv")
        assert [row["points"] for row in again] == ["8", ""] and "spread" in again[0]["text"]
        assert again[0]["comment"] == "Say why" and again[0]["rubric"] == words[0]["rubric"]
    answer(Place(load_lab(3), download / "Ada" / "work" / "lab03"), {"words": "Now other words."})
    out = call("grade-all", str(download), "-o", str(output), cwd=tmp_path)[1]
    assert "Ada has changed lab3.words since you gave 8 points" in out
    assert rows_of(output / "words.csv")[0]["points"] == "8"
    code, _, _ = call("grade-all", str(download), "-e", "lab09", "-o", "new", cwd=tmp_path)
    assert code == 0 and rows_of(tmp_path / "new" / "grades.csv")[0]["laboratory 9"] == "0"
    refused = call("grade-all", str(download), "-e", "lab99", cwd=tmp_path)[::2]
    one_sentence(*refused, "not a laboratory")


@pytest.mark.slow
def test_an_instructor_checks_one_laboratory(course, tmp_path):
    download = handed_in(tmp_path)
    code, out, _ = call("lab", "3", "check", "--submission", str(download / "Bob.zip"))
    assert code == 1 and "0 of 90 points" in out and "The spread surprised me." in out
    nobodys = call("lab", "9", "check", "--submission", str(download / "Ada"))
    one_sentence(*nobodys[::2], "no sheet.md of laboratory 9")


def test_the_choice_of_runs_follows_from_secret_and_runs(tmp_path):
    place = Place(load_lab(3), tmp_path)
    written(tmp_path, {"runs/CartPole 4/statS5.npy": b"1"})
    first = secret_choice(place, "a")
    drawn = first(16), first(16)
    again = secret_choice(place, "a")
    assert drawn == (again(16), again(16)) and drawn[0] != drawn[1]
    assert secret_choice(place, "b")(16) != drawn[0]
    written(tmp_path, {"runs/CartPole 4/statS5.npy": b"2"})
    assert secret_choice(place, "a")(16) != drawn[0]
