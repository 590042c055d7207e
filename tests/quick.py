"""Fails a test that takes much processor time and is not marked `slow`."""

import os
import time
from pathlib import Path

import pytest
from _pytest.runner import runtestprotocol

MARKS = {"slow", "long", "course"}
YARDSTICK = 0.012  # seconds of a fixed loop where the limit was chosen, on an idle core


def slowness():
    """Return how much slower the processor is just now: seconds of a fixed loop, in yardsticks."""
    start = time.process_time()
    sum(number * number % 7 for number in range(180_000))
    return max(1.0, (time.process_time() - start) / YARDSTICK)


def processor_time(process="self"):
    """Return the seconds that a process and all below it have used (Linux)."""
    fields = Path("/proc", process, "stat").read_text().rpartition(")")[2].split()[11:15]
    seconds = sum(map(int, fields)) / os.sysconf("SC_CLK_TCK")
    for children in Path("/proc", process).glob("task/*/children"):
        try:
            seconds += sum(processor_time(child) for child in children.read_text().split())
        except OSError:  # it has just ended, and is counted as one of its parent's
            continue
    return seconds


class Quick:
    """The plugin: `limit` are a test's seconds. What tests share (a module's fixture) is not
    counted, and a test that takes longer runs once more, since the first one pays for imports.
    """

    def __init__(self, limit):
        self.limit, self.shared = limit, 0.0

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        start = processor_time()
        try:
            return (yield)
        finally:
            self.shared += (processor_time() - start) * (fixturedef.scope != "function")

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_protocol(self, item, nextitem):
        if not MARKS.isdisjoint(mark.name for mark in item.iter_markers()):
            return None
        where = {"nodeid": item.nodeid, "location": item.location}
        item.ihook.pytest_runtest_logstart(**where)
        reports, over = self.measured(item, nextitem)
        if over and all(report.passed for report in reports):
            reports, over = self.measured(item, nextitem)
            if over and reports[1].passed:
                reports[1].outcome, reports[1].longrepr = "failed", over
        for report in reports:
            item.ihook.pytest_runtest_logreport(report=report)
        item.ihook.pytest_runtest_logfinish(**where)
        return True

    def measured(self, item, nextitem):
        """Run a test; return its reports, and a sentence where it takes too long."""
        start, self.shared = processor_time(), 0.0
        reports = runtestprotocol(item, nextitem=nextitem, log=False)
        seconds = processor_time() - start - self.shared
        if seconds <= self.limit or seconds <= self.limit * slowness():
            return reports, None
        return reports, (
            f"{item.nodeid} takes {seconds:.2f} s of processor, more than {self.limit}: make it "
            "quicker, or mark it with @pytest.mark.slow"
        )
