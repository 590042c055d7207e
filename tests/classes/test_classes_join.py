"""A table and a download are joined by their values, whatever the platform, language and script."""

import csv
import io

import pytest

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.classes.choice import Wanted, find_submissions
from botschool.grading.classes.download import read_download
from botschool.grading.classes.files import numbered_folders
from botschool.grading.classes.register import Register
from botschool.grading.classes.roster import read_answers, read_roster
from botschool.grading.classes.rules import Policy
from botschool.grading.declare.trust import trust
from exports import saved, written, zipped
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


SECRET = "a secret of thirty-two letters!!"


@pytest.fixture(scope="module")
def root(tmp_path_factory):
    """A course that has graded what is handed in: afterwards its results come from the cache."""
    root = make_course(tmp_path_factory.mktemp("join") / "course")
    trust(root)
    jobs = []
    for points, text in GIVEN.items():
        written(root.parent / str(points), {FILE: text.encode()})
        jobs.append(Job(3, root.parent / str(points) / FILE))
    Grades(root, secret=SECRET).of(jobs, 1)
    return root


@pytest.fixture
def course(root, monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    monkeypatch.setenv("BOTSCHOOL_GRADING_SEED", SECRET)


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


def rows_of(path):
    with open(path, encoding="utf-8-sig", newline="") as file:
        return list(csv.reader(file))


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


def gradescope():
    files, rows = of_folders(lambda n, m, i, u: f"export/submission_{m}7/{FILE}")
    lines = [
        f"submission_{m}7:\n  :submitters:\n  - :name: {n}\n    :sid: '{i}'\n    :email: {u}@x.org"
        for n, m, i, u, points in PEOPLE
        if points
    ]
    return files | {"export/submission_metadata.yml": "\n".join(lines).encode()}, rows


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
    "Teams": lambda: of_folders(
        lambda n, m, i, u: f"Student Work/{n}{' ' * (u == 'kim2')}/Tiny/Version 1/{FILE}"
    ),
    "Google Classroom": lambda: of_folders(lambda n, m, i, u: f"{n} - {m} - {FILE}"),
    "Canvas, a list of names": lambda: of_folders(
        lambda n, m, i, u: f"{''.join(n.split()[1:] + n.split()[:1]).lower()}_{m}9_{m}8_{FILE}"
    ),
    "Gradescope": gradescope,
    "own": lambda: of_folders(lambda n, m, i, u: f"{m} {n}/{FILE}"),
}


NAMES_ALONE = ("Teams", "Canvas, a list of names")


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
    alike = [p for p in PEOPLE if p[0] == "Kim Lee"] if kind in NAMES_ALONE else []
    right = {str(p[1]): [p[4]] * (p[4] is not None and p not in alike) for p in PEOPLE}
    assert handed == right, (found.how, found.lacking())
    assert len(doubtful) == len(found.doubts) == len(alike) and found.how


# --- nobody is guessed
def joined(register, files, rows, **how):
    """Return the name that the table has for each file's owner; "" for nobody."""
    found = register({name: code(100) for name in files}, rows, **how)
    names = {}
    for row in found.rows:
        for part in row.parts:
            names |= dict.fromkeys(part.names, row.name if row.student.listed else "")
    return [next(names[each] for each in names if file.startswith(each)) for file in files], found


HEAD = ["name", "id", "email"]
ADA, BEN, KIM, LEE = (
    ["Ada Berg", "101", "ada@x.org"], ["Ben Cole", "102", "ben@x.org"],
    ["Kim Lee", "103", "kim@x.org"], ["Kim Lee", "104", "lee@x.org"],
)  # fmt: skip
WHO = {
    "a number of another's id": ([f"Zoe Noe_102_assignsubmission_file_/{FILE}"], [BEN], [""]),
    "numbers crossed": (
        [f"Ada Berg_102_assignsubmission_file_/{FILE}",
         f"Ben Cole_101_assignsubmission_file_/{FILE}"], [ADA, BEN], ["", ""]),
    "one of two of a name": ([f"Kim Lee_9_assignsubmission_file_/{FILE}"], [KIM, LEE], [""]),
    "two of a name that the list has once": (
        [f"Kim Lee_8_assignsubmission_file_/{FILE}", f"Kim Lee_9_assignsubmission_file_/{FILE}"],
        [KIM, ADA], ["", ""]),
    "a part of another's name": ([f"Anna Maria Rossi/{FILE}"], [["Maria Rossi", "1", ""]], [""]),
    "a double name": ([f"Anne-Marie Berg/{FILE}"], [["Marie Berg", "1", ""]], [""]),
    "the same first name": (
        [f"Noe_Ada_zoe_7/{FILE}", f"Cole_Ben_ben_8/{FILE}"], [ADA, BEN], ["", ""]),
    "accents": ([f"Soren Osterby/{FILE}", f"Ben Cole/{FILE}"],
                [["Søren Østerby", "1", ""], BEN], ["", "Ben Cole"]),
    "vowel signs": ([f"मोना शर्मा_1_assignsubmission_file_/{FILE}"],
                    [["मीना शर्मा", "101", ""], ["सीता देवी", "102", ""]], [""]),
    "a composed name": ([f"Zoe\u0308 Noe\u0301/{FILE}"], [["Zoë Noé", "1", ""], ADA], ["Zoë Noé"]),
    "capitals": ([f"ADA BERG/{FILE}"], [ADA, BEN], ["Ada Berg"]),
    "ids that differ in capitals": (
        [f"abx/{FILE}", f"ABX/{FILE}"], [["A B", "abx", ""], ["C D", "ABX", ""]], ["A B", "C D"]),
    "zeros in front": ([f"0012/{FILE}"], [["A B", "12", ""], ["C D", "0012", ""]], ["C D"]),
    "an email": ([f"ada@x.org/{FILE}", f"ben@x.org/{FILE}"], [ADA, BEN], ["Ada Berg", "Ben Cole"]),
    "the end of a file's name": (
        [f"eve_101_7_ada_102_8_{FILE}"], [["Eve Ho", "101", ""], BEN], ["Eve Ho"]),
}  # fmt: skip


@pytest.mark.parametrize("kind", WHO)
def test_nobody_is_guessed(register, kind):
    files, rows, right = WHO[kind]
    names, found = joined(register, files, [HEAD, *rows])
    assert names == right
    assert len(found.doubts) == right.count("")
    for name, _ in found.doubts:
        assert any(f"IDENTIFIER,{name}" in line for line in found.lacking())


def test_a_worksheet_of_another_assignment_gives_nobody_anothers_grade(register):
    names = [f"{chr(65 + n)}da Berg{chr(97 + n)}" for n in range(6)]
    files = {f"{name}_{50 + n}_assignsubmission_file_/{FILE}": code(100) for n, name in
             enumerate(names)}  # fmt: skip
    rows = [[f"Participant {55 - n}", name, "x", "", "9", "-", ""] for n, name in enumerate(names)]
    found = register(files, [["a", "b", "c", "d", "e", "f", "g"], *rows], gradebook=True)
    assert len(found.doubts) == 6 and "says" in found.doubts[0][1]
    assert all(not row.parts for row in found.rows if row.student.listed)


def test_people_csv_says_whose_the_others_are(register, tmp_path):
    people = [["102", "Zoe Noe_9_assignsubmission_file_"], ["kim@x.org", "Soren Osterby"]]
    files = [f"Zoe Noe_9_assignsubmission_file_/{FILE}", f"Soren Osterby/{FILE}"]
    names, found = joined(register, files, [HEAD, ADA, BEN, KIM], people=people)
    assert names == ["Ben Cole", "Kim Lee"] and not found.doubts
    (tmp_path / "people.csv").write_text("person,name,where,student\n")
    assert "has no effect: it needs the columns" in read_answers(tmp_path).notes[0]


TABLES = {
    "first and last names": [["Vorname", "Nachname"], ["Ada", "Berg"], ["Ben", "Cole"]],
    "the other order": [["Last", "First", "Group"], ["Berg", "Ada", "1"], ["Cole", "Ben", "1"]],
    "a comma": [["students"], ["Berg, Ada"], ["Cole, Ben"]],
    "D2L's signs": [["OrgDefinedId", "Username"], ["#Ada Berg", "#1"], ["#Ben Cole", "#2"]],
    "other heads": [["الاسم", "x"], ["Ada Berg", "1"], ["Ben Cole", "2"]],
}
WRITTEN = {
    "Excel": {"delimiter": ";", "before": "sep=;\r\n", "encoding": "utf-8-sig"},
    "UTF-16": {"delimiter": "\t", "encoding": "utf-16"},
    "plain": {},
}


@pytest.mark.parametrize("way", WRITTEN)
@pytest.mark.parametrize("kind", TABLES)
def test_any_table_joins(register, kind, way):
    files = {f"Ada Berg/{FILE}": code(100), f"Ben Cole/{FILE}": code(100)}
    found = register(files, TABLES[kind], **WRITTEN[way])
    assert all(len(row.parts) == 1 for row in found.rows) and len(found.rows) == 2, found.how
    assert {row.name.lstrip("#") for row in found.rows} == {"Ada Berg", "Ben Cole"}


@pytest.mark.parametrize("name", ["x.xlsx", "x.csv"])
def test_an_excel_file_is_named(tmp_path, name):
    (tmp_path / name).write_bytes(zipped({"[Content_Types].xml": b"<Types/>"}))
    with pytest.raises(BotschoolError, match="is no CSV file: open it in Excel and save it as CSV"):
        read_roster(tmp_path / name)


# --- what Moodle's worksheet tells
def worksheet(*rows):
    head = [
        "ID",
        "Name",
        "Estado",
        "Grupo",
        "Nota",
        "Nota max",
        "Puede",
        "Entregado",
        "Calificado",
        "Comentarios",
    ]
    made = []
    for number, name, state, group, when in rows:
        made.append([f"Alumno {number}", name, state, group, "", "20,00", "1", when, "-", ""])
    return [head, *made]


LATE = "sábado, 17 de octubre de 2026, 10:10"


def test_extensions_times_and_groups_of_the_worksheet_count(course, tmp_path, command):
    files = {
        f"Equipo A-Ada Berg_1_assignsubmission_file_/{FILE}": code(100),
        f"Equipo B-Ben Cole_2_assignsubmission_file_/{FILE}": code(100),
        f"Equipo C-Zoe Noe_4_assignsubmission_file_/{FILE}": code(100),
    }
    sheet = worksheet(
        ["1", "Ada Berg", "Enviado", "Equipo A", LATE],
        ["2", "Ben Cole", "Enviado - Prórroga: domingo, 18 de octubre de 2026, 23:59", "Equipo B",
         LATE],
        ["3", "Cleo Dorn", "Enviado", "Equipo A", LATE],
        ["4", "Zoe Noe", "Enviado - Epä: 18. foobarkuuta 2026, 23:59", "Equipo C", LATE],
    )  # fmt: skip
    (tmp_path / "class.yaml").write_text("due: {3: 2026-10-16 23:59}\nlate: 10 per day\n")
    arguments = (saved(tmp_path / "x.zip", files), "-e", 3, "-o", tmp_path / "out")
    book = ("--gradebook", table(tmp_path / "sheet.csv", sheet))
    code_, out, errors = command("grade-all", *arguments, *book)
    assert (code_, errors) == (0, ""), out
    assert "row 5: 'Enviado - Epä: 18. foobarkuuta 2026, 23:59' cannot be read as a time" in out
    back = rows_of(tmp_path / "out" / "moodle.csv")[1:]
    assert [row[4] for row in back] == ["18.00", "20.00", "18.00", "18.00"]
    assert "Handed in by Ada Berg, group Equipo A." in back[2][-1] and back[0][-2] == "-"


@pytest.mark.slow
def test_keys_of_class_yaml_are_read_as_they_are_written(course, tmp_path, command):
    ids = ["00144", "12e4", "20261016", "77:30", "no", "null", "0x1F", "1_000"]
    rows = [HEAD, *([f"A B{chr(97 + n)}", id, ""] for n, id in enumerate(ids))]
    table(tmp_path / "students.csv", rows)
    files = {f"{row[0]}/{FILE}": code(100) for row in rows[1:]}
    keys = "".join(f"  {id}: {{3: 2026-10-20}}\n" for id in ids)
    (tmp_path / "class.yaml").write_text(f"roster: students.csv\nextensions:\n{keys}")
    arguments = (saved(tmp_path / "x.zip", files), "-e", 3, "-o", tmp_path / "out")
    assert command("grade-all", *arguments)[::2] == (0, "")


def test_canvas_names_the_column_exactly_and_keeps_who_is_excused(course, tmp_path, command):
    rows = [
        ["Student", "ID", "SIS", "Tiny 1 (7)", "Tiny 10 (8)", "Tiny (9)"],
        ["", "", "", "Manual Posting", "", ""],
        ["    Points Possible", "", "", "50", "50", "50"],
        ["Berg, Ada", "501", "s1", "", "", "1"], ["Cole, Ben", "502", "s2", "EX", "", "2"],
    ]  # fmt: skip
    files = {f"bergada_501_7_{FILE}": code(100), f"coleben_502_8_{FILE}": code(100)}
    arguments = (saved(tmp_path / "x.zip", files), "-e", 3, "-o", tmp_path / "out")
    book = ("--gradebook", table(tmp_path / "book.csv", rows), "--column", "tiny 1")
    code_, out, errors = command("grade-all", *arguments, *book)
    assert (code_, errors) == (0, "")
    assert "Excused in book.csv, so without a grade there: Ben Cole." in out
    assert rows_of(tmp_path / "out" / "canvas.csv") == [
        ["Student", "ID", "SIS", "Tiny 1 (7)"], ["    Points Possible", "", "", "50"],
        ["Berg, Ada", "501", "s1", "50"], ["Cole, Ben", "502", "s2", "EX"],
    ]  # fmt: skip


def test_a_column_of_any_table_is_filled_in(course, tmp_path, command):
    rows = [[*HEAD, "Tiny <Numeric MaxPoints:50>"], [*ADA, ""], [*BEN, ""]]
    arguments = (saved(tmp_path / "x.zip", {f"Ada Berg/{FILE}": code(60)}), "-o", tmp_path / "out")
    book = ("--gradebook", table(tmp_path / "book.csv", rows))
    assert "name the column that takes the grades" in command("grade-all", *arguments, *book)[2]
    command("grade-all", *arguments, *book, "--column", "Tiny")
    filled = rows_of(tmp_path / "out" / "filled.csv")
    assert filled == [rows[0], [*ADA, "30"], [*BEN, ""]]
