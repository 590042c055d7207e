"""Measure the processor time of grading right, wrong and endless answers.

    python tests/bench/grading_time.py [--wrong 4] [--seed 1] [--only 3 8] [--endless]

Each exercise's solution is graded, then known mistakes of it that are drawn at random, each by a
process of its own with its fork server: all that a teacher's machine does for one file. `--endless`
grades an endless loop in each function of exercise 3 and in the first one of the others, and ten
kinds of functions of exercise 3 that never return. The script prints seconds of processor time and
of wall time, how many times as long as for the solution that is, and at the end median and worst.
"""

import argparse
import os
import random
import re
import statistics
import sys
import tempfile
import time
from pathlib import Path

TESTS = Path(__file__).parents[1]
sys.path[:0] = [str(TESTS), str(TESTS / "course")]

import building  # noqa: E402
from botschool.grading.judge.submission import grade  # noqa: E402

KINDS = {
    "while True": "    while True:\n        pass",
    "sleep": "    import time\n    time.sleep(1e6)",
    "recursion": "    import sys\n    sys.setrecursionlimit(10**9)\n    return rank(fitness)",
    "printing": "    while True:\n        print('x' * 1000)",
    "generator": "    from itertools import count\n    return max(n for n in count())",
    "input": "    return input('rank: ')",
    "thread": "    import threading\n    def run():\n        while True:\n            pass\n"
    "    threading.Thread(target=run).start()\n    return np.argsort(-fitness, kind='stable')",
    "memory": "    kept = []\n    while True:\n        kept.append(bytearray(10**6))",
    "object": "    class Endless(list):\n        def __iter__(self):\n            while True:\n"
    "                yield 1\n        __len__ = __eq__ = lambda *_: next(n for n in iter(int, 1))\n"
    "    return Endless([1])",
}
"""Bodies of exercise 3's `rank`; the tenth kind loops when the file is imported."""
LOOP = "    while True:\n        pass"


def main() -> None:
    """Grade what the arguments name."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--wrong", type=int, default=4)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", type=int, nargs="*", default=range(1, 16))
    parser.add_argument("--endless", action="store_true")
    given = parser.parse_args()
    found = []
    for number in given.only:
        text = building.source(number).solution
        right = measured(number, "solution", text)[0]
        cases = endless(number, text) if given.endless else drawn(number, given)
        for name, wrong in cases:
            found.append((*measured(number, name, wrong, right), f"{number} {name}"))
    if found:
        for what, column in (("processor seconds", 0), ("times as long", 1)):
            values = sorted((each[column], each[-1]) for each in found)
            median = statistics.median(value for value, _ in values)
            print(f"{what}: median {median:.2f}, worst {values[-5:]}")


def drawn(number: int, given: argparse.Namespace) -> list[tuple[str, str]]:
    """Return names and texts of some known mistakes."""
    cases = [case for case in building.cases(number) if case.loses]
    some = random.Random(f"{given.seed} {number}").sample(cases, given.wrong)
    return [(case.name, case.submission) for case in some]


def endless(number: int, text: str) -> list[tuple[str, str]]:
    """Return names and texts of answers that never come."""
    bodies = re.finditer(
        r"^def (\w+)\((?:.|\n)*?### BEGIN SOLUTION.*\n((?:.|\n)*?) *### END", text, re.M
    )
    made = [(m[1], f"{text[: m.start(2)]}{LOOP}\n{text[m.end(2) :]}") for m in bodies]
    if number != 3:
        del made[1:]
    else:
        (body,) = (re.search(r"BEGIN SOLUTION task 3.2.*\n((?:.|\n)*?) *### END", text),)
        start, end = text[: body.start(1)], text[body.end(1) :]
        made += [(kind, f"{start}{each}\n{end}") for kind, each in KINDS.items()]
        made.append(("import", f"{text}\nwhile True:\n    pass\n"))
    return made


def measured(number: int, name: str, text: str, right: float = 0) -> tuple[float, float, float]:
    """Grade a text in a process of its own; return processor time, ratio and wall time."""
    with tempfile.TemporaryDirectory() as folder:
        file = building.write(Path(folder), number, text)
        exercise, start = building.exercise(number), time.monotonic()
        sys.stdout.flush()
        if (child := os.fork()) == 0:
            code = 1
            try:
                result = grade(exercise, file)
                print(f"{number:2} {name:45} {result.points:3} points", end=" ", flush=True)
                code = 0
            finally:
                os._exit(code)
        _, status, used = os.wait4(child, 0)
    spent, wall = used.ru_utime + used.ru_stime, time.monotonic() - start
    ratio = spent / right if right else 1.0
    print(
        f"{spent:6.1f} s {wall:6.1f} s wall  x {ratio:.2f}{'' if status == 0 else ' FAILED'}",
        flush=True,
    )
    return spent, ratio, wall


if __name__ == "__main__":
    main()
