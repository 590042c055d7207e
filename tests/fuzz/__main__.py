"""Damage every kind of file that the command reads, and see that it refuses in a sentence.

    python tests/fuzz SECONDS [--seed 1] [--only 'ini genotype'] [--case 12]

Each kind gets the same share of SECONDS. Each case is a fresh folder and a process with limits of
memory and time. What is found is printed with the command that repeats it; the exit code is 1 then.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import resource
import shlex
import shutil
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from fuzz.kinds import KINDS, ROOT, Kind
from fuzz.mutate import damaged_file
from running import call, environment_of_command

HANG = 30
"""Seconds of processor time after which a command hangs."""
MEMORY = 8 << 30
"""Bytes of address space."""
SENTENCES = re.compile(r"((Notice|warning|error): \S[^\n]*[.?]\n|[^\n]*\n)*?error: \S[^\n]*[.?]\n")


def main() -> int:
    """Run the fuzzers; return 1 if they have found something."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("seconds", type=float, nargs="?", default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="kinds, separated by spaces")
    parser.add_argument("--case", type=int, help="this case alone")
    arguments = parser.parse_args()
    names = arguments.only.replace(",", " ").split() or list(KINDS)
    if unknown := set(names) - KINDS.keys():
        sys.exit(f"There is no kind {', '.join(unknown)}: choose from {', '.join(KINDS)}.")
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (HANG, resource.RLIM_INFINITY))
    finds = 0
    for name in names:
        with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
            finds += try_kind(name, arguments, Path(folder), arguments.seconds / len(names))
    return 1 if finds else 0


def try_kind(name, arguments, folder, seconds) -> int:
    """Damage files of a kind until the time is over; return the number of different finds."""
    kind, whole, case = KINDS[name], folder / "whole", folder / "case"
    whole.mkdir()
    (whole / "own.ini").write_text(kind.ini)
    for words in kind.makes:
        run(words, whole)
    # from here on the processes of commands alone have this limit
    resource.setrlimit(resource.RLIMIT_CPU, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    valid = kind.valid(whole)
    (whole / kind.place).write_bytes(valid[0])
    for words in kind.reads:
        code, errors = run(words, shutil.copytree(whole, case, dirs_exist_ok=True))
        assert code == 0, f"{name}: a good file is refused: {errors}"
    finds: dict[str, int] = {}
    number, end = arguments.case or 0, time.monotonic() + seconds
    while time.monotonic() < end:
        chance = random.Random(f"{name} {arguments.seed} {number}")
        shutil.rmtree(case)
        shutil.copytree(whole, case)
        (case / kind.place).write_bytes(damaged_file(valid, chance))
        what = find(kind, case, arguments.case is not None)
        if what and what not in finds:
            finds[what] = number
            again = f"make fuzz ONLY={name} SEED={arguments.seed} CASE={number}"
            print(f"{name}: {what}\n    {again}", flush=True)
        if arguments.case is not None:
            break
        number += 1
    print(f"    {name}: {number} cases")
    return len(finds)


def run(words: str, folder: Path) -> tuple[int, str]:
    """Run a command in a folder; return its exit code and what it has written as errors."""
    own = {"XDG_CONFIG_HOME": str(folder / "settings"), "BOTSCHOOL_COURSE": str(ROOT)}
    variables = environment_of_command(COLUMNS="200", **own)
    code, _, errors = call(*shlex.split(words), cwd=folder, env=variables)
    return code, errors


def find(kind: Kind, folder: Path, shown: bool) -> str:
    """Let the commands read a damaged file; return what is wrong with their answers, or ""."""
    for words in kind.reads:
        try:
            code, errors = run(words, folder)
        except TimeoutError:
            return f"{words}: waits for something that does not come"
        if shown:
            print(f"botschool {words}\n{code}\n{errors}")
        if code in (-24, -9) and not kind.ends:  # SIGXCPU: the file may ask for that much
            return ""
        if "Traceback" in errors or code not in (0, 1, 2):
            lines = errors.strip().splitlines() or [""]
            return f"{words}: exit code {code}, {lines[-1][:200]}"
        if code == 2 and not SENTENCES.fullmatch(errors):
            return f"{words}: no sentence: {errors!r}"
    return ""


if __name__ == "__main__":
    os.environ["MPLBACKEND"] = "agg"
    sys.exit(main())
