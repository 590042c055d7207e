"""The fork server: what children share, and what happens when one cannot start."""

import os
import sys

import pytest

from botschool.sandbox import Allowance, Child, ForkServer, Limits, SandboxError, Scratch


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
                assert child.ask(request, Allowance(1)) == {"value": 7}
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
