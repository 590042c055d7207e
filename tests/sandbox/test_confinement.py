"""What untrusted code cannot reach: files, processes, network."""

import errno
import os
import platform
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


SHARED = {  # number on x86_64, and arguments that would make, use or remove something
    "shmget": (29, 1234, 4096, 0o1666), "shmat": (30, 0, 0, 0), "shmctl": (31, 0, 0, 0),
    "shmdt": (67, 0), "semget": (64, 1234, 1, 0o1666), "semop": (65, 0, 0, 0),
    "semctl": (66, 0, 0, 0), "semtimedop": (220, 0, 0, 0, 0), "msgget": (68, 1234, 0o1666),
    "msgsnd": (69, 0, 0, 0, 0), "msgrcv": (70, 0, 0, 0, 0, 0), "msgctl": (71, 0, 0, 0),
    "mq_open": (240, 0, 0, 0, 0), "mq_unlink": (241, 0), "mq_timedsend": (242, 0, 0, 0, 0, 0),
    "mq_timedreceive": (243, 0, 0, 0, 0, 0), "mq_notify": (244, 0, 0),
    "mq_getsetattr": (245, 0, 0, 0), "inotify_init": (253,), "inotify_init1": (294, 0),
    "inotify_add_watch": (254, 0, 0, 0), "fanotify_init": (300, 0, 0),
    "fanotify_mark": (301, 0, 0, 0, 0, 0), "landlock_create_ruleset": (444, 0, 0, 1),
    "prctl(PR_SET_DUMPABLE)": (157, 4, 0, 0, 0, 0),
    "clone(CLONE_THREAD)": (56, 0x10000, 0, 0, 0, 0),
}  # fmt: skip


@pytest.mark.skipif(
    sys.platform != "linux" or platform.machine() != "x86_64", reason="numbers of x86-64"
)
def test_nothing_is_shared_with_other_processes(confined):
    """Refused by the filter (EPERM) whatever the arguments."""
    one = confined(
        "import ctypes\nlibc = ctypes.CDLL(None, use_errno=True)\n"
        "def go(*numbers):\n    return [libc.syscall(*numbers), ctypes.get_errno()]\n"
    )
    for name, arguments in SHARED.items():
        assert one.ask("go", *arguments) == {"value": [-1, errno.EPERM]}, name
    assert one.ask("go", 285, 0, 0, 0, 4096) == {"value": [-1, errno.EOPNOTSUPP]}  # fallocate


def test_threads_still_start(confined):
    text = (
        "import threading\ndef go():\n    done = []\n"
        "    one = threading.Thread(target=done.append, args=(1,))\n"
        "    one.start(); one.join()\n    return done\n"
    )
    assert confined(text).ask("go") == {"value": [1]}


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
