"""Files of a class, and the sheets of laboratories."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

from fuzz.kind import Kind, archive_of

ROOT = Path(__file__).parents[2]


class ClassSettings(Kind):
    """class.yaml."""

    suffix = ".yaml"

    def valid(self) -> list[bytes]:
        tables = {
            "students.csv": "name,id\nAda Lovelace,7\nAlan Turing,8\n",
            "adjustments.csv": "student,exercise,points,reason\nAda Lovelace,3,+5,a bug of ours\n",
            "times.csv": "id,submitted\n8,2026-11-20 23:59\n",
            "groups.csv": "group,student,exercise\nRed,Ada Lovelace,3\nRed,8,\n",
        }
        for name, text in tables.items():
            (self.folder / name).write_text(text)
        text = """roster: students.csv
due:
  3: 2026-11-20 23:59
  4: 2026-11-27
late: 10 per day, at most 50
extensions:
  Ada Lovelace: {3: 2026-11-25, 4: "2026-12-01T10:00:00+02:00"}
  "8": {3: "Friday, 20 November 2026, 9:14 PM"}
adjustments: adjustments.csv
submitted: times.csv
weights: {3: 2, 4: 0.5}
groups: groups.csv
total: 50
bonus: yes
"""
        return [text.encode(), text.replace("2026, 9:14", "2026 9:14").encode()]

    def read(self, path: Path) -> None:
        from datetime import datetime

        from botschool.grading.classes.policy import read_policy
        from botschool.grading.classes.roster import read_roster

        policy = read_policy(path)
        for number in (3, 4):
            result = {
                "exercise": number,
                "points": 80,
                "max_points": 100,
                "graded": True,
                "notes": [],
            }
            moment = datetime(2026, 11, 26, 12)
            for name in ("Ada Lovelace", "Alan Turing"):
                found = policy.apply(result, [name.lower()], moment, False)
                assert 0 <= found["points"] <= 10**9, found
            policy.weight(number)
            policy.of_term([result], ["8"])
            policy.digest([number])
        if policy.roster:
            read_roster(policy.roster)


class ClassList(Kind):
    """Rosters and gradebooks."""

    suffix = ".csv"

    def valid(self) -> list[bytes]:
        return [
            "name,id,email\nAda Lovelace,7,ada@x.org\nJo\u00e3o da Silva,8,j@x.org\n".encode(),
            b"Nachname;Vorname;Matrikelnummer;E-Mail\r\nLovelace;Ada;7;ada@x.org\r\n",
            "Student ID\tFull Name\n7\tLovelace, Ada\n".encode("utf-16"),
            b"Identifier,Full name,Email address,Status,Grade,Maximum Grade,Feedback comments\n"
            b"Participant 12,Ada Lovelace,ada@x.org,Submitted,,100.00,\n",
            b"Student,ID,SIS User ID,SIS Login ID,Section,Exercise 3 (77)\n"
            b'    Points Possible,,,,,100\n"Lovelace, Ada",400,7,ada,A,\n',
        ]

    def read(self, path: Path) -> None:
        from botschool.grading.classes.join import cut, join
        from botschool.grading.classes.outputs import gradebook_with, moodle_worksheet
        from botschool.grading.classes.roster import read_roster

        roster = read_roster(path)
        rows = [student.values for student in roster.students]
        names = [student.name for student in roster.students]
        join(rows, names, [cut("Ada Lovelace_12_x"), cut("lovelaceada_400_7")], [False, True])
        points = {at: (80.0, "well done", "Ada") for each in roster.students for at in each.rows}
        assert isinstance(roster.times, dict) and isinstance(roster.extensions, dict)
        if roster.kind == "moodle":
            moodle_worksheet(roster, points, 100.0)
        if roster.kind == "canvas":
            gradebook_with(roster, points, 100.0, "Exercise 3", [])


class Download(Kind):
    """Exports of learning platforms as zip files (grade-all)."""

    suffix = ".zip"

    def valid(self) -> list[bytes]:
        from botschool.grading.classes.choice import Wanted
        from exports import PLATFORMS, Handed, notebook

        file = "evolution_strategy.py"
        self.wanted = [Wanted(3, file, ROOT)]
        code = (ROOT / "solutions" / "ex03_evolution_strategy" / file).read_text()
        people = [
            Handed("Ada Lovelace", {file: code.encode()}),
            Handed("Alan Turing", {"a.ipynb": notebook(code)}, late=True),
            Handed("Grace Hopper", {"work.zip": archive_of({f"x/{file}": code.encode()})}),
        ]
        typed = [Handed("Typed In", {}, typed="import numpy as np\nx = 1")]
        every = {name: make(people) for name, make in PLATFORMS.items()}
        every["typed"] = PLATFORMS["moodle"](typed)
        return [archive_of(files) for files in every.values()]

    def read(self, path: Path) -> None:
        from botschool.grading.classes.choice import find_submissions
        from botschool.grading.classes.download import read_download
        from botschool.grading.classes.files import numbered_folders

        folder = self.folder / "unpacked"
        try:
            new_folder = numbered_folders(folder)
            export = read_download(path, self.wanted, new_folder)
            for one in find_submissions(export.people, self.wanted, ROOT, new_folder):
                json.dumps([one.student, one.notes, str(one.files)])
                walled = [each.problem for each in one.choices.values() if "read (" in each.problem]
                assert not walled, walled
            outside = [p for p in self.folder.iterdir() if p not in (folder, path)]
            assert not outside, outside
        finally:
            shutil.rmtree(folder, ignore_errors=True)


class LabSheet(Kind):
    """Sheets of laboratories, empty and filled in."""

    def path(self) -> Path:
        (self.folder / "lab09").mkdir(exist_ok=True)
        return self.folder / "lab09" / "sheet.md"

    def valid(self) -> list[bytes]:
        from botschool.labs.declare import load_lab
        from botschool.labs.folder import Place, start
        from lab_students import answer, predicted

        texts = []
        for number in (3, 9):
            lab = load_lab(number)
            for folder in ("filled", "empty"):
                place = Place(lab, self.folder / folder / lab.name)
                if folder == "empty":
                    start(place, "Ada", "botschool")
                else:
                    place = predicted(lab, self.folder / folder)
                    if number == 9:
                        answer(place, {"rule": 5.0, "observed": 0.5, "p": 0.01, "enough": "yes"})
                texts.append((place.folder / "sheet.md").read_bytes())
        return texts

    def read(self, path: Path) -> None:
        from botschool.labs.check import Check
        from botschool.labs.declare import load_lab
        from botschool.labs.folder import Place
        from botschool.labs.report import write_report
        from botschool.labs.sheet import check_specific, seeds_of

        lab = load_lab(9 if b"bonus" in path.read_bytes() else 3)
        place = Place(lab, path.parent)
        sheet = place.sheet()
        seeds_of(sheet, lab)
        check_specific(sheet, lab)
        checked = Check(place).all()
        write_report(place, checked, self.folder)
        json.dumps(checked.plain())
