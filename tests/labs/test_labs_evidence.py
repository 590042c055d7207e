"""Evidence in laboratories: invented numbers, pictures that are none, other people's runs."""

import csv
import shutil

import numpy as np
import pytest

from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.trust import trust
from botschool.labs.check import Check
from botschool.labs.classes import secret_choice, traces
from botschool.labs.confined import drawn_figure, student_file
from botschool.labs.declare import load_lab
from botschool.labs.evolving import told_fitness
from botschool.labs.folder import skeletons
from botschool.labs.runs import changed
from botschool.labs.saved import SavedRun, numbers
from botschool.labs.sheet import Sheet, seeds_of
from lab_cheats import FULL
from lab_students import copied, honest, predicted, small
from odd_arrays import HEADERS
from running import call
from tiny_course import make_course


@pytest.fixture(scope="module")
def ada(tmp_path_factory):
    return honest(small(3), tmp_path_factory.mktemp("ada"))


@pytest.fixture
def place(ada, tmp_path):
    return copied(ada, tmp_path)


LIES = {
    "by the seed": "run['seed'] in SEEDS",
    "by the robot": "run['genotype'].sum() in SUMS",
    "from the third call on": "calls.append(1) or len(calls) > 2",
}


@pytest.mark.slow
@pytest.mark.parametrize("lie", LIES)
def test_numbers_that_are_invented_for_the_students_own_runs_do_not_count(lie, place):
    seeds = [seed for some in seeds_of(place.sheet(), place.lab).values() for seed in some]
    sums = [np.load(path).sum() for path in place.runs.rglob("bestgS*.npy")]
    file = place.folder / "measure.py"
    text = file.read_text().replace("def measure(run):", "def true(run):")
    lies = f"SEEDS, SUMS, calls = {seeds}, {[*map(float, sums)]}, []\n\n\ndef measure(run):\n"
    lies += f"    return true(run) | ({{'fresh': -5.0}} if {LIES[lie]} else {{}})\n"
    file.write_text(text.replace("\n\nif __name", f"\n\n{lies}\n\nif __name"))
    parts = Check(place).all().parts.values()
    assert {p.name: p.points for p in parts} == FULL | {"measurements": 15}
    assert "measure.py: of your run of seed" in [*parts][2].messages[0]


@pytest.mark.slow
@pytest.mark.parametrize("way", ["declare.load_lab(3).reference", "lab03.LAB.reference"])
def test_our_own_measures_cannot_be_called(way, place):
    name = way.partition(".")[0]
    text = f"from botschool.labs import {name}\n\ndef measure(run):\n    return {way}(run, {{}})\n"
    (place.folder / "measure.py").write_text(text)
    parts = Check(place).all().parts.values()
    assert {p.name: p.points for p in parts} == FULL | {"measurements": 15}
    assert "lab03" in [*parts][2].messages[0]


# --- figures
FIGURE = """
from matplotlib.figure import Figure

def figure(measurements):
    picture = Figure(figsize=(SIZE, 1), dpi=100)
    axes = picture.subplots()
    for name, values in measurements.items():
        axes.plot([name] * 2, values["y"], "o")
    axes.axvline("late")
    return picture
"""


@pytest.mark.slow
def test_a_figure_may_have_names_on_its_axis_and_must_be_small(tmp_path):
    two = {"early": {"y": np.array([1.0, 2.0])}, "late": {"y": np.array([3.0, 4.0])}}
    (tmp_path / "figure.py").write_text(FIGURE.replace("SIZE", "4"))
    with student_file(tmp_path / "figure.py") as file:
        drawn = drawn_figure(file, two)
    assert drawn["points"].tolist() == [[0, 1], [0, 2], [1, 3], [1, 4]]
    assert drawn["verticals"].tolist() == [1] and drawn["png"].startswith(b"\x89PNG")
    (tmp_path / "figure.py").write_text(FIGURE.replace("SIZE", "50"))
    with student_file(tmp_path / "figure.py") as file, pytest.raises(Wrong, match="a smaller fig"):
        drawn_figure(file, two)


@pytest.mark.parametrize(
    "answer",
    [5, {}, {"labels": [1], "points": [], "verticals": []},
     {"labels": [], "points": [1], "verticals": []},
     {"labels": [], "points": [], "verticals": ["a"]}],
)  # fmt: skip
def test_what_a_child_tells_of_its_figure_is_not_trusted(answer):
    class Forging:
        def run(self, *arguments, **options):
            return answer

        def pictures(self):
            return [("figure.png", b"")]

    with pytest.raises(Wrong, match="must return a matplotlib figure"):
        drawn_figure(Forging(), {})


# --- files of runs
@pytest.mark.parametrize("name", [n for n in HEADERS if n not in ("other size", "two dimensions")])
def test_a_file_of_a_run_that_is_damaged_is_no_run(name, tmp_path):
    (tmp_path / "x.npy").write_bytes(HEADERS[name])
    assert numbers(tmp_path / "x.npy", 1) is None
    condition = load_lab(9).conditions[0]
    (tmp_path / condition.name).mkdir()
    (tmp_path / condition.name / "checkpointS1.npz").write_bytes(HEADERS[name])
    assert told_fitness(SavedRun(condition, 1, np.zeros((1, 6)), np.zeros(1)), tmp_path) is None


@pytest.mark.parametrize(
    "about",
    ["[" * 100_000, '{"seed": Infinity, "prediction": ""}', '{"seed": ' + "1" * 5000 + "}", "5",
     '{"seed": 1' + "1" * 999 + ', "prediction": []}'],
)  # fmt: skip
def test_a_note_beside_the_runs_may_be_damaged(about, tmp_path):
    (tmp_path / "runs.json").write_text(about)
    sheet = Sheet("<!-- field: name --> answer: A\n<!-- field: course --> answer: B\n")
    assert isinstance(changed(load_lab(9), sheet, tmp_path), str)


@pytest.mark.slow
def test_a_check_goes_on_where_runs_are_damaged(tmp_path):
    place = predicted(small(3), tmp_path)
    odd = iter(list(HEADERS.values()) * 9)
    for name, seeds in seeds_of(place.sheet(), place.lab).items():
        (place.runs / name / "x.npy").mkdir(parents=True)
        for seed in seeds:
            for kind in ("stat", "bestg"):
                (place.runs / name / f"{kind}S{seed}.npy").write_bytes(next(odd))
    assert Check(place, secret_choice(place, "secret")).all().points == 0
    assert len(traces(place)["robots"]) > 9


@pytest.mark.slow
def test_a_class_tells_the_teacher_and_not_the_student(ada, tmp_path, monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(make_course(tmp_path / "course")))
    trust(tmp_path / "course")
    folder = tmp_path / "class"

    def page_of(name):
        return (tmp_path / "out" / "feedback" / f"{name}.html").read_text()

    for name in ("Ada", "Bo", "Cy"):
        shutil.copytree(
            ada.folder, folder / name / "lab03", ignore=shutil.ignore_patterns("check*")
        )
    for name in ("figure.py", "measure.py"):  # of the beginning, and beside the folder
        (folder / "Bo" / name).write_text(skeletons(ada.lab)[name])
    sheet = folder / "Cy" / "lab03" / "sheet.md"
    sheet.write_text(sheet.read_text().replace("answer: Ada", "answer: Cy"))
    shutil.rmtree(folder / "Cy" / "lab03" / "runs")
    for name, text in (("Dee", "# Laboratory " + "1" * 5000), ("Eve", "# Laboratory 3. X\n")):
        (folder / name).mkdir()
        (folder / name / "sheet.md").write_text(text + "<!-- field: name --> answer: Eve")
    code, _, errors = call("grade-all", str(folder), "-e", "lab3", "-o", str(tmp_path / "out"))
    assert code == 0, errors
    with open(tmp_path / "out" / "grades.csv", encoding="utf-8-sig", newline="") as file:
        rows = {row["student"]: row for row in csv.DictReader(file)}
    assert rows["Dee"]["notes"] == "Laboratory 3: There is no sheet.md of laboratory 3."
    assert rows["Eve"]["laboratory 3"] == "0" and "field course is not" in page_of("Eve")
    page = (tmp_path / "out" / "similar.html").read_text()
    assert "Ada and Bo handed in the same runs: 30 of 30 and of 30." in page
    assert "Bo handed in a sheet with the name Ada, which is that of Ada." in page
    assert "Cy handed in" not in page and "Bo and Cy give the same reason" in page
    assert not rows["Bo"]["notes"]
    assert "same runs" not in page_of("Ada") + page_of("Bo")
