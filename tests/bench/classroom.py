"""Grade a class of 120 from the platform's export to its gradebook, and compare every point.

    python tests/bench/classroom.py [--platform canvas] [--exercise 3] [--people 120] [--keep DIR]

The submissions are the exercise's solution, its right ones in other styles and its wrong ones
(tests/course), each in one of the forms that students hand in (tests/exports.py). Some are late,
one has an extension, some handed in twice, some nothing. The commands are those of
docs/instructor.md. The script prints wall time, processor time and memory, and every task whose
points are not those that the case declares. The exit code is 1 if there is one.
"""

import argparse
import csv
import os
import re
import resource
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from pathlib import Path

import psutil

TESTS = Path(__file__).parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "course")]

import building  # noqa: E402
from exports import Handed, canvas, moodle, saved, variations  # noqa: E402

EXPORTS = {"moodle": (moodle, 1234560), "canvas": (canvas, 400)}
FIRST = [
    "Ada", "Björn", "Chloé", "D'Arcy", "Émile", "Fatma", "Gökçe", "Hans-Peter", "Inês", "Jürgen",
]  # fmt: skip
LAST = [
    "Ångström", "Besnard", "Çelik", "de la Cruz", "Eriksen", "Fernández", "Gauss", "Hu", "İnan",
    "Jahn", "Kovač", "Li",
]  # fmt: skip
MISSING = 5
LATE_DAYS = {"moodle": 2, "canvas": 1}
"""Moodle's worksheet tells the time. Canvas says only that it is late, which counts as a day."""
DUE = "2026-11-20 23:59"


@dataclass
class Student:
    """Somebody of the class."""

    name: str
    number: int
    """The platform's."""
    case: str = ""
    """What he handed in; "" for nothing."""
    loses: tuple[str, ...] = ()
    late: bool = False
    extended: bool = False


def main() -> int:
    """Build a class, grade it twice, print what differs."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--platform", choices=EXPORTS, default="moodle")
    parser.add_argument("--exercise", type=int, default=3)
    parser.add_argument("--people", type=int, default=120)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory(prefix="classroom") as temporary:
        top = options.keep or Path(temporary)
        top.mkdir(parents=True, exist_ok=True)
        students = make_class(top, options)
        wrong = []
        for adjusted in (False, True):
            if adjusted:
                (top / "changes.csv").write_text(
                    f"student,exercise,points,reason\n{students[7].name},{options.exercise},+5,talk\n"
                )
            printed = graded(top, options, "again" if adjusted else "all")
            days = LATE_DAYS[options.platform]
            wrong += differing(top, students, options.exercise, days, adjusted)
        print(printed)
    print(*wrong, f"{len(wrong)} differ", sep="\n")
    return 1 if wrong else 0


def make_class(top: Path, options: argparse.Namespace) -> list[Student]:
    """Write the download, the platform's table and class.yaml."""
    source = building.source(options.exercise)
    cases = [("solution", (), source.solution), ("skeleton", None, source.skeleton)]
    cases += [(case.name, case.loses, case.submission) for case in building.cases(options.exercise)]
    tasks = tuple(task.id for task in building.exercise(options.exercise).tasks)
    export, first = EXPORTS[options.platform]
    students, people = [], []
    for i in range(options.people):
        name = f"{FIRST[i % len(FIRST)]} {LAST[i % len(LAST)]}{'' if i < 60 else ' Jr'}"
        student = Student(name, first + i)
        students.append(student)
        if i >= options.people - MISSING:
            student.number += 1000
            continue
        case, loses, text = cases[i % len(cases)]
        student.case, student.loses = case, tasks if loses is None else loses
        student.late, student.extended = i % 19 == 2, i == 2
        own = text if case == "skeleton" else f"{text}\n# student {i}\n"
        forms = list(variations(source.file, own, source.skeleton).values())
        files = forms[i // 3 % len(forms) if i % 3 else 0]
        files = {name.replace("ex03_tiny", source.folder): data for name, data in files.items()}
        attempts = [{source.file: source.skeleton.encode()}] if i % 29 == 4 else []
        if attempts and options.platform == "moodle":
            files = {f"old/{source.file}": source.skeleton.encode()} | files
        people.append(Handed(name, files, student.late, attempts))
    people.append(Handed("Zoé Stranger", {source.file: source.skeleton.encode()}))
    students.append(Student("Zoé Stranger", first + len(people) - 1, "skeleton", tasks))
    saved(top / "download.zip", export(people))
    table(top, students[:-1], options)
    late = f"extensions: {{{students[2].name}: {{{options.exercise}: 2026-11-29}}}}\n"
    (top / "changes.csv").write_text("student,exercise,points,reason\n")
    (top / "class.yaml").write_text(
        f"due: {{{options.exercise}: {DUE}}}\nlate: 10 per day, at most 50\n{late}"
        "adjustments: changes.csv\n"
    )
    return students


def table(top: Path, students: list[Student], options: argparse.Namespace) -> None:
    """Write Moodle's grading worksheet or Canvas's gradebook."""
    rows: list[list] = []
    if options.platform == "moodle":
        head = "Identifier,Full name,Email address,Status,Grade,Maximum Grade"
        head += ",Last modified (submission),Feedback comments"
        rows.append(head.split(","))
        for one in students:
            day = (
                "Sunday, 22 November 2026, 9:14 PM"
                if one.late
                else ("Friday, 20 November 2026, 9:14 PM" if one.case else "-")
            )
            mail = f"p{one.number}@example.org"
            rows.append([f"Participant {one.number}", one.name, mail, "", "", "100.00", day, ""])
    else:
        head = "Student,ID,SIS User ID,SIS Login ID,Section"
        rows += [[*head.split(","), f"Exercise {options.exercise} (77)"]]
        rows += [["    Points Possible", "", "", "", "", "100"]]
        for one in students:
            first, _, last = one.name.partition(" ")
            rows.append([f"{last}, {first}", one.number, "", f"p{one.number}", "A", ""])
    with open(top / "grades.csv", "w", encoding="utf-8-sig", newline="") as file:
        csv.writer(file).writerows(rows)


def graded(top: Path, options: argparse.Namespace, what: str) -> str:
    """Grade the class by the page's command; print what it took and return what it said."""
    number = options.exercise
    command = [sys.executable, "-m", "botschool", "grade-all", top / "download.zip"]
    command += ["-e", number, "--gradebook", top / "grades.csv", "-o", top / "results"]
    command += ["--column", f"Exercise {number}"] * (options.platform == "canvas")
    environment = os.environ | {"BOTSCHOOL_GRADING_SEED": f"a class {top} {os.getpid()}"}
    environment["BOTSCHOOL_COURSE"] = str(building.ROOT)
    before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    process = subprocess.Popen(
        list(map(str, command)),
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    peak = Peak(process.pid)
    said = process.communicate()[0]
    peak.stop()
    wall, after = time.monotonic() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(
        f"{options.platform}, exercise {number}, {options.people} people, {what}: {wall:.0f} s, "
        f"{used:.0f} s of processor time, {peak.most / 2**20:.0f} MB at most in all processes; "
        f"exit code {process.returncode}"
    )
    return said


class Peak:
    """Watches the memory of a process and its children."""

    def __init__(self, pid: int) -> None:
        self.most, self._going = 0, True
        self._process = psutil.Process(pid)
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()

    def _watch(self) -> None:
        while self._going:
            total = 0
            try:
                for each in [self._process, *self._process.children(recursive=True)]:
                    total += own_memory(each.pid)
            except psutil.Error:
                pass
            self.most = max(self.most, total)
            time.sleep(0.5)

    def stop(self) -> None:
        self._going = False
        self._thread.join()


def own_memory(pid: int) -> int:
    """Return a process's share of memory, in bytes; 0 if it has ended."""
    try:
        text = Path(f"/proc/{pid}/smaps_rollup").read_text()
    except OSError:
        return 0
    found = re.search(r"^Pss: +(\d+) kB", text, re.MULTILINE)
    return int(found[1]) * 1024 if found else 0


def differing(
    top: Path, students: list[Student], number: int, days: int, adjusted: bool
) -> list[str]:
    """Return what is not in the tables as it should be."""
    rows = {}
    with open(top / "results" / "grades.csv", encoding="utf-8-sig", newline="") as file:
        for row in csv.DictReader(file):
            rows[re.sub(r"^(.*), (.*)$", r"\2 \1", row["student"].lstrip("'"))] = row
    most = {task.id: task.max_points for task in building.exercise(number).tasks}
    wrong = [] if len(rows) == len(students) else [f"{len(rows)} rows, {len(students)} people"]
    for index, one in enumerate(students):
        row = rows.get(one.name) or rows.get("".join(one.name.lower().split()[::-1]))
        if row is None:
            wrong.append(f"{one.name} ({one.case}) is not in the table")
            continue
        if not one.case:
            if row["total"] or "Nothing was handed in" not in row["notes"]:
                wrong.append(f"{one.name}: {row['total']} points for nothing")
            continue
        if not row["total"]:
            wrong.append(f"{one.name} ({one.case}) was not graded: {row['notes']}")
            continue
        lost = tuple(task for task in most if row[task] != str(most[task]))
        if lost != one.loses:
            wrong.append(f"{one.name} ({one.case}) loses {lost}, not {one.loses}: {row['notes']}")
        points = sum(float(row[task]) for task in most)
        points -= min(points, 10 * days) if one.late and not one.extended else 0
        points += 5 * (adjusted and index == 7)
        if abs(float(row["total"]) - points) > 0.01:
            wrong.append(f"{one.name} ({one.case}): {row['total']}, not {points}: {row['notes']}")
    return wrong


if __name__ == "__main__":
    sys.exit(main())
