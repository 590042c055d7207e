"""The command as its user meets it: memory of a run, time of `--help`."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

COMMAND = [sys.executable, "-m", "botschool"]
MIB = 2**20


def help_seconds(repetitions: int) -> float:
    """Median time of `botschool --help`."""
    times = []
    for _ in range(repetitions):
        start = time.perf_counter()
        subprocess.run([*COMMAND, "--help"], stdout=subprocess.DEVNULL, check=True)
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def peak_memory(arguments: list[str], seconds: float) -> tuple[float, int] | None:
    """Peak memory in MiB of `botschool ARGUMENTS`, summed over its processes, and their number.

    The command is stopped as with Ctrl-C after `seconds`. The peaks of the processes are added,
    shared pages and all, so the true sum is below. None where the system has no /proc.
    """
    if not Path("/proc/self/status").exists():
        return None
    process = subprocess.Popen([*COMMAND, *arguments], stdout=subprocess.DEVNULL)
    peaks: dict[int, float] = {}
    stop = time.monotonic() + seconds
    while process.poll() is None:
        for pid in _family(process.pid):
            peaks[pid] = _high_water(pid) or peaks.get(pid, 0.0)
        if time.monotonic() > stop:
            process.send_signal(2)
            stop = float("inf")
        time.sleep(0.005)
    # helpers of multiprocessing that stay tiny count too: they are part of the run
    return sum(peaks.values()), len(peaks)


class Neighbours:
    """How busy other programs have kept the machine since this was made."""

    def __init__(self) -> None:
        self._start = time.monotonic()
        self._others = _busy_seconds() - _own_seconds()

    def sentence(self) -> str:
        """For the reader of a table; empty where the system does not tell."""
        elapsed = time.monotonic() - self._start
        cores = (_busy_seconds() - _own_seconds() - self._others) / elapsed
        if np.isnan(cores):
            return ""
        warning = ": measure again when it is quiet" if cores > 0.1 else ""
        return f"Other programs used {max(cores, 0):.1f} cores meanwhile{warning}."


def _busy_seconds() -> float:
    """Seconds that all cores together have worked since the system started."""
    try:
        user, nice, system = Path("/proc/stat").read_text().split()[1:4]
    except OSError:
        return float("nan")
    return (int(user) + int(nice) + int(system)) / os.sysconf("SC_CLK_TCK")


def _own_seconds() -> float:
    return sum(os.times()[:4])


def _family(pid: int) -> list[int]:
    """A process and its descendants."""
    try:
        children = Path(f"/proc/{pid}/task/{pid}/children").read_text().split()
        for task in os.listdir(f"/proc/{pid}/task"):
            if int(task) != pid:
                children += Path(f"/proc/{pid}/task/{task}/children").read_text().split()
    except OSError:
        return [pid]
    return [pid, *(member for child in children for member in _family(int(child)))]


def _high_water(pid: int) -> float | None:
    """Peak resident memory of a process so far, in MiB; None once it has ended."""
    try:
        for line in Path(f"/proc/{pid}/status").read_text().splitlines():
            if line.startswith("VmHWM:"):
                return int(line.split()[1]) * 1024 / MIB
    except OSError:
        pass
    return None
