"""Writes into the grader, the course, the home folder and the temporary folder."""

import os
import sys
from pathlib import Path


def hostile(*arguments, **options):
    sandbox = Path(sys.modules["botschool.sandbox.protocol"].__file__).parent
    own = (sandbox, sandbox.parent / "grading")
    for place in (COURSE, f"{COURSE}/exercises", HOME, TEMPORARY, *own, sys.prefix, "/", "/etc"):
        try:
            with open(os.path.join(place, "hostile_was_here.py"), "x"):
                print("LEAKED a file in", place)
        except OSError:
            continue
    for path in (f"{HOME}/precious.txt", f"{COURSE}/solutions/precious.txt"):
        for mode in ("w", "a", "r+"):
            try:
                with open(path, mode) as file:
                    file.write("points = 100\n")
            except OSError:
                continue
    return 0
