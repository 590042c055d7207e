"""The time of answers: computing and sleeping are charged, waiting for a processor is not."""

import contextlib
import os
import subprocess
import sys

import pytest

from botschool.sandbox import Allowance, usage

BUSY = "def work(seconds):\n    import time\n    while time.process_time() < seconds: pass\n"


@pytest.fixture
def clock(monkeypatch):
    """Processor time, delay and time that a process has used, to be set."""
    used = {"processor": 0.0, "delayed": 0.0, "time": 100.0}
    monkeypatch.setattr(usage, "processor_seconds", lambda pid: used["processor"])
    monkeypatch.setattr(usage, "delayed_seconds", lambda pid: used["delayed"])
    monkeypatch.setattr("time.monotonic", lambda: used["time"])
    return used


def test_a_process_that_waits_for_a_processor_is_charged_what_it_computes(clock):
    allowance = Allowance(10)
    with allowance.charged(1) as left:
        clock.update(processor=4.0, delayed=30.0, time=134.0)
        assert left() == 6
    assert (allowance.processor, allowance.active, allowance.passed) == (4, 4, 34)
    with allowance.charged(1) as left:
        clock.update(processor=10.0, delayed=60.0, time=170.0)
        assert left() == 0
    assert not allowance.slept


def test_a_process_that_sleeps_has_more_time_but_not_for_ever(clock):
    allowance = Allowance(10)
    with allowance.charged(1) as left:
        clock.update(time=121.0)
        assert left() == 1
        clock.update(time=122.0)
        assert left() == 0
    assert allowance.slept


def test_no_process_is_kept_waiting_for_ever(clock):
    allowance = Allowance(10)
    with allowance.charged(1) as left:
        clock.update(delayed=159.0, time=259.0)
        assert left() == 1


def test_where_nothing_is_known_the_time_that_passes_counts(clock, monkeypatch):
    monkeypatch.setattr(usage, "processor_seconds", lambda pid: None)
    allowance = Allowance(10)
    with allowance.charged(1) as left:
        clock.update(time=107.0)
        assert left() == 3


def test_an_endless_loop_and_an_endless_sleep(sandboxed):
    busy, idle = Allowance(0.5), Allowance(0.5)
    one = sandboxed(BUSY + "def nap():\n    import time\n    time.sleep(10**6)\n")
    with pytest.raises(TimeoutError):
        one.child.ask({"name": "nap", "arguments": [], "options": {}}, idle)
    assert idle.slept and idle.processor < 0.5 and idle.active >= 3
    two = sandboxed(BUSY)
    with pytest.raises(TimeoutError):
        two.child.ask({"name": "work", "arguments": [10**6], "options": {}}, busy)
    if sys.platform == "linux":
        assert busy.processor >= 0.5 and not busy.slept


@pytest.mark.skipif(not hasattr(os, "sched_setaffinity"), reason="pins processes")
def test_a_busy_machine_costs_no_time(sandboxed, server):
    """0.7 seconds of processor time, of one allowed, while nine programs share a processor."""
    if not usage.delayed_seconds(os.getpid()):
        pytest.skip("this system does not tell how long a process waits")
    processor = min(os.sched_getaffinity(0))
    before = os.sched_getaffinity(server._process.pid)
    with contextlib.ExitStack() as stack:
        os.sched_setaffinity(server._process.pid, {processor})
        stack.callback(os.sched_setaffinity, server._process.pid, before)
        one = sandboxed(BUSY)
        loop = f"import os\nos.sched_setaffinity(0, {{{processor}}})\nprint(flush=True)\n"
        loop += "while True: pass"
        # sessions of their own: where processors are shared by session, each counts as one, too
        others = [
            subprocess.Popen(
                [sys.executable, "-c", loop], stdout=subprocess.PIPE, start_new_session=True
            )
            for _ in range(8)
        ]
        for other in others:
            stack.enter_context(other)
            stack.callback(other.kill)
        for other in others:
            assert other.stdout.readline() == b"\n"  # it runs
        allowance = Allowance(1)
        answer = one.child.ask({"name": "work", "arguments": [0.7], "options": {}}, allowance)
    assert answer == {"value": None}
    assert allowance.processor < 1 < allowance.passed
