"""Runs attacks on the sandbox, each in a child of its own, and prints what came of them as JSON.

python attacks.py FOLDER memory|disk [NAME ...]: all of ATTACKS or some, with their files in FOLDER;
disk: as where namespaces are not allowed. It is a program so that tests run it as another user
(test_attacks.py).
"""

import ctypes
import fcntl
import json
import os
import platform
import sys
from pathlib import Path

from botschool.sandbox import (
    Allowance,
    Child,
    ForkServer,
    Limits,
    Scratch,
    paths,
    process,
    scratch,
    seccomp,
    usage,
)

MEGABYTE = 2**20
START = """
import ctypes, errno, fcntl, os, sys, threading, time
libc = ctypes.CDLL(None, use_errno=True)
libc.mmap.restype = ctypes.c_void_p

def call(x86, arm, *arguments):
    number = x86 if os.uname().machine == "x86_64" else arm
    arguments = [ctypes.c_long(each) for each in arguments]
    return [libc.syscall(number, *arguments), ctypes.get_errno()]

def write(name, megabytes=8):
    file = os.open(name, os.O_RDWR | os.O_CREAT)
    for _ in range(megabytes):
        os.write(file, bytes(2**20))
    return file

def mapped(name):
    file = write(name)
    libc.mmap(None, 4096, 1, 1, file, 0)
    os.close(file)
    os.unlink(name)

"""
ATTACKS = {
    # a name that cuts a line of /proc/PID/maps in two
    "odd_name": """
def go():
    file = write("a\\rb", 1)
    libc.mmap(None, 4096, 1, 1, file, 0)
    os.unlink("a\\rb")
    time.sleep(0.3)
    threading.stack_size(2**16)
    for _ in range(100):
        threading.Thread(target=time.sleep, args=(9,), daemon=True).start()
    time.sleep(9)
    return "LEAKED"
""",
    "odd_names_of_removed_files": """
def go():
    for number in range(12):
        mapped(f"\\r{number}\\n (deleted)")
    time.sleep(9)
    return "LEAKED"
""",
    # descriptors that only one thread has
    "own_descriptors": """
def go():
    return call(436, 436, 1000, 2000, 2)
""",
    "own_descriptors_in_a_thread": """
def fill(number):
    call(436, 436, 1000, 2000, 2)
    kept = os.open(str(number), os.O_RDWR | os.O_CREAT)
    os.unlink(str(number))
    for _ in range(20):
        os.write(kept, bytes(2**20))
    time.sleep(9)

def go():
    for number in range(8):
        threading.Thread(target=fill, args=(number,), daemon=True).start()
    time.sleep(9)
    return "LEAKED"
""",
    # /proc/PID/fd of a process whose first thread has ended is empty
    "first_thread_ends": """
def fill():
    time.sleep(0.2)
    for number in range(8):
        kept = write(str(number), 4)
        os.unlink(str(number))
    time.sleep(9)

def go():
    threading.Thread(target=fill).start()
    call(60, 93, 0)
""",
    "removed_folders": """
def go():
    for number in range(200):
        os.mkdir("x")
        os.open("x", os.O_RDONLY)
        os.rmdir("x")
    time.sleep(9)
    return "LEAKED"
""",
    "removed_files": """
def go():
    for number in range(8):
        write("x")
        os.unlink("x")
    time.sleep(9)
    return "LEAKED"
""",
    "files": """
def go():
    for number in range(8):
        os.close(write(str(number)))
    time.sleep(9)
    return "LEAKED"
""",
    "many_files": """
def go():
    for number in range(1000):
        os.close(write(str(number), 0))
    time.sleep(9)
    return "LEAKED"
""",
    # the watch walks through folders that vanish
    "vanishing_folders": """
def change(name):
    for number in range(20):
        os.mkdir(f"{name}{number}")
    while True:
        for number in range(20):
            os.rename(f"{name}{number}", f"{name}_{number}")
        for number in range(20):
            os.rename(f"{name}_{number}", f"{name}{number}")

def go():
    for name in "ab":
        threading.Thread(target=change, args=(name,), daemon=True).start()
    for number in range(8):
        os.mkdir(f"z{number}")
        os.close(write(f"z{number}/file"))
    time.sleep(9)
    return "LEAKED"
""",
    "overwritten_and_synchronised": """
def go():
    for number in range(300):  # so many that the fastest disk needs longer than the watch waits
        file = write("x")
        os.fsync(file)
        os.close(file)
        os.unlink("x")
    return "written"
""",
    "memory_shared_with_nobody": """
def go():
    for number in range(100):
        if libc.mmap(None, ctypes.c_size_t(2**26), 3, 0x21, -1, 0) == 2**64 - 1:
            return "refused"
    return "LEAKED"
""",
    "locks": """
def go(readable):
    file = os.open(readable, os.O_RDONLY)
    fcntl.flock(file, fcntl.LOCK_EX)
    fcntl.lockf(file, fcntl.LOCK_SH)
    return "locked"
""",
    "a_thread_of_another_kind": """
def go():
    return call(56, 220, 0x3d0f00 & ~0x200, 0, 0, 0, 0)
""",
    "signals_through_pipes": """
def go():
    reader, writer = os.pipe()
    told = []
    for control, value in ((8, os.getppid()), (10, 9), (1031, 2**20), (1024, 0), (1033, 1)):
        try:
            fcntl.fcntl(reader, control, value)
        except PermissionError:
            continue
        told.append(control)
    return told
""",
    # syncfs, sync, timer_create, vmsplice, splice, tee, memfd_create, signalfd4, name_to_handle_at,
    # open_tree, fsopen, seccomp, setsid, mlock, personality, capset
    "calls": """
def go():
    numbers = [(306, 267), (162, 81), (222, 107), (278, 75), (275, 76), (276, 77), (319, 279),
               (289, 74), (303, 264), (428, 428), (430, 430), (317, 277), (112, 157), (149, 228),
               (135, 92), (126, 91)]
    return [each for each in numbers if call(*each, 0, 0, 0, 0) != [-1, errno.EPERM]]
""",
    # io_uring_setup, userfaultfd, ptrace, process_vm_readv and writev, memfd_secret,
    # open_by_handle_at, pidfd_open, pidfd_getfd, kcmp, bpf, perf_event_open, unshare, setns, mount,
    # keyctl, shmget, mknodat, socket, execveat, landlock_create_ruleset, chroot, pivot_root
    "more_calls": """
def go():
    numbers = [(425, 425), (323, 282), (101, 117), (310, 270), (311, 271), (447, 447), (304, 265),
               (434, 434), (438, 438), (312, 272), (321, 280), (298, 241), (272, 97), (308, 268),
               (165, 40), (250, 219), (29, 194), (259, 33), (41, 198), (322, 281), (444, 444),
               (161, 51), (155, 41)]
    return [each for each in numbers if call(*each, 0, 0, 0, 0) != [-1, errno.EPERM]]
""",
    # what the fork server holds, and what this process is to others
    "memory_of_the_server": """
def go():
    found = []
    for pid in (os.getppid(), os.getpid(), 1):
        for name in ("mem", "environ", "maps", "cmdline", "auxv", "stack", "root/etc/shadow"):
            for mode in ("rb", "r+b"):
                try:
                    open(f"/proc/{pid}/{name}", mode)
                except OSError:
                    continue
                found.append((pid, name, mode))
        for name in ("fd", "task", "map_files") + ("cwd",) * (pid != os.getpid()):
            try:
                os.listdir(f"/proc/{pid}/{name}")
            except OSError:
                continue
            found.append((pid, name))
    return found
""",
    # files that claim terabytes, and a name that is no line
    "sparse_files": """
def go():
    refused = []
    file = os.open("a\\nb.png", os.O_RDWR | os.O_CREAT)
    for size in (2**31, 2**40, 2**62):
        try:
            os.ftruncate(file, size)
        except OSError as error:
            refused.append(error.errno == errno.EFBIG)
    return refused
""",
    # links of the scratch folder to files of others, by name and by inode
    "hard_links": """
def go():
    made = []
    for name in ("/etc/passwd", sys.executable, "/proc/self/fd/0"):
        for options in ({}, {"follow_symlinks": True}):
            try:
                os.link(name, "linked", **options)
            except OSError:
                continue
            made.append(name)
    return made
""",
    "larger_limits": """
def go():
    import resource
    before = resource.getrlimit(resource.RLIMIT_AS)
    for which in (resource.RLIMIT_AS, resource.RLIMIT_FSIZE, resource.RLIMIT_NOFILE):
        try:
            resource.setrlimit(which, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        except (ValueError, OSError):
            continue
        return "LEAKED"
    return before == resource.getrlimit(resource.RLIMIT_AS)
""",
    # a folder that becomes a link, for the caller who reads a file in it
    "a_link_to_elsewhere": """
def go():
    here = os.getcwd()
    os.rename(here, here + "-moved")
    os.symlink("/etc", here)
    return "linked"
""",
    "neighbours": """
def go(file):
    found = []
    for attempt in (open, os.listdir, lambda name: open(name, "w"), os.unlink, os.rmdir):
        for name in (file, os.path.dirname(file), os.path.dirname(os.path.dirname(file))):
            try:
                attempt(name)
            except OSError:
                continue
            found.append(name)
    return found
""",
    # the number of threads is not the name of one
    "a_name_like_numbers": """
def go():
    libc.prctl(15, b") R 1 1 1", 0, 0, 0)
    threading.stack_size(2**16)
    for _ in range(100):
        threading.Thread(target=time.sleep, args=(9,), daemon=True).start()
    time.sleep(9)
    return "LEAKED"
""",
    # the fork server's socket, where the caller has many open files
    "inherited_descriptors": """
def go():
    import stat
    found = []
    for file in range(3, 1000):
        try:
            kind = os.fstat(file).st_mode
        except OSError:
            continue
        if not stat.S_ISFIFO(kind):
            found.append(file)
    return found
""",
    "ordinary_work": """
def go():
    import sqlite3, tempfile, shutil, subprocess
    with tempfile.NamedTemporaryFile("w", dir=".") as file:
        file.write("x")
        shutil.copy2(file.name, "copied")
    base = sqlite3.connect("base")
    base.execute("create table t (n)")
    base.execute("insert into t values (7)")
    base.commit()
    done = []
    threads = [threading.Thread(target=done.append, args=(n,)) for n in range(20)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return [len(done), base.execute("select n from t").fetchone()[0]]
""",
}


def refuse_namespaces() -> None:
    """Refuse unshare, for this process and its children, as systems without namespaces do."""
    libc = ctypes.CDLL(None)
    libc.prctl(38, 1, 0, 0, 0)
    number = {"x86_64": 272, "aarch64": 97}[platform.machine()]
    code = [(0x20, 0, 0, 0), (0x15, 0, 1, number), (6, 0, 0, 0x50001), (6, 0, 0, 0x7FFF0000)]
    assert seccomp.install(libc, code)


def main() -> None:
    """Print {"in_memory", "missing", "attacks": {name: [answer, ending]}, "more"}."""
    scratch.MAX_WRITTEN, scratch.MAX_WRITTEN_FILES = 40 * MEGABYTE, 100
    process.MAX_FILE = 32 * MEGABYTE
    if hasattr(process, "MAX_WRITTEN_IN_ALL"):
        process.MAX_WRITTEN_IN_ALL = 160 * MEGABYTE
    if sys.argv[2] == "disk":
        refuse_namespaces()
    top = Path(sys.argv[1])
    readable = [*paths.interpreter_paths(), *paths.system_paths()]
    told, more = {}, {}
    # the sockets of a caller with many open files have high numbers
    kept = [os.open(os.devnull, os.O_RDONLY) for _ in range(150)]
    with ForkServer() as server, ForkServer() as other:
        precious = start(other, top / "precious", "def go(): pass\n", [])
        for name in sys.argv[3:] or ATTACKS:
            locked = top / f"{name}.lock"
            locked.write_text("x")
            one = start(server, top / name, START + ATTACKS[name], [*readable, locked])
            arguments = {"locks": [str(locked)], "neighbours": [str(precious[1].folder / "u.py")]}
            request = {"name": "go", "arguments": arguments.get(name, []), "options": {}}
            try:
                # it writes 2.4 GB, which takes a busy machine more than two seconds
                seconds = 20 if name == "overwritten_and_synchronised" else 2
                answer = one[0].ask(request, Allowance(seconds))
            except TimeoutError:
                answer = {"error": "TimeoutError"}
            if name == "locks":
                with open(locked) as file:
                    try:
                        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
                        more["lock"] = "free"
                    except BlockingIOError:
                        more["lock"] = "held"
            if name == "a_link_to_elsewhere":
                try:
                    one[1].copy("passwd")
                    more["link"] = "followed"
                except OSError:
                    more["link"] = "not followed"
            ending = one[0].ending() if answer is None else ""
            answer = answer and (answer["value"] if "value" in answer else answer["error"])
            told[name] = [answer, ending]
            one[0].kill()
            one[1].remove()
        result = {
            "in_memory": getattr(precious[1], "in_memory", False),
            "missing": precious[0].missing,
            "attacks": told,
            "more": more
            | {"user": os.getuid(), "descriptors": len(kept), "counted": counts_writes(top)},
        }
        precious[0].kill()
        precious[1].remove()
    print(json.dumps(result))


def counts_writes(folder: Path) -> bool:
    """Return whether Linux counts what is written in a folder: not where it lies in memory."""
    before = usage.written_bytes(os.getpid())
    with (folder / "counted").open("wb") as file:
        file.write(bytes(MEGABYTE))
        file.flush()
        os.fsync(file.fileno())
    return usage.written_bytes(os.getpid()) > before


def start(server: ForkServer, folder: Path, text: str, readable: list[Path]) -> tuple:
    """Return a child for a text, and its scratch folder."""
    folder.mkdir(parents=True)
    (folder / "u.py").write_text(text)
    made = Scratch(folder / "u.py")
    return Child(server, made, "u.py", Limits(20, 2**31), readable), made


if __name__ == "__main__":
    main()
