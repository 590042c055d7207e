"""A course of one small exercise, for tests of grading."""

from pathlib import Path

from botschool.grading.copies.skeleton import skeleton

FOLDER, FILE = "ex03_tiny", "tiny.py"

SOLUTION = '''"""Exercise 3: a tiny one."""

import numpy as np


def double(numbers: np.ndarray) -> np.ndarray:
    """Every number twice as large."""
    ### BEGIN SOLUTION task 3.1: double the numbers
    numbers_of_the_students = np.asarray(numbers)
    twice_as_large_as_before = 2 * numbers_of_the_students
    return twice_as_large_as_before
    ### END SOLUTION


def total(numbers: np.ndarray) -> float:
    """Their sum."""
    ### BEGIN SOLUTION task 3.2: add the numbers up
    return float(np.sum(np.asarray(numbers, dtype=np.float64).ravel()))
    ### END SOLUTION


if __name__ == "__main__":
    with open("picture.txt", "w") as file:
        file.write(str(double([1, 2])))
'''

GRADER = '''"""Grader of the tiny exercise."""

import numpy as np

from botschool.grading import Exercise, Student, expect_close

exercise = Exercise(3, "Tiny", file="tiny.py")

doubling = exercise.task("3.1", "Doubling", seconds=2, memory=2048)


@doubling.check(40)
def doubles(student: Student):
    numbers = np.random.default_rng(exercise.seed(1)).normal(size=4)
    answer = student.call("double", numbers)
    expect_close(student.said, answer, numbers + numbers)


@doubling.check(20)
def doubles_many(student: Student):
    numbers = np.random.default_rng(exercise.seed(2)).normal(size=(3, 5))
    answer = student.call("double", numbers)
    expect_close(student.said, answer, numbers + numbers)


adding = exercise.task("3.2", "Adding", seconds=2, memory=2048)


@adding.check(40)
def adds(student: Student):
    numbers = np.random.default_rng(exercise.seed(3)).normal(size=9)
    answer = student.call("total", numbers)
    expect_close(student.said, answer, numbers.sum())
'''

HINTS = """# Tiny

<!-- hints: here

## 3.1

1. Look at `*`.
2. It works on whole arrays:

   ```python
   # 1. not a hint
   3 * array
   ```

## 3.2

1. Look at `np.sum`.

-->
"""


def make_course(root: Path) -> Path:
    """Write the course into a folder; return the folder."""
    for name, text in {
        f"solutions/{FOLDER}/{FILE}": SOLUTION,
        f"solutions/{FOLDER}/README.md": "# Answers\n\n"
        + "Twice two is four, as was measured. " * 3,
        f"exercises/{FOLDER}/{FILE}": skeleton(SOLUTION),
        f"exercises/{FOLDER}/test_tiny.py": GRADER,
        f"exercises/{FOLDER}/README.md": HINTS,
        "tests/course/test_secret.py": "",
        "tests/test_open.py": "",
        "lib/code.py": "x = 1\n",
        "docs/instructors.md": "secret",
        "docs/guide.md": "open",
        "Makefile": "",
        ".git/config": "",
    }.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return root


def submit(folder: Path, text: str) -> Path:
    """Write a submission's file with this text into a folder of its own."""
    path = folder / FOLDER / FILE
    path.parent.mkdir(parents=True)
    path.write_text(text, encoding="utf-8")
    return path
