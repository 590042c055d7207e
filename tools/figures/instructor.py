"""Make the pictures of docs/instructor.md: a term of a made-up class, graded, and its pages.

    make figures ONLY=instructor

It needs a Chromium (tests/browser.py finds it), and takes some minutes for the grading, once:
the class and its results stay in results/instructor.
"""

import csv
import random
import re
import subprocess
import sys
import tempfile
from base64 import b64decode
from io import BytesIO
from pathlib import Path
from urllib.parse import quote

from PIL import Image

from botschool.grading.declare.exercise import folder_of
from botschool.grading.declare.mistakes import case_text, read_cases

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests"))
HOME = ROOT / "results" / "instructor"
IMAGES = ROOT / "docs" / "images"
EXERCISES = (2, 3, 6)
NAMES = (
    "Ada Byron", "Alan Gauss", "Bea Novak", "Carlos Ruiz", "Dana Levi", "Emil Berg", "Fatou Diop",
    "Gita Rao", "Hugo Blanc", "Ines Costa", "Jun Sato", "Kim Lee", "Kim Lee", "Lena Vogt",
)  # fmt: skip


def work(number, at, draw):
    """Return what a student hands in: the solution, or one with a known mistake or two."""
    folder = folder_of(number, ROOT)
    (path,) = (ROOT / "solutions" / folder.name).glob("*.py")
    text = path.read_text()
    cases = read_cases(number, case_text(ROOT, number))
    simple = [case for case in cases if case.code and "import" not in case.code and case.says]
    for case in draw.sample(simple[:6], (at * number) % 3):
        text = case.of(text)
    if at == 9 and number == 3:
        text = text.replace("return", "retrun", 1)
    text = re.sub(r"^ *### (BEGIN|END) SOLUTION.*\n", "", text, flags=re.MULTILINE)
    return {path.name: text.encode()}


def make():
    """Write the class: downloads and worksheets of Moodle, with new numbers in each, settings."""
    from exports import saved

    HOME.mkdir(parents=True, exist_ok=True)
    draw = random.Random(1)
    for week, number in enumerate(EXERCISES):
        files, rows = {}, []
        for at, name in enumerate(NAMES):
            participant = 1000 * (week + 1) + 7 * at
            missing = (at + number) % 11 == 0
            late = (at + number) % 7 == 0
            when = f"Friday, {9 + 7 * week + late} October 2026, 9:14 PM"
            mail = f"{name.split()[0].lower()}{at}@example.org"
            if name == "Dana Levi" and week:
                mail = "dana.cohen@example.org"
            rows.append([f"Participant {participant}", name, mail, "Submitted", "", "100.00",
                         "-" if missing else when, ""])  # fmt: skip
            if not missing:
                top = f"{name}_{participant}_assignsubmission_file_"
                given = work(number, 0 if at == 4 else at % 12, draw)
                files |= {f"{top}/{key}": text for key, text in given.items()}
        saved(HOME / f"ex{number:02}.zip", files)
        with open(HOME / f"ex{number:02}.csv", "w", newline="") as file:
            writer = csv.writer(file)
            head = "Identifier,Full name,Email address,Status,Grade,Maximum Grade"
            writer.writerow([*head.split(","), "Last modified (submission)", "Feedback comments"])
            writer.writerows(rows)
    (HOME / "changes.csv").write_text(
        "student,exercise,points,reason\nAda Byron,3,-5,no comments\nBea Novak,total,+2,a talk\n"
    )
    (HOME / "class.yaml").write_text(
        "due:\n  2: 2026-10-09 23:59\n  3: 2026-10-16 23:59\n  6: 2026-10-23 23:59\n"
        "late: 10 per day, at most 50\nadjustments: changes.csv\n"
        "weights: {2: 1, 3: 1, 6: 1}\ntotal: 100\n"
    )


def botschool(*arguments):
    """Run the command as the page says."""
    command = [sys.executable, "-m", "botschool", *map(str, arguments)]
    print("botschool", *arguments)
    done = subprocess.run(command, cwd=HOME, capture_output=True, text=True, check=False)
    print(done.stdout + done.stderr)
    assert done.returncode in (0, 1), done.stderr


def grade():
    """Grade the term."""
    for number in EXERCISES:
        name = f"ex{number:02}"
        tables = ("--gradebook", f"{name}.csv")
        botschool("grade-all", f"{name}.zip", "-e", number, *tables, "-o", name)
    botschool("gradebook", *(f"ex{number:02}" for number in EXERCISES), "-o", "term")


def photograph():
    """Take the pictures: a part of a page, its size, and the file."""
    from browser import Browser

    feedback = HOME / "ex02/feedback/Jun Sato.html"
    shots = (
        (HOME / "ex02/class.html", "", 900, 560, 0, "instructor_class.png"),
        (HOME / "ex02/class.html", "", 390, 640, 0, "instructor_phone.png"),
        (feedback, "document.querySelector('.beside')", 1000, 330, 60, "instructor_feedback.png"),
        (HOME / "ex02/similar.html", "document.querySelector('.pair:target')", 1000, 420, 0,
         "instructor_similar.png"),
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as profile:
        browser = Browser(profile)
        for path, element, width, height, above, name in shots:
            browser.resize(width, height)
            browser.call("Page.navigate", url="about:blank")
            place = "#e2p5" if "similar" in name else ""
            browser.call("Page.navigate", url=f"file://{quote(str(path))}{place}")
            browser.wait("document.readyState === 'complete' && location.protocol === 'file:'")
            top = browser.run(f"{element}.getBoundingClientRect().top + scrollY") if element else 0
            clip = {"x": 0, "y": max(0, top - above), "width": width, "height": height, "scale": 1}
            made = browser.call("Page.captureScreenshot", clip=clip, captureBeyondViewport=True)
            picture = Image.open(BytesIO(b64decode(made["data"]))).convert("RGB")
            picture.quantize(32, dither=Image.Dither.NONE).save(IMAGES / name, optimize=True)
        browser.close()


def draw():
    """Make the class, grade it, and take the pictures."""
    make()
    grade()
    photograph()
