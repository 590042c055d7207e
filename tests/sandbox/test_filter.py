"""The filter of system calls: its numbers, and what it answers to calls that it does not know."""

import errno
import re
from pathlib import Path

import pytest

from botschool.sandbox import seccomp, syscalls

TABLES = (syscalls.ALLOWED, syscalls.PRETENDED, syscalls.ABSENT, syscalls.CONDITIONAL)
HEADERS = [
    (0, "/usr/include/x86_64-linux-gnu/asm/unistd_64.h", r"#define __NR_(\w+) (\d+)"),
    (1, "/usr/include/asm-generic/unistd.h", r"#define __NR(?:3264)?_(\w+) (\d+)"),
]
ELSEWHERE = {"fstatat": "newfstatat"}  # names of the generic header


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


def test_no_call_stands_in_two_tables():
    for column in (0, 1):
        numbers = [each[column] for table in TABLES for each in table.values()]
        numbers = [number for number in numbers if number is not None]
        assert len(numbers) == len(set(numbers))
        assert max(numbers) <= syscalls.NEWEST


@pytest.mark.parametrize(("column", "header", "line"), HEADERS, ids=["x86_64", "aarch64"])
def test_numbers_are_those_of_linux(column, header, line):
    if not Path(header).exists():
        pytest.skip(f"{header} is not installed")
    found = {
        ELSEWHERE.get(name, name): int(number)
        for name, number in re.findall(line, Path(header).read_text())
    }
    known = 0
    for table in TABLES:
        for name, numbers in table.items():
            if name in found:
                assert numbers[column] == found[name], name
                known += 1
            elif numbers[column] is not None:
                assert numbers[column] > max(found.values()) or column == 1, name
    assert known > 100


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
