"""What untrusted code cannot reach: files, processes, network."""

import errno
import os
import platform
import sys
from pathlib import Path

import pytest

from botschool.sandbox import paths, process, scratch, seccomp, syscalls


def test_files_outside_are_out_of_reach(confined):
    one = confined("def read(path):\n    return open(path).read()\n")
    assert one.ask("read", os.devnull)["value"] == ""
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
        assert one.ask("go", *arguments)["value"] == [-1, errno.EPERM], name
    assert one.ask("go", 285, 0, 0, 0, 4096)["value"] == [-1, errno.EOPNOTSUPP]  # fallocate


def test_threads_still_start(confined):
    text = (
        "import threading\ndef go():\n    done = []\n"
        "    one = threading.Thread(target=done.append, args=(1,))\n"
        "    one.start(); one.join()\n    return done\n"
    )
    assert confined(text).ask("go")["value"] == [1]


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


# --- The filter of system calls: its numbers, and what it answers to calls that it does not know.


TABLES = (syscalls.ALLOWED, syscalls.PRETENDED, syscalls.ABSENT, syscalls.CONDITIONAL)


def answer(code, number, *arguments):
    """What a filter answers to a system call on its machine: a small BPF machine."""
    words = {0: number, 4: code[1][3]}
    for at, value in enumerate(arguments):
        words[16 + 8 * at], words[20 + 8 * at] = value & 0xFFFFFFFF, value >> 32
    held, at = 0, 0
    while True:
        operation, yes, no, value = code[at]
        at += 1
        if operation == 0x06:
            return value
        if operation == 0x20:
            held = words.get(value, 0)
        elif operation == 0x54:
            held &= value
        else:
            at += yes if {0x15: held == value, 0x35: held >= value}[operation] else no


ALLOW, REFUSE, PRETEND, UNKNOWN = 0x7FFF0000, 0x50001, 0x50000, 0x50000 | errno.ENOSYS


@pytest.mark.parametrize("machine", ["x86_64", "aarch64"])
def test_all_else_is_refused(machine):
    code = seccomp.program(machine, 77)
    column = {"x86_64": 0, "aarch64": 1}[machine]
    number = {name: each[column] for table in TABLES for name, each in table.items()}
    listed = set(number.values())
    for other in range(syscalls.NEWEST + 1):
        if other not in listed:
            assert answer(code, other) == REFUSE, other
    assert answer(code, syscalls.NEWEST + 1) == UNKNOWN
    assert answer(code, 0x40000001) == REFUSE
    for name in syscalls.ALLOWED:
        if number[name] is not None:
            assert answer(code, number[name], 1, 2, 3) == ALLOW, name
    for name, arguments, expected in (
        ("clone", (0x3D0F00,), ALLOW),
        ("clone", (0x7D0F00,), ALLOW),
        ("clone", (0x3D0F00 | 0x20000,), REFUSE),
        ("clone", (0x3D0F00 & ~0x400,), REFUSE),
        ("clone", (17,), REFUSE),
        ("clone3", (0,), UNKNOWN),
        ("kill", (77, 9), ALLOW),
        ("kill", (0, 9), REFUSE),
        ("kill", (2**32 - 1, 9), REFUSE),
        ("tgkill", (78, 78, 9), REFUSE),
        ("close_range", (3, 9, 4), ALLOW),
        ("close_range", (3, 9, 2), REFUSE),
        ("close_range", (3, 9, 6), REFUSE),
        ("prlimit64", (0, 7, 0, 1), ALLOW),
        ("prlimit64", (0, 7, 2**32, 1), REFUSE),
        ("prlimit64", (0, 7, 1, 0), REFUSE),
        ("prlimit64", (1, 7, 0, 1), REFUSE),
        ("fcntl", (3, 6, 1), PRETEND),
        ("fcntl", (3, 8, 1), REFUSE),
        ("fcntl", (3, 1031, 1), REFUSE),
        ("flock", (3, 2), PRETEND),
        ("prctl", (4, 0), REFUSE),
        ("ioctl", (0, 0x5412), 0x50000 | errno.ENOTTY),  # TIOCSTI
    ):
        assert answer(code, number[name], *arguments) == expected, (name, arguments)


# --- Limits of a child: output, files, time.


def test_output_is_bounded(sandboxed):
    one = sandboxed("def talk():\n    while True: print('x' * 100_000)\n")
    assert one.ask("talk") is None  # not a TimeoutError: it did not go on until its time was over
    assert one.child.ending() == "it printed more than 16 MB"
    assert len(one.child.printed()) < process.OUTPUT_KEPT + 100


def test_written_files_are_bounded(sandboxed, monkeypatch):
    monkeypatch.setattr(scratch, "MAX_WRITTEN_FILES", 50)
    many = sandboxed("def write():\n    for n in range(10**6): open(f'{n}', 'w').close()\n")
    assert many.ask("write") is None
    assert many.child.ending() == "it wrote more than 50 files"
    large = sandboxed("def write():\n    open('x', 'wb').write(b'1' * 70 * 2**20)\n")
    assert large.ask("write")["error"] == "OSError"


@pytest.mark.skipif(sys.platform != "linux", reason="seen in /proc")
@pytest.mark.parametrize("how", ["open", "mapped"])
def test_removed_files_count_while_they_fill_the_disk(sandboxed, monkeypatch, how):
    """Without a name, and mapped without even a descriptor: seen by nothing but /proc."""
    monkeypatch.setattr(scratch, "MAX_WRITTEN", 40 * 2**20)
    monkeypatch.setattr(process, "MAX_FILE", 16 * 2**20)
    one = sandboxed(
        "import ctypes, os, time\nKEPT = []\n"
        "libc = ctypes.CDLL(None)\nlibc.mmap.restype = ctypes.c_void_p\n"
        "def fill(how, count):\n"
        "    for number in range(count):\n"
        "        file = open(f'{number}', 'w+b')\n"
        "        file.write(bytes(8 * 2**20))\n"
        "        file.flush()\n"
        "        if how == 'open':\n"
        "            KEPT.append(file)\n"
        "        else:\n"
        "            libc.mmap(None, 4096, 1, 1, file.fileno(), 0)\n"
        "            file.close()\n"
        "        os.unlink(f'{number}')\n"
        "        time.sleep(0.01)\n"
        "    time.sleep(0.5)\n"
    )
    assert one.ask("fill", how, 2)["value"] is None
    answer = one.ask("fill", how, 20)
    if answer is None:
        assert one.child.ending() == "it wrote more than 40 MB of files"
    else:  # on a busy machine the folder is full before /proc is looked at again
        assert "[Errno 28]" in answer["text"]
