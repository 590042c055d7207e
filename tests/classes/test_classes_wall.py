"""What one student hands in neither stops the grading of a class nor counts as somebody else's."""

import bz2
import gzip
import io
import lzma
import os
import shutil
import signal
import struct
import subprocess
import tarfile
from pathlib import Path

import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes import wall
from botschool.grading.classes.choice import Wanted, find_submissions
from botschool.grading.classes.download import one_person, read_download
from botschool.grading.classes.files import numbered_folders
from botschool.grading.classes.times import told_by
from botschool.grading.classes.wall import Broken, walled
from exports import of_tar, written, zipped
from running import call
from tiny_course import FILE, SOLUTION, make_course

WORK = SOLUTION.encode()


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def find(course, tmp_path):
    """Gives what is found in a download, by the person's name."""

    def of(files):
        new_folder, wanted = numbered_folders(tmp_path / "unpacked"), [Wanted(3, FILE, course)]
        export = read_download(written(tmp_path / "class", files), wanted, new_folder)
        found = find_submissions(export.people, wanted, course, new_folder)
        return {one.student: one for one in found}

    return of


# --- the wall
def uses_memory():
    return len(bytearray(3 * 2**30))


def runs_on():
    while True:
        pass


def recurses():
    return recurses()


@pytest.mark.slow
@pytest.mark.parametrize(
    ("read", "sentence", "ours"),
    [
        (lambda: int("1" * 5000), "ValueError: Exceeds the limit", False),
        (lambda: exec("raise SystemExit(3)"), "SystemExit: 3", False),
        (recurses, "RecursionError", False),
        (uses_memory, "more than 1024 MB of memory", False),
        (runs_on, "more than 1 seconds", False),
        (lambda: os.kill(os.getpid(), signal.SIGUSR1), "ends Python by signal", False),
        (lambda: os._exit(0), "memory", False),
        (lambda: os.kill(os.getpid(), signal.SIGKILL), "too little time or memory", True),
        (lambda: Path("/dev/full").write_bytes(b"x"), "No space left", True),
        (lambda: lambda: 0, "pickle", False),
    ],
)
def test_whatever_happens_to_a_reader_is_a_sentence(monkeypatch, read, sentence, ours):
    monkeypatch.setattr(wall, "SECONDS", 1)
    monkeypatch.setattr(wall, "SLOWER", 100)
    with pytest.raises(Broken, match=sentence) as found:
        walled(read)
    assert found.value.ours == ours


def test_an_answer_comes_through_the_wall():
    assert walled(lambda size: bytes(size), 3_000_000) == bytes(3_000_000)


@pytest.mark.slow
def test_one_broken_exercise_costs_only_its_owner(find, monkeypatch):
    choose = Wanted.choose

    def breaks(self, handed, *arguments):
        if any(file.shown == "poison" for file in handed.files):
            raise LookupError("poison")
        return choose(self, handed, *arguments)

    monkeypatch.setattr(Wanted, "choose", breaks)
    found = find({f"ada/{FILE}": WORK, f"eve/{FILE}": WORK, "eve/poison": b"x"})
    assert found["ada"].choices[3].file
    assert "(LookupError: poison)" in found["eve"].choices[3].problem
    assert not found["eve"].choices[3].unread


def many_entries(count):
    """A zip file that lists one stored file many times, and says that it is few."""
    name, fixed = b"a", struct.pack("<HHIIIHH", 0, 33, 0, 0, 0, 1, 0)
    local = b"PK\x03\x04" + struct.pack("<HHH", 20, 0, 0) + fixed + name
    entry = b"PK\x01\x02" + struct.pack("<HHHH", 20, 20, 0, 0) + fixed + bytes(12) + name
    size = len(entry) * count
    end = b"PK\x05\x06" + struct.pack("<HHHHIIH", 0, 0, 1, 1, size, len(local), 0)
    return local + entry * count + end


def links(count):
    content = io.BytesIO()
    with tarfile.open(fileobj=content, mode="w:gz", compresslevel=1) as archive:
        for number in range(count):
            info = tarfile.TarInfo(f"{number}.py")
            info.type, info.linkname = tarfile.SYMTYPE, "x"
            archive.addfile(info)
    return content.getvalue()


def damaged_zip(at, new):
    """A zip file whose list has other bytes at a place of its entry."""
    content = zipped({FILE: WORK})
    at += content.rindex(b"PK\x01\x02")
    return content[:at] + new + content[at + len(new) :]


DAMAGED = {
    "bz2": (f"{FILE}.bz2", bz2.compress(WORK * 99)[:60] + b"x" * 60),
    "gz": (f"{FILE}.gz", gzip.compress(WORK)[:20] + b"x" * 60),
    "xz": (f"{FILE}.xz", lzma.compress(WORK)[:20] + b"x" * 60),
    "tar": ("w.tar.gz", gzip.compress(gzip.decompress(of_tar({FILE: WORK}))[:500])),
    "zip": ("w.zip", zipped({FILE: WORK}).replace(b"PK\x01\x02", b"PK\x01\x03")),
    "method": ("w.zip", damaged_zip(10, b"\x63")),
    "offset": ("w.zip", damaged_zip(42, b"\xff\xff\xff")),
    "checksum": ("w.zip", damaged_zip(16, b"\0\0\0\0")),
    "many entries": ("w.zip", many_entries(300_000)),
    "many links": ("w.tgz", lambda: links(20_001)),
    "long path": ("w.zip", zipped({"/".join(29 * ["d" * 239]) + f"/{FILE}": WORK})),
}


@pytest.mark.slow
@pytest.mark.parametrize("kind", DAMAGED)
def test_a_damaged_archive_is_no_work_and_not_left_ungraded(find, kind):
    name, content = DAMAGED[kind]
    content = content() if callable(content) else content
    found = find({f"ada/{FILE}": WORK, f"eve/{name}": content})
    assert found["ada"].choices[3].file
    assert found["eve"].choices[3].problem and not found["eve"].choices[3].unread
    assert name in " ".join(found["eve"].notes)


@pytest.mark.parametrize("kind", ["many entries", "zip"])
def test_a_damaged_zip_file_beside_folders_is_its_owners(find, kind):
    found = find({f"ada/{FILE}": WORK, "eve.zip": DAMAGED[kind][1]})
    assert set(found) == {"ada", "eve"} and not found["eve"].files


@pytest.mark.slow
@pytest.mark.parametrize(
    "name", [b"eve_5_9_\xff.py", b"eve\xff_5_9_x.py", b"Eve\xff_7_assignsubmission_file_x.py"]
)
def test_a_name_that_is_no_utf8_stops_nothing(course, tmp_path, name):
    other = "ada_4_8_" if name.startswith(b"eve") else "Ada_8_assignsubmission_file_"
    written(tmp_path / "class", {f"{other}{FILE}": WORK})
    (tmp_path / "class" / os.fsdecode(name)).write_bytes(WORK)
    code, out, errors = call("grade-all", tmp_path / "class", "-e", "3.1", "-o", tmp_path / "out")
    assert (code, errors) == (0, "") and "2 submissions, 60.0 of 60" in out


# --- names of platforms that a student chooses
MOODLE, CANVAS = f"ada_77_assignsubmission_file_/{FILE}", f"ada_4_8_{FILE}"
ATTEMPT = f"ada_attempt_2026-11-20-21-14-03_{FILE}"
INSIDE = {
    "Moodle": {MOODLE: WORK},
    "Canvas": {CANVAS: WORK},
    "Gradescope": {f"submission_5/{FILE}": WORK, "submission_metadata.yml": b"{[\n"},
    "an attempt": {ATTEMPT: WORK},
    "repositories": {f"{who}/{name}": WORK for who in ("ada", "bob") for name in (".git/x", FILE)},
    "sections": {f"a/{MOODLE}": WORK, f"b/{MOODLE}": WORK},
    "nbgrader": {f"submitted/ada/ex03/{FILE}": WORK, "nbgrader_config.py": b""},
}  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize("as_zip", [False, True], ids=["folder", "zip"])
@pytest.mark.parametrize("kind", INSIDE)
def test_a_class_within_a_submission_is_its_owners(find, kind, as_zip):
    files = INSIDE[kind]
    inside = {"eve.zip": zipped(files)} if as_zip else {f"eve/{k}": v for k, v in files.items()}
    assert set(find({f"ada/{FILE}": b"x = 1\n"} | inside)) == {"ada", "eve"}


@pytest.mark.parametrize(
    ("others", "name"),
    [
        (CANVAS, f"eve_5_9_{MOODLE.replace('/', '')}"),
        (CANVAS, f"eve_5_9_{ATTEMPT}"),
        (CANVAS, "eve_5_9_x_assignfeedback_x.py"),
        (MOODLE, f"eve_5_assignsubmission_file_{CANVAS}"),
        (ATTEMPT, f"eve_attempt_2026-11-20-21-14-03_{ATTEMPT}"),
        (ATTEMPT, f"x_eve_attempt_2026-11-20-21-14-03_{MOODLE.replace('/', '')}"),
    ],
)
def test_the_end_of_a_files_name_is_the_students(find, others, name):
    assert set(find({others: WORK, name: WORK})) == {"ada", "eve"}


def test_a_bad_list_within_one_submission_is_no_download(course, tmp_path):
    place = written(tmp_path / "eve", INSIDE["Gradescope"])
    assert one_person(place, numbered_folders(tmp_path / "new")).student == "submission_5"
    with pytest.raises(BotschoolError, match="is damaged: download it again"):
        read_download(place, [Wanted(3, FILE, course)], numbered_folders(tmp_path / "new"))


def commit(folder, day):
    """Commit all files of a folder on a day of June 2026."""
    when = f"2026-06-{day:02}T12:00:00"
    environment = os.environ | {"GIT_COMMITTER_DATE": when, "GIT_AUTHOR_DATE": when}
    for command in (["init", "-q"], ["add", "-Af"], ["commit", "-qm", "x"]):
        git = ["git", "-c", "user.name=x", "-c", "user.email=x@x", *command]
        subprocess.run(git, cwd=folder, env=environment, check=True)


def packed_clone(tmp_path):
    """A zip file with a repository of June 2."""
    inner = written(tmp_path / "inner", {FILE: WORK})
    commit(inner, 2)
    paths = [path for path in inner.rglob("*") if path.is_file()]
    return zipped({path.relative_to(inner).as_posix(): path.read_bytes() for path in paths})


EARLY = b"2026-06-01 10:00:00 UTC"


@pytest.mark.skipif(shutil.which("git") is None, reason="there is no git")
@pytest.mark.parametrize(
    ("files", "clone", "day"),
    [
        ({FILE: WORK}, "", 20),
        ({FILE: WORK, "timestamp.txt": EARLY}, "", 20),
        ({f"ex03/{FILE}": WORK, "ex03/timestamp.txt": EARLY}, "", 20),
        ({"w.zip": zipped({FILE: WORK, "timestamp.txt": EARLY})}, "", 20),
        ({"w.zip": packed_clone}, "", 20),
        ({FILE: WORK, "timestamp.txt": EARLY}, None, 1),
        ({f"ex03/{FILE}": WORK, "ex03/timestamp.txt": EARLY}, None, 1),
        ({f"ex03/my/{FILE}": WORK, "ex03/my/timestamp.txt": EARLY}, None, None),
        ({"w.zip": zipped({FILE: WORK, "timestamp.txt": EARLY})}, None, None),
        ({"w.zip": packed_clone}, None, None),
    ],
)
def test_only_what_a_platform_writes_tells_the_time(find, tmp_path, files, clone, day):
    """clone: the folder with a commit of June 20; None for nbgrader's folder."""
    made = {name: each(tmp_path) if callable(each) else each for name, each in files.items()}
    top = "submitted/" * (clone is None)
    if clone is not None:
        commit(written(tmp_path / "class" / "eve", made), 20)
    find_files = {f"{top}{name}": WORK for name in (f"ada/{FILE}",)}
    found = find(find_files | {f"{top}eve/{name}": content for name, content in made.items()})
    moment = told_by(found["eve"].choices[3].origin)
    assert (moment and moment.day) == day


def test_a_repository_within_nbgraders_folder_tells_no_time(find, tmp_path):
    files = {f"submitted/eve/ex03/{FILE}": WORK, "submitted/eve/ex03/timestamp.txt": EARLY}
    commit(written(tmp_path / "class", files) / "submitted" / "eve" / "ex03", 20)
    moment = told_by(find({f"submitted/ada/{FILE}": WORK})["eve"].choices[3].origin)
    assert moment.day == 1
