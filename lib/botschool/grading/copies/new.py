"""Begin an exercise: a solution with its cases, a text with its hints, and a grader that works."""

from __future__ import annotations

import re
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.copies.skeleton import skeleton
from botschool.output import save_bytes

SOLUTION = '''# %% [markdown]
# # Exercise {n}. {title}

# %%
import numpy as np


def largest(values):
    """Return the largest of the values.

    values: array, shape (n,).
    """
    ### BEGIN SOLUTION task {n}.1: find the largest value
    return np.max(values)
    ### END SOLUTION


# %%
if __name__ == "__main__":
    print(largest(np.array([0.5, 2.0, -1.0])))
'''

CASES = """Wrong answers to exercise {n}, and right ones in other styles.

%% by_size loses {n}.1 and says so
Takes the value that is largest without its sign.
def largest(values):
    return values[np.argmax(np.abs(values))]

%% sorts_the_values
Sorts the values and takes the last one.
def largest(values):
    return sorted(values)[-1]
"""

TEXT = """# Exercise {n}. {title}

**Aim:** what you will be able to do.

## What to know

Some paragraphs.

## Tasks

**{n}.1 Largest** (10 min). `largest(values)` returns the largest value.

Grade your file with `botschool grade {n}`, and draw what you have done with `botschool show {n}`.

<!-- hints: botschool hint shows them one at a time

## {n}.1

1. NumPy has a function for it. Which one?
2. `np.max` returns the largest value of an array.

-->
"""

GRADER = '''"""Grader of exercise {n}; run it with `botschool grade {n}`."""

from botschool.grading import Exercise, same

exercise = Exercise({n}, "{title}", file="{name}.py")

largest = exercise.task("{n}.1", "Largest")


@same(largest, 100, "largest")
def values(rng):
    yield from (rng.normal(size=n) for n in (1, 2, 2, 5, 5, 20))
    yield from (-rng.random(n) for n in (3, 4))
'''


def new_exercise(root: Path, number: int, title: str) -> list[Path]:
    """Write the files of a new exercise that grades; return them.

    root: a folder with exercises/ and solutions/. Raises BotschoolError if the number is taken.
    """
    name = re.sub(r"\W+", "_", title.lower(), flags=re.ASCII).strip("_")
    if not 1 <= number <= 99:
        raise BotschoolError("The number of an exercise lies between 1 and 99.")
    if not re.match("[a-z]", name) or any(sign in title for sign in '"\\\n'):
        raise BotschoolError(f"'{title}' is no title: it begins with a letter from a to z.")
    if not (root / "solutions").is_dir():
        raise BotschoolError(f"{root} has no solutions/: new exercises begin in a checkout.")
    folder = f"ex{number:02d}_{name}"
    taken = sorted(root.glob(f"*/ex{number:02d}_*"))
    if taken:
        raise BotschoolError(f"There is an exercise {number} already: {taken[0]}.")
    solution = SOLUTION.format(n=number, title=title)
    texts = {
        f"solutions/{folder}/{name}.py": solution,
        f"solutions/{folder}/cases.txt": CASES.format(n=number),
        f"exercises/{folder}/README.md": TEXT.format(n=number, title=title),
        f"exercises/{folder}/{name}.py": skeleton(solution),
        f"exercises/{folder}/test_{name}.py": GRADER.format(n=number, title=title, name=name),
    }
    for path, text in texts.items():
        (root / path).parent.mkdir(parents=True, exist_ok=True)
        save_bytes(root / path, text.encode())
    return [root / path for path in texts]
