"""The fork server: what children share, and what happens when one cannot start."""

import ast
import contextlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

import botschool.sandbox
from botschool.sandbox import Allowance, Child, ForkServer, Limits, SandboxError, Scratch, usage
from botschool.sandbox.exceptions import nearest


def test_imports_are_made_before_a_child_starts(tmp_path):
    slow = tmp_path / "site-packages"
    slow.mkdir()
    (slow / "slow_library.py").write_text(
        "import time\nprint('a banner')\ntime.sleep(3)\nNUMBER = 7\n"
    )
    file = tmp_path / "own" / "untrusted.py"
    file.parent.mkdir()
    file.write_text("import slow_library\ndef get(): return slow_library.NUMBER\n")
    scratch = Scratch(file)
    sys.path.append(str(slow))
    try:
        with ForkServer(["slow_library"]) as server:
            for _ in range(2):
                child = Child(server, scratch, file.name, Limits(1))
                request = {"name": "get", "arguments": [], "options": {}}
                assert child.ask(request, Allowance(1))["value"] == 7
                child.kill()
                assert child.printed() == ""
        with (
            ForkServer(["no_such_library"]) as server,
            pytest.raises(SandboxError, match="did not start: ModuleNotFoundError: No module"),
        ):
            Child(server, scratch, file.name, Limits(1))
    finally:
        sys.path.remove(str(slow))
        scratch.remove()


def test_children_share_nothing(sandboxed):
    text = (
        "import os, random\nimport numpy\nKEPT = []\n"
        "def draw():\n    KEPT.append(1)\n"
        "    return [len(KEPT), numpy.random.rand(), random.random(), os.environ['HOME']]\n"
    )
    drawn = [sandboxed(text).ask("draw")["value"] for _ in range(2)]
    assert [each[0] for each in drawn] == [1, 1]
    assert all(one != other for one, other in zip(drawn[0][1:], drawn[1][1:], strict=True))


def test_systems_without_process_groups_are_refused(monkeypatch):
    monkeypatch.delattr(os, "killpg")
    with pytest.raises(SandboxError, match="WSL"):
        ForkServer()


# --- The sandbox imports nothing of botschool but itself.


FILES = sorted(Path(botschool.sandbox.__file__).parent.glob("*.py"))


def imported(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file.name}: a relative import"
            yield node.module


def test_no_file_names_another_part_of_botschool():
    assert len(FILES) >= 8
    for file in FILES:
        for name in imported(file):
            own = name == "botschool.sandbox" or name.startswith("botschool.sandbox.")
            assert own or name.split(".")[0] != "botschool", f"{file.name} imports {name}"


def test_nothing_else_of_botschool_is_loaded():
    modules = ", ".join(f"botschool.sandbox.{file.stem}" for file in FILES)
    loaded = subprocess.run(
        [sys.executable, "-c", f"import sys, {modules}\nprint(*sys.modules)"],
        capture_output=True, text=True, check=True,
    ).stdout.split()  # fmt: skip
    others = {name for name in loaded if name.startswith("botschool.")}
    alone = {name for name in others if not name.startswith("botschool.sandbox")}
    assert alone == set()


# --- What a child tells of exceptions, and where it is when its time is up.


@pytest.mark.parametrize(
    ("name", "names", "found"),
    [
        ("rank", ["ranks", "tank"], "ranks"),
        ("next_population", ["NextPopulation", "next_popul"], "NextPopulation"),
        ("evolve", ["evolve_population", "x"], "evolve_population"),
        ("rank", ["train", "evolve"], None),
        ("rank", ["rank"], None),
        ("x" * 100, ["x" * 99], None),
    ],
)
def test_nearest(name, names, found):
    assert nearest(name, names) == found


def test_places(sandboxed):
    one = sandboxed("def f():\n    return g()\ndef g():\n    return [][1]\ndef h(a): pass\n")
    assert one.ask("f") == {
        "error": "IndexError", "text": "list index out of range", "file": "untrusted.py",
        "line": 4, "column": None, "near": None, "call": None,
        "process": False,
    }  # fmt: skip
    assert one.ask("ff")["error"] == "Missing"
    told = one.ask("h")
    assert (told["error"], told["call"]) == ("Signature", "h(a)")


def test_where_it_is(sandboxed):
    one = sandboxed("def f():\n    while True:\n        g()\ndef g():\n    sum(range(10**4))\n")
    with pytest.raises(TimeoutError):
        one.ask("f", seconds=0.3)
    places = one.child.where()
    assert places[-1] == ("untrusted.py", 3) and set(places[:-1]) <= {("untrusted.py", 5)}
    one.child.kill()
    assert one.child.where() == []


def test_where_of_one_that_does_not_tell(sandboxed):
    text = "from signal import *\ndef f():\n    signal(SIGUSR1, SIG_IGN)\n    while True: pass\n"
    one = sandboxed(text)
    with pytest.raises(TimeoutError):
        one.ask("f", seconds=0.3)
    assert one.child.where() == []


def test_twice(sandboxed):
    one = sandboxed("n = 0\ndef f(x):\n    global n\n    n += 1\n    x.append(n)\n    return n\n")
    request = {"name": "f", "arguments": [[7]], "options": {}, "twice": True}
    assert one.child.ask(request, Allowance(5))["value"] == {
        "answers": [1, 2], "arguments": [[7, 1]],
    }  # fmt: skip


# --- The time of answers: computing and sleeping are charged, waiting for a processor is not.


BUSY = "def work(seconds):\n    import time\n    while time.process_time() < seconds: pass\n"


@pytest.fixture
def clock(monkeypatch):
    """Processor time, delay and time that a process has used, to be set."""
    used = {"processor": 0.0, "delayed": 0.0, "time": 100.0}
    monkeypatch.setattr(usage, "processor_seconds", lambda pid: used["processor"])
    monkeypatch.setattr(usage, "delayed_seconds", lambda pid: used["delayed"])
    monkeypatch.setattr("time.monotonic", lambda: used["time"])
    monkeypatch.setattr(Allowance, "PAUSE", float("inf"))  # time may jump
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


def test_a_pause_of_the_machine_is_not_charged(clock, monkeypatch):
    monkeypatch.setattr(Allowance, "PAUSE", 2.0)
    allowance = Allowance(1)
    with allowance.charged(1) as left:
        clock.update(time=1000.0)  # nobody could ask what is left
        assert left() == 1
        assert (allowance.active, allowance.passed) == (2, 2)
        for _ in range(30):
            clock["time"] += 0.1
            left()
        assert left() <= 0  # but a child that sleeps while others are awake is
    assert allowance.slept


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
        loop += "import time\nend = time.monotonic() + 120\nwhile time.monotonic() < end: pass"
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
    assert answer["value"] is None
    assert allowance.processor < 1 < allowance.passed
