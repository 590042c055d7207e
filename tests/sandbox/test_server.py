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


@pytest.mark.slow
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


# --- The time of answers: computing and sleeping are charged, waiting for a processor is not.


BUSY = "def work(seconds):\n    import time\n    while time.process_time() < seconds: pass\n"


@pytest.mark.slow
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


@pytest.mark.slow
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
