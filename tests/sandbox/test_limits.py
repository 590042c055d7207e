"""Limits of a child: output, files, time."""

import ctypes
import os
import sys

import pytest

from botschool.sandbox import process, scratch, usage


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
    assert one.ask("fill", how, 2) == {"value": None}
    assert one.ask("fill", how, 20) is None
    assert one.child.ending() == "it wrote more than 40 MB of files"


@pytest.mark.skipif(sys.platform != "linux", reason="seen in /proc")
def test_sizes_of_mapped_files_that_may_not_be_seen(monkeypatch, tmp_path):
    """As for a user who is not root: each counts for the largest size."""
    path = tmp_path / "file"
    path.write_bytes(bytes(4096))
    libc = ctypes.CDLL(None)
    libc.mmap.restype = ctypes.c_void_p
    libc.munmap.argtypes = ctypes.c_void_p, ctypes.c_size_t
    with open(path, "rb") as file:  # Python's own mmap would keep it open
        address = libc.mmap(None, 4096, 1, 1, file.fileno(), 0)
    path.unlink()
    known = os.stat

    def refuse(path, **options):
        if "map_files" in str(path):
            raise PermissionError
        return known(path, **options)

    monkeypatch.setattr(usage.os, "stat", refuse)
    assert usage.removed(os.getpid(), tmp_path, 1000).size == 1000
    assert usage.removed(os.getpid(), tmp_path / "other", 1000).size == 0
    libc.munmap(address, 4096)
    assert usage.removed(os.getpid(), tmp_path, 1000).size == 0


@pytest.mark.parametrize("fault", [ValueError, MemoryError, PermissionError, SystemExit])
def test_what_cannot_be_watched_does_not_run(sandboxed, monkeypatch, fault):
    def fail(pid):
        raise fault

    monkeypatch.setattr(usage, "threads", fail)
    one = sandboxed("import time\ndef nap(): time.sleep(20)\n")
    assert one.ask("nap") is None
    assert one.child.ending() == f"it could not be watched ({fault.__name__})"


def test_exit_is_not_mistaken_for_a_limit(sandboxed):
    one = sandboxed("import os\ndef leave(): os._exit(3)\n")
    assert one.ask("leave") is None
    assert one.child.ending() == "it called exit, so nothing came back"


def test_a_file_that_does_not_fit_is_the_fault_of_the_code(sandboxed, monkeypatch):
    """Not of the machine's disk: the caller is told so even where the code has caught nothing."""
    monkeypatch.setattr(scratch, "MAX_WRITTEN", 20 * 2**20)
    monkeypatch.setattr(process, "POLL_SECONDS", 60)
    one = sandboxed("def write():\n    open('x', 'wb').write(bytes(50 * 2**20))\n")
    if not one.scratch.in_memory:
        pytest.skip("this system allows no mount namespace")
    assert one.ask("write") is None
    assert one.child.ending() == "it wrote more than 20 MB of files"
    one.child.kill()
