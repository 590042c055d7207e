"""Damage every kind of file that the command reads, and see that it refuses in a sentence.

    python tests/fuzz SECONDS [--seed 1] [--only 'ini genotype'] [--case 12]

Each kind gets the same share of SECONDS, which count processor time of damaged files. Kinds take
turns, each in a process of its own with limits of memory and time; its preparation is not counted.
What is found is printed with the command that repeats it; the exit code is 1 then.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import os
import queue
import random
import signal
import subprocess
import sys
import tempfile
import threading
import traceback
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

SLICE = 60.0
"""Seconds of processor time of a kind's turn."""
HANG = 30.0
"""Seconds of processor time after which a case hangs."""
WAIT = 300.0
"""Seconds by the clock after which it waits for something that does not come."""
START = 300.0
"""Seconds that a kind's preparation may take."""
MEMORY = 4 << 30
"""Bytes of address space."""


def main() -> int:
    """Run the fuzzers; return 1 if they have found something."""
    arguments = _arguments()
    if arguments.child:
        _child(arguments)
        return 0
    from fuzz.kinds import KINDS

    names = arguments.only.replace(",", " ").split() if arguments.only else list(KINDS)
    if unknown := set(names) - KINDS.keys():
        sys.exit(f"There is no kind {', '.join(unknown)}: choose from {', '.join(KINDS)}.")
    cases, used, found = dict.fromkeys(names, 0), dict.fromkeys(names, 0.0), {}
    share = arguments.seconds / len(names)
    with tempfile.TemporaryDirectory(prefix="fuzz") as folder:
        while min(used.values()) < share:
            name = min(used, key=used.__getitem__)
            seconds = max(min(SLICE, share - used[name]), 0.5)
            used[name] += _turn(name, arguments, Path(folder), seconds, cases, found)
            if arguments.case is not None:
                break
    seconds = sum(used.values())
    print(f"{sum(cases.values())} cases in {seconds:.0f} s of processor time, {len(found)} finds")
    for name in names:
        print(f"    {name}: {cases[name]} cases in {used[name]:.0f} s")
    return 1 if found else 0


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("seconds", type=float, nargs="?", default=60)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="", help="kinds, separated by spaces")
    parser.add_argument("--case", type=int, help="this case alone, with its traceback")
    parser.add_argument("--child", default="", help=argparse.SUPPRESS)
    parser.add_argument("--folder", type=Path, help=argparse.SUPPRESS)
    parser.add_argument("--first", type=int, default=0, help=argparse.SUPPRESS)
    return parser.parse_args()


def _turn(name, arguments, folder, seconds, cases, found) -> float:
    """Let a kind's process work, and start it again after each case that ends it.

    Return the processor time of the cases, which is at least `seconds`, except where the
    process cannot be repeated.
    """
    used = 0.0
    while used < seconds:
        first = cases[name] if arguments.case is None else arguments.case
        own = folder / name
        own.mkdir(exist_ok=True)
        command = [sys.executable, str(Path(__file__).parent), str(seconds - used)]
        command += ["--child", name, "--seed", str(arguments.seed), "--first", str(first)]
        command += ["--folder", str(own)]
        command += ["--case", str(first)] if arguments.case is not None else []
        before = _processor_time()
        prepared = _watched(name, command, cases, found, arguments)
        used += max(_processor_time() - before - prepared, 0.5)
        if arguments.case is not None:
            break
    return used


def _processor_time() -> float:
    """Return the seconds of all processes that have ended."""
    times = os.times()
    return times.children_user + times.children_system


def _watched(name, command, cases, found, arguments) -> float:
    """Print what the process reports; return the processor time of its preparation."""
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    lines: queue.SimpleQueue[str | None] = queue.SimpleQueue()

    def listen() -> None:
        for line in process.stdout:
            lines.put(line)
        lines.put(None)

    threading.Thread(target=listen, daemon=True).start()
    number, limit, tail, how, prepared = None, START, [], "", 0.0
    while True:
        try:
            line = lines.get(timeout=limit)
        except queue.Empty:
            process.kill()
            process.wait()
            how = f"waits for more than {WAIT:.0f} s"
            break
        if line is None:
            code = process.wait()
            if code == -getattr(signal, "SIGPROF", 0):
                how = f"takes more than {HANG:.0f} s of processor time"
                break
            how = "" if code == 0 else f"ends the process ({code}): {' '.join(tail[-3:])}"
            break
        word, _, rest = line.partition(" ")
        if word == "CASE":
            number, limit, tail = int(rest), WAIT, []
            cases[name] = number + 1
        elif word == "PREPARED":
            prepared = float(rest)
        elif word == "FIND":
            _tell(name, number, rest.strip(), found, arguments)
        else:
            tail.append(line.strip())
            if arguments.case is not None:
                print(line, end="")
    if how:
        if number is None:
            how, cases[name] = f"does not start: {' '.join(tail[-5:])}", cases[name] + 1
        _tell(name, number, how, found, arguments)
    return prepared


def _tell(name, number, what, found, arguments) -> None:
    key = (name, what)
    if key not in found:
        found[key] = number
        again = f"make fuzz ONLY={name} SEED={arguments.seed} CASE={number}"
        print(f"{name}: {what}\n    {again}", flush=True)


def _spent() -> float:
    """Return the processor seconds of this process and of those that it started and that ended.

    Some kinds read each case in a process of its own.
    """
    return sum(os.times()[:4])


def _child(arguments: argparse.Namespace) -> None:
    """Read damaged files until the time is over; report each on standard output."""
    from botschool.errors import BotschoolErrors
    from fuzz.kinds import KINDS, BotschoolError

    with contextlib.suppress(ImportError):
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    os.environ["MPLBACKEND"] = "agg"
    report = os.fdopen(os.dup(1), "w", buffering=1)
    warnings.simplefilter("ignore")
    kind = KINDS[arguments.child](arguments.folder)
    with contextlib.redirect_stdout(io.StringIO()):
        valid = kind.valid()
        path = kind.path()
        path.write_bytes(valid[0])
        kind.read(path)  # else each refusal would be for nothing
    report.write(f"PREPARED {_spent()}\n")
    number, end = arguments.first, _spent() + arguments.seconds
    while _spent() < end:
        report.write(f"CASE {number}\n")
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_PROF, HANG)  # ends the process
        chance = random.Random(f"{arguments.child} {arguments.seed} {number}")
        path = kind.path()
        path.write_bytes(kind.damage(valid, chance))
        if arguments.case is not None:
            report.write(f"the damaged file: {path.read_bytes()[:3000]!r}\n")
        try:
            with (
                contextlib.redirect_stdout(io.StringIO()),
                contextlib.redirect_stderr(io.StringIO()),
            ):
                kind.read(path)
        except BotschoolError as error:
            text = str(error)
            several = isinstance(error, BotschoolErrors)  # a sentence in each line
            lines = text.split("\n") if several else [text]
            if any("\n" in each or not each.rstrip().endswith((".", "?")) for each in lines):
                report.write(f"FIND says no sentence: {text!r}\n")
        except BaseException as error:
            place = traceback.extract_tb(error.__traceback__)
            own = [each for each in place if "botschool" in each.filename] or place
            where = f"{Path(own[-1].filename).name}:{own[-1].name}"
            report.write(f"FIND raises {type(error).__name__} in {where}\n")
            if arguments.case is not None:
                report.write(traceback.format_exc())
        if arguments.case is not None:
            return
        number += 1


if __name__ == "__main__":
    sys.exit(main())
