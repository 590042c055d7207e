"""The commands of grading: what they print and write, and how they refuse."""

import base64
import csv
import ctypes
import json
import platform
import signal
import subprocess
import sys
import time
from html.parser import HTMLParser

import psutil
import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes.collect import grade_all
from botschool.grading.copies.release import MANIFEST, release
from botschool.grading.copies.skeleton import find_leaks
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.trust import trust
from botschool.grading.judge.submission import grade
from botschool.grading.report.screen import Screen, Watched, watch
from botschool.grading.report.showing import show
from botschool.sandbox import seccomp
from exports import notebook, zipped
from running import call, environment_of_command, finish, one_sentence, start
from tiny_course import FILE, FOLDER, SOLUTION, make_course, submit

PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNk+M9QDwADhgGAWjR9awAAAABJRU5ErkJggg=="
)


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    trust(root)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.mark.slow
def test_grade(course):
    code, out, errors = call("grade", "3")
    assert (code, errors) == (1, "") and "0 of 100 points" in out and "Next: task 3.1" in out
    code, out, _ = call("grade", "3", "--submission", "solutions", "--json", cwd=course)
    assert code == 0
    assert json.loads(out) == {
        "exercise": 3,
        "points": 100,
        "max_points": 100,
        "banner": "",
        "tasks": [
            {"id": "3.1", "title": "Doubling", "points": 60, "max_points": 60, "message": ""},
            {"id": "3.2", "title": "Adding", "points": 40, "max_points": 40, "message": ""},
        ],
    }


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["grade", "x"], "names no exercise"),
        (["grade", "3."], "names no exercise"),
        (["grade", "3.2.1"], "names no exercise"),
        (["grade", "³"], "names no exercise"),
        (["grade", "4"], "There is no exercise 4; there are 3."),
        (["grade", "3.9"], "its tasks are 3.1, 3.2"),
        (["grade", "3", "--debug"], "--debug runs one task"),
        (["grade", "3", "--submission", "nowhere"], "There is no nowhere"),
        (["hint", "3"], "botschool hint 3.1"),
        (["hint", "3.9"], "its tasks are 3.1, 3.2"),
        (["watch", "5"], "There is no exercise 5"),
        (["release", "course"], "not empty"),
        (["grade-all", "nowhere"], "nowhere cannot be read"),
        (["grade-all", "course/solutions", "-e", "7"], "There is no exercise 7"),
    ],
)
def test_refusals(course, arguments, sentence):
    code, out, errors = call(*arguments, cwd=course.parent)
    assert (code, out) == (2, "")
    assert errors.startswith("error: ") and sentence in " ".join(errors.split())
    assert "Traceback" not in errors


def test_outside_a_course(tmp_path):
    environment = environment_of_command()
    environment.pop("BOTSCHOOL_COURSE", None)
    code, _, errors = call("progress", cwd=tmp_path, env=environment)
    assert code == 2 and "There is no course here" in errors


@pytest.mark.slow
def test_hint(course):
    assert "Hint 1 of 2 for task 3.1" in call("hint", "3.1")[1]
    out = call("hint", "3.1")[1]
    assert "Hint 2 of 2" in out and "3 * array" in out and "last one" in out
    assert "no more hints" in call("hint", "3.1")[1]


def rows_of_progress(*arguments):
    """The table's rows by exercise, and the whole."""
    code, out, errors = call("progress", *arguments, env=environment_of_command(COLUMNS="80"))
    assert (code, errors) == (0, "") and all(len(line) <= 80 for line in out.splitlines())
    return {line.split()[0]: line for line in out.splitlines()}, out


HALF = SOLUTION.replace("float(np.sum", "str(np.sum")


@pytest.mark.slow
def test_progress_grades_when_asked(course):
    (course / "exercises" / FOLDER / FILE).write_text(HALF)
    rows, out = rows_of_progress()
    assert "? " in rows["3"] and "not graded yet" in rows["3"] and "progress --grade" in out
    rows, out = rows_of_progress("--grade")
    assert "1/2" in rows["3"] and " 60 " in rows["3"] and "3.2 Adding" in rows["3"]
    assert "60 of 100 points" in out and "botschool grade 3.2" in out and "--grade" not in out
    assert rows_of_progress() == (rows, out)


@pytest.mark.slow
def test_progress_shows_what_was_graded(course, monkeypatch):
    """Without grading: the points of the last time, and whether the file is still the same."""
    file = course / "exercises" / FOLDER / FILE
    file.write_text(HALF)
    call("grade", "3")
    file.with_name("test_tiny.py").write_text(
        file.with_name("test_tiny.py").read_text().replace("numbers + numbers", "1 / 0")
    )
    rows, _ = rows_of_progress()
    assert " 60 " in rows["3"] and "3.2 Adding" in rows["3"]
    file.write_text(SOLUTION)
    rows, out = rows_of_progress()
    assert " 60 " in rows["3"] and "changed since" in rows["3"] and "progress --grade" in out
    call("grade", "3.2")
    rows, out = rows_of_progress()
    assert " 100 " in rows["3"] and "changed since" in rows["3"]  # 3.1 was graded in another file
    call("reset", "3")
    assert " 0 " in rows_of_progress()[0]["3"]


"""Points that no grading has stored."""


@pytest.mark.slow
def test_watch_grades_after_each_save(course):
    file = course / "exercises" / FOLDER / FILE
    exercise = load_exercise(3, course)
    seen = []

    class Recorder(Screen):
        def start(self, *arguments):
            pass

        def task(self, result):
            seen.append(result.points)

        def end(self, result, whole):
            pass

    def wait(seconds):
        if len(seen) >= 2:
            raise KeyboardInterrupt
        file.write_text(SOLUTION)

    def found():
        return Watched(file, file, [], file.parent)

    with pytest.raises(KeyboardInterrupt):
        watch(exercise, found, exercise.tasks[:1], Recorder(), wait)
    assert seen == [0, 60]


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGINT"), reason="needs signals")
def test_watch_ends_with_ctrl_c(course):
    process = start("watch", "3.1", env=environment_of_command() | {"PYTHONUNBUFFERED": "1"})
    assert any("Ctrl-C ends" in line for line in process.stdout)
    process.send_signal(signal.SIGINT)
    code, _, errors = finish(process, 60)
    assert code == 0 and "Traceback" not in errors


# --- a copy for students


def test_release(course, tmp_path):
    (course / "exercises" / FOLDER / FILE).write_text(SOLUTION)
    (course / "lib" / "x.so").touch()
    (course / "exercises" / FOLDER / ".notes.py").touch()
    done = release(course, tmp_path / "copy")
    names = {
        path.relative_to(tmp_path / "copy").as_posix()
        for path in (tmp_path / "copy").rglob("*")
        if path.is_file()
    }
    assert names == {
        "Makefile", "lib/code.py", "docs/guide.md", MANIFEST,
        *(f"exercises/{FOLDER}/{n}" for n in (FILE, "test_tiny.py", "README.md")),
        f"exercises/{FOLDER}/ANSWERS.packed",
    }  # fmt: skip
    assert done.files == done.written == len(names) - 1
    assert "NotImplementedError" in (tmp_path / "copy" / "exercises" / FOLDER / FILE).read_text()
    with pytest.raises(BotschoolError, match="student's copy already"):
        release(tmp_path / "copy", tmp_path / "again")


@pytest.mark.slow
def test_released_graders_work_and_cannot_be_read(course, tmp_path, monkeypatch):
    release(course, tmp_path / "copy")
    grader = tmp_path / "copy" / "exercises" / FOLDER / "test_tiny.py"
    assert (
        "doubles_many" not in grader.read_text() and "numbers + numbers" not in grader.read_text()
    )
    assert grader.read_text().count("\n") < 40
    mine = submit(tmp_path / "mine", SOLUTION.replace("2 *", "3 *"))
    before = grade(load_exercise(3, course), mine).to_json()
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path / "copy"))
    assert grade(load_exercise(3), mine).to_json() == before
    assert before["points"] == 40


@pytest.mark.parametrize("place", ["lib/code.py", "docs/guide.md", f"exercises/{FOLDER}/mine.py"])
@pytest.mark.parametrize("what", ["region", "line", "answer"])
def test_release_stops_at_a_leak(course, tmp_path, place, what):
    leak = {
        "region": SOLUTION.split("double the numbers\n")[1].split("    ###")[0],
        "line": next(line for line in SOLUTION.splitlines() if "np.sum" in line),
        "answer": (course / "solutions" / FOLDER / "README.md").read_text(),
    }[what]
    (course / place).write_text(f"# a note\n\n      {leak}\n")
    assert find_leaks(course, [course / place])
    with pytest.raises(BotschoolError, match="contains a part of a solution"):
        release(course, tmp_path / "copy")
    assert not list(tmp_path.glob("*copy*"))


def test_release_needs_a_place_of_its_own(course, tmp_path):
    for place in ("lib/copy", "exercises", "solutions/copy"):
        with pytest.raises(BotschoolError):
            release(course, course / place)
    (tmp_path / "file").touch()
    with pytest.raises(BotschoolError, match="is not a folder"):
        release(course, tmp_path / "file")
    (tmp_path / "empty").mkdir()
    assert release(course, tmp_path / "empty").files > 0


@pytest.mark.slow
def test_a_finished_file_is_run_in_results(course):
    made = course.resolve() / "results" / "ex03" / "picture.txt"
    assert show(3, course / "solutions" / FOLDER / FILE, course) == [made]
    code, out, errors = call("show", "3", cwd=course)
    assert code == 2 and out == "" and errors.count("\n") < 4  # a sentence, no traceback
    assert "3.1, 3.2 are not done yet in tiny.py" in " ".join(errors.split())
    own = course / "exercises" / FOLDER / FILE
    own.write_text(SOLUTION + "\n1 / 0\n")
    code, out, errors = call("show", "3", cwd=course)
    assert code == 2 and "ZeroDivisionError" in errors and "ended with an error" in errors
    own.write_text(SOLUTION)
    code, out, errors = call("show", "3", cwd=course)
    assert (code, errors) == (0, "") and "made: results/ex03/picture.txt" in out
    (course / "solutions" / FOLDER / FILE).unlink()
    code, _, errors = call("show", "3", "--submission", "solutions", cwd=course)
    assert code == 2 and "There is no tiny.py" in errors


@pytest.mark.slow
def test_watch_and_show_find_what_grade_finds(course, tmp_path):
    """A renamed file, and a notebook in a zip file."""
    place = tmp_path / "handed-in"
    place.mkdir()
    (place / "tiny (1).py").write_text(SOLUTION)
    code, out, errors = call("show", "3", "--submission", str(place), cwd=course)
    assert code == 0, errors
    assert "Graded: tiny (1).py" in out and "made: results/ex03/picture.txt" in out
    (course / "results" / "ex03" / "picture.txt").unlink()
    (tmp_path / "one.zip").write_bytes(zipped({"work/tiny.ipynb": notebook(SOLUTION)}))
    code, out, errors = call("show", "3", "--submission", str(tmp_path / "one.zip"), cwd=course)
    assert code == 0 and "made: results/ex03/picture.txt" in out, errors
    unbuffered = environment_of_command() | {"PYTHONUNBUFFERED": "1"}
    process = start("watch", "3", "--submission", str(place), env=unbuffered)
    lines = []
    for line in process.stdout:
        lines.append(line)
        if "Ctrl-C ends" in line:
            break
    assert "Graded: tiny (1).py" in "".join(lines) and "100 of 100" in "".join(lines)
    (place / "tiny (1).py").write_text(SOLUTION.replace("2 * ", "3 * "))
    again = []
    for line in process.stdout:
        again.append(line)
        if "Ctrl-C ends" in line:
            break
    assert "40 of 100" in "".join(again)
    process.send_signal(signal.SIGINT)
    assert finish(process, 60)[0] == 0


DRAWING = (
    SOLUTION.split("if __name__")[0]
    + """
import os

if __name__ == "__main__":
    os.makedirs("runs", exist_ok=True)
    open("runs/a", "w").close()
    open("runs/b", "w").close()
    for name in ("a curve.png", "film.mp4", "replay.html", "table.csv"):
        open(name, "w").close()
"""
)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="displays of Linux")
def test_show_opens_what_was_made(course, tmp_path):
    (course / "exercises" / FOLDER / FILE).write_text(DRAWING)
    browser, opened = tmp_path / "browser", tmp_path / "opened"
    browser.write_text(f'#!/bin/sh\necho "$1" >>{opened}\n')
    browser.chmod(0o755)
    there = environment_of_command(BROWSER=str(browser), DISPLAY=":0", MPLBACKEND="Agg")
    nowhere = {k: v for k, v in there.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")}
    page = course.resolve() / "results" / "ex03" / "all.html"
    for arguments, env in ((["--no-open"], there), ([], nowhere)):
        code, out, errors = call("show", "3", *arguments, cwd=course, env=env)
        assert (code, errors) == (0, "") and not opened.exists()
        assert "made: results/ex03/table.csv" in out and "made: results/ex03/runs  (2 files)" in out
        assert "all on one page: results/ex03/all.html" in out
        assert "Your own experiment comes next: botschool lab 3 start" in out
    code, out, _ = call("show", "3", cwd=course, env=there)
    assert code == 0 and "opened: results/ex03/all.html" in out
    assert opened.read_text() == f"{page.as_uri()}\n"
    text = page.read_text()
    assert '<img src="data:image/png' in text and '<video src="data:video/mp4' in text
    assert "<iframe" in text and "all.html" not in text and "csv" not in text


@pytest.mark.slow
def test_answers_after_full_marks(course, tmp_path, monkeypatch):
    copy = tmp_path / "copy"
    release(course, copy, with_answers=False)
    file = copy / "exercises" / FOLDER / FILE
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(copy))

    def refused(words):
        code, out, errors = call("show", "3", "--answers")
        one_sentence(code, errors, words)
        assert out == ""

    refused("This copy has no answers")
    assert release(course, copy, with_answers=True).written == 1
    packed = file.with_name("ANSWERS.packed")
    assert "measured" not in packed.read_text()
    refused("0 of 100")
    file.write_text(HALF)
    call("grade", "3")
    refused("60 of 100")
    file.write_text(SOLUTION)
    refused("60 of 100")
    call("grade", "3")
    code, out, errors = call("show", "3", "--answers")
    assert (code, errors) == (0, "") and "Twice two is four, as was measured." in out
    assert "show 3 --answers" in call("show", "3", "--no-open")[1]
    release(course, copy)  # what was given stays
    assert call("show", "3", "--answers")[1] == out
    packed.write_text("nothing")
    refused("damaged")


@pytest.mark.slow
@pytest.mark.parametrize("released", [False, True])
def test_start_and_reset(course, tmp_path, monkeypatch, released):
    root = course
    if released:
        root = tmp_path / "copy"
        release(course, root)
        monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    file = root / "exercises" / FOLDER / FILE
    skeleton = file.read_text()
    code, out, _ = call("start", "3", cwd=root)
    assert code == 0 and "Exercise 3. Tiny" in out and f"exercises/{FOLDER}/README.md" in out
    assert "botschool start 3 --notebook" in out
    assert "back at its beginning.\n" in call("reset", "3", cwd=root)[1]
    for number in (1, 2):
        file.write_text(f"{SOLUTION}# {number}\n")
        code, out, _ = call("reset", "3", cwd=root)
        kept = file.with_name(f"tiny_old{number}.py")
        assert code == 0 and kept.name in out and file.read_text() == skeleton
        assert kept.read_text() == f"{SOLUTION}# {number}\n"
    file.unlink()
    code, out, _ = call("start", "3", cwd=root)
    assert code == 0 and "botschool has made it" in out and file.read_text() == skeleton
    if released:
        (root / MANIFEST).unlink()
        file.write_text(SOLUTION)
        code, _, errors = call("reset", "3", cwd=root)
        assert code == 2 and "is not kept here" in errors and file.read_text() == SOLUTION


# --- a class

SCRIPT = "<script>alert(1)</script>"


@pytest.fixture
def class_(tmp_path):
    folder = tmp_path / "class"
    good = submit(folder / "ada", SOLUTION)
    (good.parent / "curve.png").write_bytes(PNG)
    submit(folder / "bob & <i>", f"print({SCRIPT!r})\ndef double(x): raise ValueError({SCRIPT!r})")
    submit(folder / "=1+1", "import os; os._exit(0)")
    submit(folder / "new\nline", "this is no Python")
    submit(folder / "con", "")
    (folder / "empty").mkdir()
    (folder / "flat").mkdir()
    (folder / "flat" / FILE).write_text(SOLUTION)
    (folder / "copied").mkdir()
    submit(folder / "copied" / "exercises", SOLUTION)
    (folder / "linked").symlink_to(folder / "ada")
    (folder / "sly").mkdir()
    (folder / "sly" / FOLDER).symlink_to(folder / "ada" / FOLDER)
    (folder / ".hidden").mkdir()
    (folder / "notes.txt").touch()
    return folder


class Page(HTMLParser):
    """Tags and attributes of a page."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.sources = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.tags.append(tag)
        self.sources += [value for name, value in attributes if name in ("src", "href")]


@pytest.mark.slow
def test_grade_all(course, class_, tmp_path):
    output = tmp_path / "out"
    code, out, errors = call("grade-all", class_, "-e", "3", "-o", output, "-w", "2")
    assert (code, errors) == (0, "") and "10 submissions" in out
    with open(output / "grades.csv", encoding="utf-8-sig", newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    totals = {student: int(row["total"]) for student, row in rows.items()}
    assert totals == {
        "ada": 100, "bob & <i>": 0, "'=1+1": 0, "new line": 0, "con": 0, "empty": 0, "flat": 100,
        "copied": 100, "linked": 0, "sly": 0,
    }  # fmt: skip
    assert rows["ada"]["3.1"] == "60" and rows["ada"]["exercise 3"] == "100"
    for student, note in (("linked", "a link"), ("sly", "a link"), ("empty", "no tiny.py")):
        assert note in rows[student]["notes"]
    for row in rows.values():
        page = Page((output / row["feedback"].lstrip("'")).read_text(encoding="utf-8"))
        assert "script" not in page.tags and "i" not in page.tags[page.tags.index("h1") :][1:3]
        assert all(source.startswith("data:image/png;base64,") for source in page.sources)
    assert "data:image/png" in (output / rows["ada"]["feedback"]).read_text()
    assert "&lt;script&gt;" in (output / rows["bob & <i>"]["feedback"]).read_text()
    assert len(list((output / "feedback").iterdir())) == 10


@pytest.mark.slow
def test_grade_all_overwrites_only_its_own(course, class_, tmp_path):
    output = tmp_path / "out"
    grade_all(class_, output, {3: ()}, course, 2, False)
    (output / "mine.txt").write_text("mine")
    before = (output / "grades.csv").read_bytes()
    grade_all(class_, output, {3: ()}, course, 2, False)
    assert (output / "grades.csv").read_bytes() == before
    assert (output / "mine.txt").read_text() == "mine"
    (output / "grades.csv").write_text("my own table")
    with pytest.raises(BotschoolError, match="not made by grade-all"):
        grade_all(class_, output, {3: ()}, course, 2, False)
    (output / "grades.csv").unlink()
    (output / "feedback" / "ada.html").write_text("my letter to Ada")
    with pytest.raises(BotschoolError, match="not made by grade-all"):
        grade_all(class_, output, {3: ()}, course, 2, False)
    assert (output / "feedback" / "ada.html").read_text() == "my letter to Ada"


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="needs its signals")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGHUP, signal.SIGKILL])
def test_grade_all_leaves_nothing_running(course, tmp_path, number, request):
    """However it ends: its graders, their fork servers and the submissions end, too."""
    # where the tests run under nohup, the command would ignore a closed terminal as they do
    before = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    request.addfinalizer(lambda: signal.signal(signal.SIGHUP, before))
    grader = course / "exercises" / FOLDER / "test_tiny.py"
    grader.write_text(grader.read_text().replace("seconds=2", "seconds=300"))
    for name in ("ada", "bob"):
        submit(tmp_path / "class" / name, "def double(x):\n    while True: pass\n")
    temporary = tmp_path / "tmp"
    temporary.mkdir()
    process = start(
        "grade-all", tmp_path / "class", "-e", "3", "-o", tmp_path / "out", "-w", "2",
        env=environment_of_command() | {"TMPDIR": str(temporary)},
    )  # fmt: skip
    own = psutil.Process(process.pid)
    deadline = time.monotonic() + 120
    while len(own.children(recursive=True)) < 6:  # two times grader, fork server, submission
        assert time.monotonic() < deadline and process.poll() is None
        time.sleep(0.2)
    started = own.children(recursive=True)
    process.send_signal(number)
    code, _, errors = finish(process, 30)
    assert code == (-number if number == signal.SIGKILL else 128 + number)
    assert "Traceback" not in errors
    assert psutil.wait_procs(started, timeout=30)[1] == []
    if number != signal.SIGKILL:
        assert list(temporary.iterdir()) == []


@pytest.mark.slow
def test_grade_all_makes_a_secret_and_keeps_it(course, tmp_path, monkeypatch):
    monkeypatch.delenv("BOTSCHOOL_GRADING_SEED", raising=False)
    show_seed = "def double(x): raise ValueError(float(x.ravel()[0]))\ndef total(x): return 0\n"
    submit(tmp_path / "class" / "ada", show_seed)
    arguments = ("grade-all", tmp_path / "class", "-e", "3", "-o", tmp_path / "out")

    def grade_class():
        code, out, errors = call(*arguments)
        assert (code, errors) == (0, "")
        return " ".join(out.split()), (tmp_path / "out" / "feedback" / "ada.html").read_text()

    out, first = grade_class()
    secret = course / ".botschool" / "secret"
    assert f"made a secret for the grading seeds and keeps it in {secret}" in out
    assert len(secret.read_text().strip()) == 32 and secret.stat().st_mode & 0o77 == 0
    out, again = grade_class()
    assert f"follow from the secret in {secret}." in out and again == first
    secret.write_text("another secret of ours\n")
    assert grade_class()[1] != first
    monkeypatch.setenv("BOTSCHOOL_GRADING_SEED", "another secret of ours")
    out, own = grade_class()
    assert str(secret) not in out
    secret.unlink()
    assert grade_class()[1] == own and not secret.exists()


# --- a system that cannot confine


def without(*numbers):
    """A filter under which these system calls seem not to exist, for child processes too."""
    answer = (0x06, 0, 0, 0x00050000 | 38)  # ENOSYS
    code = [(0x20, 0, 0, 0)]
    for number in numbers:
        code += [(0x15, 0, 1, number), answer]
    return [*code, (0x06, 0, 0, 0x7FFF0000)]


@pytest.mark.slow
@pytest.mark.skipif(
    platform.machine() != "x86_64" or sys.platform != "linux", reason="Linux, x86-64"
)
@pytest.mark.parametrize(
    ("absent", "words"),
    [((444, 445, 446), "submission's files"), ((317, 157), "files, processes and network")],
)
def test_grading_goes_on_without_confinement(course, absent, words):
    def before():
        libc = ctypes.CDLL(None)
        libc.prctl(38, 1, 0, 0, 0)
        seccomp.install(libc, without(*absent))

    process = subprocess.run(
        [sys.executable, "-m", "botschool", "grade", "3", "--submission", "solutions"],
        cwd=course, env=environment_of_command(), preexec_fn=before,
        capture_output=True, text=True, timeout=60,
    )  # fmt: skip
    assert process.returncode == 0, process.stderr
    out = " ".join(process.stdout.split())
    assert "100 of 100 points" in out
    assert out.count("Notice:") == 1 and words in out
