"""Lets the runs of the study evolve, one process a core; it can be stopped and goes on later."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

from coevolution_plan import PLANS, Plan, StudyRun, jobs

POLL_SECONDS = 0.5


def command(run: StudyRun, millions: float) -> list[str]:
    """`botschool es` for one job; what is there already is resumed."""
    return [
        *(sys.executable, "-m", "botschool", "es", "-f", str(run.write_experiment())),
        *("-s", str(run.seed), "-w", "1", "-o", str(run.home), "--resume"),
        *("--steps", str(round(millions * 1e6))),
    ]


class Queue:
    """Jobs that are left, and those that run."""

    def __init__(self, folder: Path, plans: tuple[Plan, ...] = PLANS) -> None:
        self.waiting = [job for job in jobs(folder, plans) if job[0].reached() < job[1]]
        self.running: list[tuple[subprocess.Popen, StudyRun]] = []
        self.failed: list[str] = []
        self.stopped = False

    def stop(self, *_: object) -> None:
        """Asks all runs to save and end; nothing more is started."""
        self.stopped = True
        for process, _ in self.running:
            process.send_signal(signal.SIGTERM)

    def _start(self) -> None:
        """The first job whose run is not at work."""
        busy = {run.name for _, run in self.running}
        at = next((i for i, job in enumerate(self.waiting) if job[0].name not in busy), None)
        if at is None:
            return
        run, millions = self.waiting.pop(at)
        line = command(run, millions)
        with open(run.home / f"S{run.seed}.log", "ab") as log:
            # a group of its own: Ctrl-C is passed on by stop(), once
            group = getattr(os, "setpgrp", None)
            process = subprocess.Popen(line, stdout=log, stderr=log, preexec_fn=group)
        self.running.append((process, run))
        print(f"{_now()} {run.name}: to {millions:g} M steps", flush=True)

    def work(self, processes: int) -> bool:
        """Does all jobs, so many at a time. Returns whether it was not stopped and none failed.

        SIGINT and SIGTERM stop it as `stop` does.
        """
        before = {kind: signal.signal(kind, self.stop) for kind in (signal.SIGINT, signal.SIGTERM)}
        try:
            while self.running or (self.waiting and not self.stopped):
                while self.waiting and not self.stopped and len(self.running) < processes:
                    count = len(self.running)
                    self._start()
                    if len(self.running) == count:
                        break
                time.sleep(POLL_SECONDS)
                self._collect()
        finally:
            for kind, handler in before.items():
                signal.signal(kind, handler)
        return not (self.stopped or self.failed)

    def _collect(self) -> None:
        """Takes note of runs that have ended; a run that fails is left out from then on."""
        for process, run in [each for each in self.running if each[0].poll() is not None]:
            self.running.remove((process, run))
            if process.returncode and not self.stopped:
                self.failed.append(run.name)
                self.waiting = [job for job in self.waiting if job[0].name != run.name]
                print(f"{_now()} {run.name}: failed, see {run.home}/S{run.seed}.log", flush=True)
            else:
                print(f"{_now()} {run.name}: is at {run.reached():.0f} M steps", flush=True)


def _now() -> str:
    return time.strftime("%F %T")
