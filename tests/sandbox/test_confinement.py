"""What untrusted code cannot reach: files, processes, network."""

import os
import sys
from pathlib import Path

import pytest

from botschool.sandbox import paths, seccomp


def test_files_outside_are_out_of_reach(confined):
    one = confined("def read(path):\n    return open(path).read()\n")
    assert one.ask("read", os.devnull) == {"value": ""}
    for path in (one.file, __file__, "/etc/shadow", f"/proc/{os.getpid()}/environ"):
        assert one.ask("read", str(path))["error"] == "PermissionError", path


@pytest.mark.parametrize(
    "text",
    ["import socket\ndef go(): socket.socket()", "import os\ndef go(): os.fork()",
     "import os\ndef go(): os.kill(os.getppid(), 0)"],
    ids=["socket", "fork", "kill"],
)  # fmt: skip
def test_system_calls_are_refused(confined, text):
    assert confined(text).ask("go")["error"] == "PermissionError"


def test_closed_places_below_readable_ones(tmp_path):
    for name in ("share/fonts", "share/course/solutions", "share/course/data"):
        (tmp_path / name).mkdir(parents=True)
    closed = tmp_path / "share" / "course" / "solutions"
    assert paths.without([tmp_path], [closed]) == [
        tmp_path / "share" / "course" / "data",
        tmp_path / "share" / "fonts",
    ]
    assert paths.without([closed, tmp_path / "nowhere"], [closed]) == []


def test_the_interpreter_may_be_read():
    assert any(os.path.samefile(sys.prefix, place) for place in paths.interpreter_paths())
    assert Path(seccomp.__file__).is_relative_to(paths.IMPORT_ROOT)


def test_filters_of_both_machines():
    for machine in ("x86_64", "aarch64"):
        code = seccomp.program(machine, os.getpid())
        assert len(code) < 4096
        for at, (operation, yes, no, _) in enumerate(code):
            if operation in (0x15, 0x35, 0x45):
                assert at + 1 + max(yes, no) < len(code)
    assert seccomp.program("riscv64", 1) is None
