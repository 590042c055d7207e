"""Exports of learning platforms: who is in them, and which file of each is graded."""

import gzip
import io
import json
import os
import shutil
import tarfile
import time
import warnings
import zipfile
from pathlib import Path

import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes.choice import Wanted, find_submissions
from botschool.grading.classes.download import one_person, read_download
from botschool.grading.classes.files import numbered_folders
from botschool.grading.classes.policy import read_policy
from botschool.grading.classes.register import Register
from botschool.grading.classes.rules import Policy
from botschool.grading.classes.texts import decoded, text_of_page
from botschool.grading.classes.unpack import Room, Unpackable, unpack
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.run.notebooks import code_cells
from exports import (
    PLATFORMS,
    Handed,
    class_of,
    gradescope,
    moodle,
    notebook,
    of_tar,
    saved,
    variations,
    written,
    zipped,
)
from running import call
from tiny_course import FILE, FOLDER, SOLUTION, make_course, submit

SKELETON = skeleton(SOLUTION)
WAYS = variations(FILE, SOLUTION, SKELETON)
PLAIN = {"plain", "in the exercise's folder", "line ends of Windows", "with what systems leave",
         "a virtual environment"}  # fmt: skip
"""Ways of which nothing need be said, wherever they are handed in."""


@pytest.fixture
def course(tmp_path, monkeypatch):
    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return root


@pytest.fixture
def find(course, tmp_path):
    """Gives what is found in a download, by the person's name, and the export."""

    def of(download):
        folder = tmp_path / "unpacked"
        shutil.rmtree(folder, ignore_errors=True)
        new_folder, wanted = numbered_folders(folder), [Wanted(3, FILE, course)]
        export = read_download(download, wanted, new_folder)
        register = Register(find_submissions(export.people, wanted, course, new_folder), Policy())
        named = {row.name: row.parts[0] for row in register.rows}
        assert len(named) == len(export.people)
        return named, export

    return of


def is_solution(file):
    """Whether the code to grade is the solution, in a file of the right name."""
    if file.suffix == ".ipynb":
        text = "\n".join(code_cells(file))
    else:
        assert file.name == FILE
        text = file.read_bytes().decode("utf-8").replace("\r\n", "\n")
    lines = [line for line in text.splitlines() if line.strip() and not line.startswith("#")]
    return lines == [line for line in SOLUTION.splitlines() if line.strip()]


@pytest.mark.slow
@pytest.mark.parametrize("as_zip", [False, True], ids=["folder", "zip"])
@pytest.mark.parametrize("platform", PLATFORMS)
def test_nobody_vanishes_and_the_solution_is_found(find, tmp_path, platform, as_zip):
    people = class_of(FILE, SOLUTION, SKELETON)
    if platform == "moodle loose":  # where folders of a submission are lost
        people = [one for one in people if not any("/" in name for name in one.files)]
    files = PLATFORMS[platform](people)
    files |= {"__MACOSX/._x": b"x", ".DS_Store": b"x"}
    target = tmp_path / "download"
    found, export = find(saved(target, files) if as_zip else written(target, files))
    assert len(found) == len(people)
    named = {one.student.replace(" ", "").lower(): one for one in found.values()}
    for one, (way, _) in zip(class_of(FILE, SOLUTION, SKELETON), WAYS.items(), strict=True):
        if one not in people:
            continue
        key = one.name.replace(" ", "").lower()
        if platform == "canvas":
            key = "".join(one.name.lower().split()[::-1])
        elif platform == "github":
            key = "tiny-" + "".join(letter for letter in key if letter.isascii())
        choice = named[key].choices[3]
        assert choice.file is not None and is_solution(choice.file), (way, choice.problem)
        said = [*choice.notes, *named[key].notes]
        assert bool(said) or way in PLAIN | {"with a report", "the whole course"}, way
        if way in PLAIN and not (platform == "canvas" and any("/" in name for name in one.files)):
            assert not said, (way, said)
    assert export.notes == []


@pytest.mark.parametrize("way", WAYS)
def test_one_folder_is_found_as_in_a_class(course, tmp_path, way):
    place = written(tmp_path / "anna", WAYS[way])
    new_folder = numbered_folders(tmp_path / "unpacked")
    (one,) = find_submissions(
        [one_person(place, new_folder)], [Wanted(3, FILE, course)], course, new_folder
    )
    assert is_solution(one.choices[3].file)


def test_what_is_not_used_is_said(find, tmp_path):
    files = {FILE: SKELETON.encode(), "tiny_final.py": SOLUTION.encode(), "notes/diary.docx": b"x",
             "tiny_old.py": b"def double(x): return x\n",
             "work.rar": b"Rar!\x1a\x07\x01"}  # fmt: skip
    found, _ = find(written(tmp_path / "class", moodle([Handed("Ada L", files)])))
    (one,) = found.values()
    said = " ".join([*one.choices[3].notes, *one.notes])
    assert is_solution(one.choices[3].file)
    for name in ("Graded: tiny_final.py", "Not used: tiny_old.py", "nothing in it was changed",
                 "diary.docx", "work.rar is a RAR archive, so it stays packed"):  # fmt: skip
        assert name in said


def test_the_skeleton_alone_is_graded_and_said(find, tmp_path):
    found, _ = find(written(tmp_path / "class", {f"ada/{FILE}": SKELETON.encode()}))
    assert found["ada"].choices[3].notes == [f"Nothing was changed in {FILE}."]


def test_the_newest_attempt_that_was_changed_is_graded(find, tmp_path):
    half = SOLUTION.replace("2 * numbers", "3 * numbers")
    for last, right in ((SOLUTION, SOLUTION), (SKELETON, half)):
        tries = [{FILE: SOLUTION.encode()}, {FILE: half.encode()}]
        one = Handed("Ada L", {FILE: last.encode()}, late=True, attempts=tries)
        shutil.rmtree(tmp_path / "class", ignore_errors=True)
        found, _ = find(written(tmp_path / "class", PLATFORMS["canvas"]([one])))
        assert found["lada"].late
        assert found["lada"].choices[3].file.read_text() == right
        assert any("Not used" in note for note in found["lada"].choices[3].notes)


def test_a_copy_of_jupyter_is_no_attempt_of_canvas(find, tmp_path):
    half = SOLUTION.replace("2 * numbers", "3 * numbers")
    files = {"tiny.ipynb": notebook(SOLUTION), "tiny-Copy1.ipynb": notebook(half)}
    found, _ = find(written(tmp_path / "class", PLATFORMS["canvas"]([Handed("Ada L", files)])))
    assert is_solution(found["lada"].choices[3].file)


def test_text_that_was_typed_into_a_page_is_graded(find, tmp_path):
    found, _ = find(written(tmp_path / "class", moodle([Handed("Ada L", {}, typed=SOLUTION)])))
    choice = found["Ada L"].choices[3]
    assert is_solution(choice.file) and choice.notes == ["Graded: the text that was typed in."]
    assert text_of_page("<pre>def f(x):\n    return x &lt; 1</pre>") == (
        "def f(x):\n    return x < 1\n"
    )
    assert text_of_page("<p>if x:</p><p>&nbsp; &nbsp; y()</p>") == "if x:\n    y()\n"


@pytest.mark.slow
@pytest.mark.parametrize("part", ["<a ", "<!--", "</", "<div>", "<pre>", "<a b='", "&#", "<?"])
def test_a_hostile_page_takes_no_time(part):
    """Python's parser of pages took minutes for 30 kB of "<a "."""
    began = time.process_time()
    text_of_page(part * 200_000)
    assert time.process_time() - began < 5


def test_a_group_has_a_row_for_each(find, tmp_path):
    metadata = (
        "submission_7:\n  :submitters:\n  - :name: Ada\n    :email: a@b.c\n  - :name: Bob\n"
        "  :created_at: !ruby/object:ActiveSupport::TimeWithZone\n    utc: 2026-11-20 21:14:03 Z\n"
    )
    written(tmp_path / "class" / "submission_7", {FILE: SOLUTION.encode()})
    written(tmp_path / "class" / "submission_8", {FILE: SOLUTION.encode()})
    (tmp_path / "class" / "submission_metadata.yml").write_text(metadata)
    found, _ = find(tmp_path / "class")
    assert set(found) == {"Ada", "Bob", "submission_8"}
    assert found["Ada"].choices[3].file == found["Bob"].choices[3].file
    assert found["Ada"].about["submitter's email"] == "a@b.c"


@pytest.mark.parametrize("metadata", ["- submission_7", "words", "7"])
def test_data_of_submissions_that_are_none_are_a_sentence(find, tmp_path, metadata):
    written(tmp_path / "class" / "submission_7", {FILE: SOLUTION.encode()})
    (tmp_path / "class" / "submission_metadata.yml").write_text(metadata)
    with pytest.raises(BotschoolError, match="does not list submissions"):
        find(tmp_path / "class")


@pytest.mark.parametrize("about", [":submitters: 5", ":created_at: 0001-01-01T00:00:00+23:59"])
def test_odd_data_of_a_submission_do_not_lose_it(find, tmp_path, about):
    written(tmp_path / "class" / "submission_7", {FILE: SOLUTION.encode()})
    (tmp_path / "class" / "submission_metadata.yml").write_text(f"submission_7:\n  {about}\n")
    found, _ = find(tmp_path / "class")
    assert set(found) == {"submission_7"}


def test_files_of_a_persons_own_stay_beside_what_is_graded(find, tmp_path):
    files = {"tiny (1).py": SOLUTION.encode(), "helper.py": b"x = 1\n", "data/weights.npy": b"9"}
    found, _ = find(written(tmp_path / "class", {f"ada/w/{k}": v for k, v in files.items()}))
    folder = found["ada"].choices[3].file.parent
    assert sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()) == [
        "data/weights.npy", "helper.py", FILE,
    ]  # fmt: skip


def test_clones_that_lie_deeper_and_loose_files_are_people(find, tmp_path):
    top = tmp_path / "class"
    for name in ("anna", "bert"):
        written(top / "monday" / f"tiny-{name}", {".git/HEAD": b"x", FILE: SOLUTION.encode()})
    written(top, {"carl.py": SOLUTION.encode(), "dora.zip": zipped({FILE: SOLUTION.encode()}, "x/"),
                  "notes.txt": b"hello", "eve.ipynb": notebook(SOLUTION)})  # fmt: skip
    found, export = find(top)
    assert set(found) == {"tiny-anna", "tiny-bert", "carl", "dora", "eve"}
    assert all(is_solution(one.choices[3].file) for one in found.values())
    assert export.nobodys == ["notes.txt"]


def test_a_copy_of_the_course_is_one_submission(find, tmp_path):
    path = saved(tmp_path / "ada.zip", {f"course/exercises/{FOLDER}/{FILE}": SOLUTION.encode()})
    found, _ = find(path)
    assert set(found) == {"ada"} or set(found) == {"course"}
    (one,) = found.values()
    assert is_solution(one.choices[3].file)


def test_a_module_of_the_library_is_nobodys_work(find, tmp_path):
    """openaies.py of the library was graded in place of a half-done openai_es.py."""
    half = SKELETON.replace("def ", "X = 1\n\n\ndef ", 1)
    for top in ("", "course/"):
        files = {f"{top}exercises/{FOLDER}/{FILE}": half.encode()}
        files |= {
            f"{top}{place}/{FILE}": SOLUTION.encode() for place in ("lib/more", "solutions/x")
        }
        found, _ = find(written(tmp_path / f"download{len(top)}", files_of("anna", files)))
        assert found["anna"].choices[3].file.read_text() == half


def files_of(name, files):
    return {f"{name}/{place}": content for place, content in files.items()}


def test_an_unreadable_notebook_and_an_empty_folder_are_said(find, tmp_path):
    written(tmp_path / "class", {"ada/tiny.ipynb": b'{"cells": ', "bob/essay.docx": b"x"})
    (tmp_path / "class" / "carl").mkdir()
    found, _ = find(tmp_path / "class")
    assert "tiny.ipynb is not a readable notebook" in found["ada"].choices[3].problem
    assert "There is no tiny.py. Handed in: essay.docx." in found["bob"].choices[3].problem
    assert found["carl"].choices[3].problem == "There is no tiny.py."


# --- what must not be followed or filled
def test_links_are_not_followed(find, tmp_path):
    secret = tmp_path / "secret.py"
    secret.write_text(SOLUTION)
    top = written(tmp_path / "class", {"ada/notes.txt": b"x", "bob/x.txt": b"x"})
    (top / "ada" / "tiny (1).py").symlink_to(secret)
    (top / "bob" / FOLDER).symlink_to(tmp_path)
    (top / "carl").symlink_to(top / "ada")
    (top / f"dlee_1_2_{FILE}").symlink_to(secret)
    found, _ = find(top)
    assert not any(one.files for one in found.values())
    assert "link" in found["carl"].choices[3].problem + found["bob"].choices[3].problem


def linked(name, target):
    info = zipfile.ZipInfo(name)
    info.create_system, info.external_attr = 3, 0o120777 << 16
    return info, target


def test_zip_files_stay_within_their_folder_and_limits(find, tmp_path):
    path = tmp_path / "evil.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("../outside.py", "x")
        archive.writestr("/absolute.py", "x")
        archive.writestr("a/../../b.py", "x")
        archive.writestr("C:\\windows.py", "x")
        archive.writestr(*linked("ada/link.py", "/etc/passwd"))
        archive.writestr("ada/tiny.py", SOLUTION)
        archive.writestr("ada/tiny.py/inside", "x")
    before = set(tmp_path.iterdir())
    target = tmp_path / "target"
    left_out = unpack(path, target, Room(10**6, 100))
    assert left_out == ["ada/link.py", "ada/tiny.py/inside"]  # others lose what leads elsewhere
    inside = {path.relative_to(target).as_posix() for path in target.rglob("*.py")}
    assert inside == {"outside.py", "absolute.py", "a/b.py", "windows.py", "ada/tiny.py"}
    assert (target / "ada" / "tiny.py").read_text() == SOLUTION
    assert set(tmp_path.iterdir()) == before | {target}
    assert [p for p in target.rglob("*") if p.is_symlink()] == []
    bomb = zipped({"zeros.py": b"0" * 10**7})
    for room in (Room(10**6, 10), Room(10**8, 0)):
        with pytest.raises(Unpackable, match="too many or too large"):
            unpack(bomb, tmp_path / "bomb", room)
    quine = zipped({FILE: b"x"})
    for _ in range(6):
        quine = zipped({"z.zip": quine})
    found, _ = find(written(tmp_path / "class", {"ada/z.zip": quine, "bob/b.zip": b"PK"}))
    assert "too many zip files" in found["ada"].notes[0]
    assert "b.zip is damaged, or no zip file, so it stays packed." in found["bob"].notes


def test_tar_files_stay_within_their_folder_and_limits(find, tmp_path):
    evil = io.BytesIO()
    with tarfile.open(fileobj=evil, mode="w:gz") as archive:
        for name, kind in (("../a.py", tarfile.REGTYPE), ("b.py", tarfile.SYMTYPE),
                           ("c.py", tarfile.LNKTYPE), ("d", tarfile.FIFOTYPE)):  # fmt: skip
            info = tarfile.TarInfo(name)
            info.type, info.linkname = kind, "/etc/passwd"
            archive.addfile(info, io.BytesIO())
    target = tmp_path / "target"
    assert unpack(evil.getvalue(), target, Room(10**6, 100)) == ["b.py", "c.py", "d"]
    assert [path.name for path in target.rglob("*")] == ["a.py"]
    for bomb in (gzip.compress(bytes(10**7)), of_tar({"zeros.py": bytes(10**7)})):
        with pytest.raises(Unpackable, match="too many or too large"):
            unpack(bomb, tmp_path / "bomb", Room(10**6, 10), "x.py.gz")
    half = of_tar({FILE: SOLUTION.encode()})[:-40]
    found, _ = find(written(tmp_path / "class", {"ada/z.tar.gz": half, "bob/x.rar": b"Rar!"}))
    assert found["ada"].notes == ["z.tar.gz is damaged, or no zip file, so it stays packed."]


def of_students(way, names=("ada", "bob")):
    """A file for each, at the place that a way gives for a name."""
    return {way.format(name): SOLUTION.encode() for name in names}


GIT = {f"org/week3/ex03/ex03-{name}/.git/HEAD": b"x" for name in ("ada", "bob")}
CLASSES = {
    "zipped once more": {
        "Ex 3.zip": zipped({f"A_1_assignsubmission_file_/{FILE}": SOLUTION.encode(),
                            f"B_2_assignsubmission_file_/{FILE}": SOLUTION.encode()}),
        "grades.csv": b"x,y"},
    "differ in capitals": of_students("{}/" + FILE, ("ada", "Ada")),
    "a folder around folders": of_students("Submitted files/{}/Exercise 3/Version 1/" + FILE),
    "nbgrader's folder": of_students("submitted/{}/ex03/" + FILE),
    "clones deep down": GIT | of_students("org/week3/ex03/ex03-{}/exercises/" + f"{FOLDER}/{FILE}"),
    "Canvas without names": {f"anon_x7Gh2_90_{FILE}": SOLUTION.encode(),
                             f"anon_LATE_k2Lp9_91_{FILE}": SOLUTION.encode()},
    "Canvas, a name with _": {f"li_anna_LATE_4_90_{FILE}": SOLUTION.encode(),
                              f"o'hara_5_91_{FILE}": SOLUTION.encode()},
    "feedback beside": {f"A_1_assignsubmission_file_/{FILE}": SOLUTION.encode(),
                        f"B_2_assignsubmission_file_/{FILE}": SOLUTION.encode(),
                        "B_2_assignfeedback_file_/feedback.html": b"x"},
    "two downloads of Moodle": {
        f"Group {g}.zip": zipped({f"{g}_{i}_assignsubmission_file_/{FILE}": SOLUTION.encode()})
        for i, g in enumerate("AB", 1)},
    "two downloads of Canvas": {
        f"subs ({i}).zip": zipped({f"la_{i}_9{i}_{FILE}": SOLUTION.encode()}) for i in (1, 2)},
    "two sections": {
        f"section {i}/P_{i}_assignsubmission_file_/{FILE}": SOLUTION.encode() for i in (1, 2)},
    "zip files in a folder": {"roster.csv": b"name"} | {
        f"subs/{name}.zip": zipped({FILE: SOLUTION.encode()}) for name in ("ada", "bob")},
    "repositories of each person": of_students("{}/ex03/" + FILE) | {
        f"{name}/{each}/.git/HEAD": b"x" for name in ("ada", "bob") for each in ("ex03", "ex08")},
    "zip_collect of nbgrader": of_students(
        "downloaded/ex03/archive/{}_attempt_2026-11-20-21-14-03_" + FILE),
    "Blackboard": {f"gradebook_Ex 3_ada_attempt_2026-11-{day}-21-14-03_{FILE}": text.encode()
                   for day, text in (("19", SKELETON + "X = 1\n"), ("20", SOLUTION))}
                  | {f"gradebook_Ex 3_bob_attempt_2026-11-20-21-14-03_{FILE}": SOLUTION.encode(),
                     "gradebook_Ex 3_bob_attempt_2026-11-20-21-14-03.txt": b"Name: Bob"},
    "a name with a dot": {f".Ada_1_assignsubmission_file_/{FILE}": SOLUTION.encode(),
                          f"Bob_2_assignsubmission_file_/{FILE}": SOLUTION.encode()},
    "one name": {f"Participant_{i}_assignsubmission_file_/{FILE}": SOLUTION.encode()
                 for i in (1, 2)},
}  # fmt: skip


@pytest.mark.parametrize("as_zip", [False, True], ids=["folder", "zip"])
@pytest.mark.parametrize("kind", CLASSES)
def test_two_people_are_two(find, tmp_path, kind, as_zip):
    files, target = CLASSES[kind], tmp_path / "download"
    found, _ = find(saved(target, files) if as_zip else written(target, files))
    assert len(found) == 2 and all(is_solution(one.choices[3].file) for one in found.values())


NO_PROGRAMS = {
    "a PDF file": ({"tiny.pdf": b"%PDF-1.7"}, "Handed in: tiny.pdf (a PDF file)"),
    "a document": ({"tiny.docx": zipped({"word/document.xml": b"x"})}, "(an Office document)"),
    "a rich text": ({FILE: b"{\\rtf1 x}"}, "Handed in: tiny.py (a rich text file)"),
    "a RAR archive": ({"w.zip": b"Rar!\x1a\x07\0"}, "w.zip is a RAR archive, so it stays packed"),
    "an archive called script": ({FILE: b"7z\xbc\xaf'\x1c\0"}, "tiny.py (a 7z archive)"),
    "a pointer": ({FILE: b"version https://git-lfs.github.com/spec/v1"}, "of Git LFS"),
    "too large": ({FILE: b"#" * 5 * 2**20}, "tiny.py (more than 4 MB)"),
    "a web page": ({FILE: b"<!DOCTYPE html><p>Not found"}, "tiny.py is a web page"),
    "no function": ({FILE: b"404: Not found"}, "tiny.py defines no function of the exercise"),
    "compiled": ({"__pycache__/tiny.cpython-311.pyc": b"x"}, "Ignored: __pycache__"),
    "a patch": ({"tiny.patch": b"+++"}, "Handed in: tiny.patch."),
}  # fmt: skip


@pytest.mark.parametrize("kind", NO_PROGRAMS)
def test_what_is_no_program_is_named(find, tmp_path, kind):
    files, sentence = NO_PROGRAMS[kind]
    found, _ = find(written(tmp_path / "class", moodle([Handed("Ada L", files)])))
    one = found["Ada L"]
    said = " ".join([one.choices[3].problem, *one.choices[3].notes, *one.notes])
    assert sentence in said and said.count(next(iter(files)).partition("/")[0]) <= 2


def test_a_link_does_not_make_its_owner_vanish(find, tmp_path):
    path = tmp_path / "x.zip"
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr(*linked(f"Ada_1_assignsubmission_file_/{FILE}", "/etc/passwd"))
        archive.writestr(f"Bob_2_assignsubmission_file_/{FILE}", SOLUTION)
    found, export = find(path)
    assert set(found) == {"Ada", "Bob"} and found["Ada"].choices[3].problem
    assert "is a link or leads elsewhere" in export.notes[0]


@pytest.mark.parametrize("name", [FILE, "tiny (1).py"])
def test_a_film_beside_a_program_is_left_out(find, tmp_path, name):
    written(tmp_path / "class", {f"ada/{name}": SOLUTION.encode(), "ada/data.npy": b"9"})
    os.truncate(written(tmp_path / "class", {"ada/a.mp4": b""}) / "ada" / "a.mp4", 60 * 2**20)
    found, _ = find(tmp_path / "class")
    choice = found["ada"].choices[3]
    assert sorted(path.name for path in choice.file.parent.iterdir()) == ["data.npy", FILE]
    assert "more than 50 MB or 2000 files: a.mp4." in choice.notes[-1]


def test_a_notebook_with_many_pictures_is_graded(find, tmp_path):
    content = json.loads(notebook(SOLUTION))
    output = {"output_type": "display_data", "metadata": {}, "data": {"image/png": "A" * 2**23}}
    content["cells"][1]["outputs"] = [output]
    files = {"ada/tiny.ipynb": json.dumps(content).encode()}
    found, _ = find(written(tmp_path / "class", files))
    file = found["ada"].choices[3].file
    assert is_solution(file) and file.stat().st_size < 10_000


def test_a_file_under_the_name_of_another_exercise(find, course, tmp_path):
    """Its content decides: a file of that exercise may define some functions of this one."""
    names = ("double", "total", "more", "less", "many")
    other = "".join(f"def {name}(x):\n    pass\n\n\n" for name in names)
    written(course / "exercises" / "ex04_other", {"other.py": other.encode()})
    files = {"ada/other.py": SOLUTION.encode(), "bob/other.py": other.encode()}
    found, _ = find(written(tmp_path / "class", files))
    assert is_solution(found["ada"].choices[3].file)
    assert found["bob"].choices[3].problem == f"There is no {FILE}. Handed in: other.py."


def test_versions_of_one_person_are_no_people(find, tmp_path):
    files = {"ada/v1/tiny.py": SKELETON.encode(), "ada/v2/tiny.py": SOLUTION.encode()}
    found, _ = find(written(tmp_path / "class", files))
    assert list(found) == ["ada"] and is_solution(found["ada"].choices[3].file)
    found, _ = find(written(tmp_path / "one", {"ada.zip": zipped({"a/x.txt": b"", "b/y": b""})}))
    assert list(found) == ["ada"]


def test_who_handed_in_nothing_does_not_vanish(find, tmp_path):
    with zipfile.ZipFile(tmp_path / "x.zip", "w") as archive:
        archive.writestr("Ada_1_assignsubmission_file_/", b"")
        archive.writestr(f"Bob_2_assignsubmission_file_/{FILE}", SOLUTION)
    found, _ = find(tmp_path / "x.zip")
    assert found["Ada"].choices[3].problem == f"There is no {FILE}."
    files = gradescope(class_of(FILE, SOLUTION, SKELETON)[:2])
    found, _ = find(
        written(tmp_path / "two", {k: v for k, v in files.items() if "300001" not in k})
    )
    assert len(found) == 2


def test_an_empty_file_and_lines_for_jupyter_are_said(find, tmp_path):
    exported = "# In[1]:\nget_ipython().run_line_magic('matplotlib', 'inline')\n%pip install x\n"
    files = {f"ada/{FILE}": b"\n", f"bob/{FILE}": (exported + SOLUTION).encode()}
    found, _ = find(written(tmp_path / "class", files))
    assert found["ada"].choices[3].notes == [f"{FILE} is empty."]
    bob = found["bob"].choices[3]
    assert bob.notes == ["Left out: lines that only Jupyter understands."]
    compile(bob.file.read_text(), FILE, "exec")
    assert "pass  # get_ipython" in bob.file.read_text()


def test_one_persons_canvas_files_are_attempts(course, tmp_path):
    wrong = SOLUTION.replace("2 *", "3 *").encode()
    files = {f"la_4_8_{FILE}": wrong, f"la_LATE_4_9_{Path(FILE).stem}-1.py": SOLUTION.encode()}
    place, new_folder = written(tmp_path / "ada", files), numbered_folders(tmp_path / "unpacked")
    person = one_person(place, new_folder)
    wanted = [Wanted(3, FILE, course)]
    (one,) = find_submissions([person], wanted, course, new_folder)
    assert is_solution(one.choices[3].file) and person.late
    person = one_person(place / f"la_4_8_{FILE}", new_folder)
    assert [file.name for file in person.handed.files] == [FILE]


def test_many_files_of_one_name_are_unpacked_in_a_moment(tmp_path, monkeypatch):
    path = tmp_path / "same.zip"
    with zipfile.ZipFile(path, "w") as archive, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for _ in range(500):
            archive.writestr(zipfile.ZipInfo("a.py"), "x")
    looks, exists = [], Path.exists
    monkeypatch.setattr(Path, "exists", lambda self: looks.append(self) or exists(self))
    assert unpack(path, tmp_path / "target", Room(10**6, 1000)) == []
    assert len(list((tmp_path / "target").iterdir())) == 500 and len(looks) < 1500


BOMB = "a: &a [x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join(8 * [f'*{before}'])}]\n"
    for before, name in zip("abcdefghijk", "bcdefghijkl", strict=True)
)


@pytest.mark.slow
def test_aliases_that_make_billions_of_values_are_refused(find, tmp_path):
    (tmp_path / "class.yaml").write_text(BOMB + "late: *l\n")
    with pytest.raises(BotschoolError, match=r"too many values: does an alias"):
        read_policy(tmp_path / "class.yaml")
    files = gradescope(class_of(FILE, SOLUTION, SKELETON)[:2])
    name = "assignment_77_export/submission_metadata.yml"
    written(tmp_path / "class", files | {name: BOMB.encode()})
    with pytest.raises(BotschoolError, match=r"submission_metadata\.yml holds too many values"):
        find(tmp_path / "class")


def test_a_download_that_is_none(find, tmp_path):
    (tmp_path / "x.zip").write_bytes(b"nothing")
    with pytest.raises(BotschoolError, match="is damaged, or no zip file: download it again"):
        find(tmp_path / "x.zip")
    (tmp_path / "empty").mkdir()
    with pytest.raises(BotschoolError, match="holds no submissions"):
        find(tmp_path / "empty")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may read everything")
def test_an_unreadable_folder_is_no_zero(find, tmp_path):
    written(tmp_path / "class", {f"ada/{FILE}": SOLUTION.encode()})
    (tmp_path / "class" / "ada").chmod(0)
    found, _ = find(tmp_path / "class")
    (tmp_path / "class" / "ada").chmod(0o700)
    assert found["ada"].choices[3].unread


def test_encodings():
    assert decoded("# coding: utf-8\n\u00e9".encode()) == ("# coding: utf-8\n\u00e9", "")
    assert decoded("x = 'abc'\n".encode("utf-16-le") * 20)[1] == "UTF-16 without a mark"
    assert decoded(b"# coding: nonsense\n\xe9")[0].endswith("\u00e9")


# --- the commands
@pytest.mark.slow
def test_a_class_by_the_command(course, tmp_path):
    people = class_of(FILE, SOLUTION, SKELETON)
    people[1].files = {FILE: SKELETON.encode()}
    names = ("plain", "second download", "a notebook", "UTF-16")
    people = [one for one, way in zip(people, WAYS, strict=True) if way in names]
    path = saved(tmp_path / "download.zip", moodle(people))
    code, out, errors = call("grade-all", path, "-e", "3.1", "-o", tmp_path / "out", "-w", "2")
    assert (code, errors) == (0, "") and "4 submissions, 45.0 of 60 points" in out
    table = (tmp_path / "out" / "grades.csv").read_text(encoding="utf-8-sig")
    assert "Nothing was changed in tiny.py." in table and "was stored as UTF-16" in table
    pages = {path.name: path.read_text() for path in (tmp_path / "out" / "feedback").iterdir()}
    assert len(pages) == 4 and "was stored as UTF-16" in pages[f"{people[3].name}.html"]


@pytest.mark.slow
def test_the_table_says_that_a_program_is_broken(course, tmp_path):
    files = {f"ada/{FILE}": SOLUTION.encode() + b"x = \xe2\x80\x9cquoted\xe2\x80\x9d\n"}
    top = written(tmp_path / "class", files | {f"bob/{FILE}": SOLUTION.encode() + b"\x1a"})
    for rule, points in (
        ("everything", 0),
        ("its task", 100),
    ):  # it costs nothing: no function is cut
        (tmp_path / "class.yaml").write_text(f"syntax: {rule}\n")
        assert call("grade-all", top, "-e", "3", "-o", tmp_path / "out")[0] == 0
        table = (tmp_path / "out" / "grades.csv").read_text(encoding="utf-8-sig")
        ada, bob = table.split("\n")[1:3]
        assert "Your file is not Python yet." in ada and ada.startswith(f"ada,{points},")
        assert bob.startswith("bob,100,") and "Invisible characters" in bob


@pytest.mark.slow
def test_one_submission_by_the_command(course, tmp_path):
    path = saved(tmp_path / "ada.zip", {"x/Tiny (1).py": SOLUTION.encode()})
    for place in (path, written(tmp_path / "ada", {"Tiny.ipynb": notebook(SOLUTION)})):
        code, out, _ = call("grade", "3", "--submission", place)
        assert code == 0 and "Graded:" in out and "100 of 100 points" in out
    code, out, _ = call("grade", "3.1,3.2", "--submission", submit(tmp_path / "b", SOLUTION))
    assert code == 0 and "3.2" in out


@pytest.mark.slow
@pytest.mark.parametrize("command", ["grade", "grade-all", "release"])
def test_the_same_words_name_exercises_everywhere(course, tmp_path, command):
    first = {"grade": [], "grade-all": [submit(tmp_path / "c" / "a", SOLUTION).parents[2], "-e"],
             "release": [tmp_path / "copy", "-e"]}[command]  # fmt: skip
    for words, sentence in (("3-4", "There is no exercise 4"), ("3.9", "no task 3.9"),
                            ("x", "names no exercise"), ("5-4", "not a range")):  # fmt: skip
        code, _, errors = call(command, *first, words)
        assert code == 2 and sentence in errors
    code, out, _ = call(command, *first, "3", *(["-o", tmp_path / "o"] * (command == "grade-all")))
    assert code == (command == "grade") and out
