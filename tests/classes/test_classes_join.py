"""A table and a download are joined by their values, whatever the platform, language and script."""

import csv
import io

import pytest

from botschool.grading.classes.choice import Wanted, find_submissions
from botschool.grading.classes.download import read_download
from botschool.grading.classes.files import numbered_folders
from botschool.grading.classes.register import Register
from botschool.grading.classes.roster import read_answers, read_roster
from botschool.grading.classes.rules import Policy
from botschool.grading.declare.trust import trust
from exports import saved
from tiny_course import FILE, SOLUTION, make_course

GIVEN = {
    100: SOLUTION,
    40: SOLUTION.replace("2 * numbers_of", "3 * numbers_of"),
    60: SOLUTION.replace("np.sum", "np.mean"),
}
"""Points -> what is handed in for them."""
PEOPLE = [  # name, number, id, user, points
    ("Ada Berg", 9001, "0012345", "aberg", 100),
    ("Łukasz Żółć", 9002, "12e4", "lzolc", 40),
    ("मीना शर्मा", 9003, "20261016", "mina", 60),
    ("मोना शर्मा", 9004, "77:30", "mona", 100),
    ("กิตติ ใจดี", 9005, "on", "kitti", 40),
    ("Kim Lee", 9006, "s9007", "kim1", 60),  # numbers of each other
    ("Kim Lee", 9007, "s9006", "kim2", 100),
    ("Nguyễn Thị Ánh", 9008, "88", "anh-n", 40),
    ("Мария Ким", 9009, "89", "mk9", 60),
    ("Zoe Noe", 9010, "90", "zoe", None),  # hands in nothing
]
NUMBERS = [str(person[1]) for person in PEOPLE]


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    root = make_course(tmp_path_factory.mktemp("join") / "course")
    trust(root)
    return root


@pytest.fixture
def course(root, monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    monkeypatch.setenv("BOTSCHOOL_GRADING_SEED", "a secret of thirty-two letters!!")


def table(path, rows, delimiter=",", encoding="utf-8", before=""):
    stream = io.StringIO()
    stream.write(before)
    csv.writer(stream, delimiter=delimiter).writerows(rows)
    path.write_bytes(stream.getvalue().encode(encoding))
    return path


@pytest.fixture
def register(course, root, tmp_path):
    """Join a download and a table; return the register."""

    def of(files, rows, gradebook=False, people=None, **how):
        place = saved(tmp_path / "download.zip", files)
        policy, roster = Policy(), read_roster(table(tmp_path / "sheet.csv", rows, **how))
        policy.people, policy.gradebook = (None, roster) if gradebook else (roster, None)
        if people:
            table(tmp_path / "people.csv", [["identifier", "folder"], *people])
        policy.answers = read_answers(tmp_path)
        new_folder, wanted = numbered_folders(tmp_path / "unpacked"), [Wanted(3, FILE, root)]
        known = frozenset(word for each in roster.students for word in each.words)
        found = read_download(place, wanted, new_folder, known)
        return Register(find_submissions(found.people, wanted, root, new_folder), policy)

    return of


def code(points):
    return GIVEN[points].encode()


# --- what platforms write: each function returns the download's files and the table's rows
MOODLE = {
    "en": ("Identifier,Full name,Status,Grade,Maximum Grade,Grade can be changed,Last modified "
           "(submission),Last modified (grade),Feedback comments", "Participant {}", "100.00"),
    "de": ("ID,Vollständiger Name,Status,Bewertung,Bestwertung,Bewertung kann geändert werden,"
           "Zuletzt geändert (Abgabe),Zuletzt geändert (Bewertung),Feedback als Kommentar",
           "Teilnehmer/in{}", "100,00"),
    "es": ("Identificador,Nombre completo,Estado,Calificación,Calificación máxima,La calificación "
           "puede ser cambiada,Última modificación (entrega),Última modificación (calificación),"
           "Comentarios de retroalimentación", "Participante {}", "100,00"),
    "fr": ("Identifiant,Nom complet,Statut,Note,Note maximale,La note peut être modifiée,Dernière "
           "modification (travail remis),Dernière modification (note),Feedback par commentaires",
           "Participant {}", "100,00"),
    "ja": ("識別子,フルネーム,ステータス,評点,最大評点,評点を変更できる,最終更新日時 (提出物),"
           "最終更新日時 (評点),フィードバックコメント", "参加者 {}", "100.00"),
}  # fmt: skip


def moodle(language, blind=False):
    head, who, most = MOODLE[language]
    rows, files = [head.split(",")], {}
    for name, number, _, _, points in PEOPLE:
        state = "x y z" if points else "-"
        rows.append([who.format(number), name, state, "", most, "1", "-", "-", ""])
        shown = "Participant" if blind else name
        if points:
            files[f"{shown}_{number}_assignsubmission_file_/{FILE}"] = code(points)
    if blind:
        rows = [[row[0], *row[2:]] for row in rows]
    return files, rows


def canvas():
    rows = [["Student", "ID", "SIS User ID", "SIS Login ID", "Section", "Tiny (7)"]]
    rows.append(["    Points Possible", "", "", "", "", "100"])
    files = {}
    for name, number, id, user, points in PEOPLE:
        first, _, last = name.partition(" ")
        rows.append([f"{last}, {first}", number, id, user, "A", ""])
        late = "LATE_" if number % 2 else ""
        if points:
            squashed = name.replace(" ", "").lower()
            files[f"{squashed}_{late}{number}_{10**5 + number}_{FILE}"] = code(points)
    return files, rows


def of_folders(write):
    """Return folders with names by write(name, number, id, user), and a table of all values."""
    rows = [["name", "participant", "id", "login"]]
    files = {}
    for name, number, id, user, points in PEOPLE:
        rows.append([name, number, id, user])
        if points:
            files[write(name, number, id, user)] = code(points)
    return files, rows


DOWNLOADS = {
    **{f"Moodle {language}": lambda language=language: moodle(language) for language in MOODLE},
    **{f"Moodle {each}, blind": lambda each=each: moodle(each, blind=True) for each in MOODLE},
    "Canvas": canvas,
    "Sakai": lambda: of_folders(lambda n, _, i, u: f"{', '.join(n.split()[::-1])}({u})/x/{FILE}"),
    "ILIAS": lambda: of_folders(lambda n, m, i, u: f"{n.replace(' ', '_')}_{u}_{m}/{FILE}"),
    "GitHub": lambda: of_folders(lambda n, m, i, u: f"tiny-{u}/{FILE}"),
    "GitHub's zip files": lambda: of_folders(lambda n, m, i, u: f"ex-3-{u}-main/{FILE}"),
    "D2L": lambda: of_folders(lambda n, m, i, u: f"{m}-7 - {n} - 9 Oct, 2026 914 PM - {FILE}"),
    "Blackboard": lambda: of_folders(
        lambda n, m, i, u: f"Tiny_{u}_attempt_2026-11-20-21-14-03_{FILE}"
    ),
    "Autolab": lambda: of_folders(lambda n, m, i, u: f"{u}@x.org_3_{FILE}"),
    "nbgrader": lambda: of_folders(lambda n, m, i, u: f"submitted/{u}/ex03_tiny/{FILE}"),
    "own": lambda: of_folders(lambda n, m, i, u: f"{m} {n}/{FILE}"),
}


@pytest.mark.parametrize("kind", DOWNLOADS)
def test_every_submission_is_the_right_persons(register, kind):
    files, rows = DOWNLOADS[kind]()
    found = register(files, rows, gradebook=kind.startswith(("Moodle", "Canvas")))
    by_text = {each.encode(): points for points, each in GIVEN.items()}
    handed, doubtful = {}, []
    for row in found.rows:
        given = [by_text[part.files[3].read_bytes()] for part in row.parts]
        number = next((n for n in NUMBERS if n in row.student.values.values()), None)
        (handed.setdefault(number, []).extend(given) if number else doubtful.append(row.name))
    assert handed == {str(p[1]): [p[4]] * (p[4] is not None) for p in PEOPLE}, found.lacking()
    assert not doubtful and found.how and not found.doubts
