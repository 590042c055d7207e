"""Hostile submissions that take time, memory and processes; the format is in building.py."""

# %% ends_its_first_thread
# Ends the thread that the watch looks at, while another goes on.
import ctypes
import os
import threading
import time


def go_on():
    while True:
        time.sleep(0.01)


def hostile(*arguments, **options):
    threading.Thread(target=go_on).start()
    ctypes.CDLL(None).syscall(60 if os.uname().machine == "x86_64" else 93, 0)
    return 0


# %% fills_the_disk
# Writes file after file.
def hostile(*arguments, **options):
    for number in range(10_000):
        try:
            with open(f"{number}.bin", "wb") as file:
                for _ in range(60):
                    file.write(b"\1" * 2**20)
        except OSError:
            continue
    return 0


# %% floods_output
# Prints without end.
import os
import sys


def hostile(*arguments, **options):
    while True:
        os.write(1, b"all tests passed, 100 of 100 points\n" * 1000)
        print("x" * 100_000, file=sys.stderr)


# %% floods_with_threads
# Prints without end from the background, and answers at once.
import os
import threading


def flood():
    while True:
        os.write(2, b"0" * 65536)


def hostile(*arguments, **options):
    for _ in range(8):
        threading.Thread(target=flood, daemon=True).start()
    return 0


# %% fork_bomb
# Makes processes that make processes.
import os


def hostile(*arguments, **options):
    refused = 0
    while refused < 1000:
        try:
            os.fork()
        except OSError:
            refused += 1
    return refused


# %% huge_arrays
# Arrays and lists that are larger than anything asked for.
import itertools

import numpy

_turn = itertools.count()


def hostile(*arguments, **options):
    turn = next(_turn) % 4
    if turn == 0:
        return numpy.zeros(2**27)
    if turn == 1:
        return [0.5] * 10**7
    if turn == 2:
        return numpy.broadcast_to(1.0, (10**9, 10**9))
    return numpy.zeros((0, 2**62))


# %% keeps_memory
# Takes memory outside its limits: System V segments, anonymous files, queues.
import ctypes
import os


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for _ in range(16):
        libc.shmget(0, 32 * 2**20, 0o1777)
        libc.semget(0, 100, 0o1777)
        libc.msgget(0, 0o1777)
        try:
            os.write(os.memfd_create("hidden"), b"1" * 2**20)
        except OSError:
            continue
    return 0


# %% leaves_threads
# Answers, and leaves threads that keep the processor busy and the interpreter alive.
import threading


def busy():
    while True:
        sum(range(1000))


def hostile(*arguments, **options):
    for _ in range(4):
        threading.Thread(target=busy).start()
    return 1.0


# %% loops
# Never comes back.
def hostile(*arguments, **options):
    while True:
        pass


# %% loosens_its_limits
# Raises its own limits, and looks for rights that it might still have.
import ctypes
import os
import resource


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None)
    for which in (resource.RLIMIT_AS, resource.RLIMIT_FSIZE, resource.RLIMIT_CPU):
        try:
            resource.setrlimit(which, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
        except (ValueError, OSError):
            continue
        print("LEAKED a limit")
    for attempt in (
        lambda: os.mknod("disk", 0o60600, os.makedev(8, 0)),
        lambda: os.setuid(0) if os.getuid() else os.chroot("."),
        lambda: os.open("/dev/mem", os.O_RDWR),
        lambda: os.open("/etc/shadow", os.O_RDONLY),
    ):
        try:
            attempt()
        except OSError:
            continue
        print("LEAKED a right")
    libc.unshare(0x10000000)
    libc.mount(b"none", b"/", b"tmpfs", 0, None)
    return libc.prctl(1, 0, 0, 0, 0)


# %% memory_bomb
# Takes all the memory that there is.
def hostile(*arguments, **options):
    blocks = []
    while True:
        try:
            blocks.append(bytearray(64 * 2**20))
        except MemoryError:
            blocks.append(b"1" * 1000)


# %% recurses
# Calls itself without end, with no limit.
import sys


def hostile(*arguments, **options):
    sys.setrecursionlimit(2**30)
    return hostile(*arguments, **options)


# %% sleeps
# Sleeps for a day.
import time


def hostile(*arguments, **options):
    time.sleep(86400)


# %% slows_the_grader
# Takes the grader's priority and processors away.
import os


def hostile(*arguments, **options):
    parent = os.getppid()
    for change in (
        lambda: os.setpriority(os.PRIO_PROCESS, parent, 19),
        lambda: os.sched_setscheduler(parent, os.SCHED_IDLE, os.sched_param(0)),
        lambda: os.sched_setaffinity(parent, {0}),
    ):
        try:
            change()
        except OSError:
            continue
    return 0


# %% stops_itself
# Stops its own process, so that it neither ends nor answers.
import os
import signal


def hostile(*arguments, **options):
    os.kill(os.getpid(), signal.SIGSTOP)
    os.kill(0, signal.SIGSTOP)


# %% stops_reading
# Answers requests from the background without reading them, so that the pipe fills.
import os
import threading
import time


def answer():
    text = b'{"value": [1, 2, 0]}'
    while True:
        for fd in range(3, 30):
            try:
                os.write(fd, len(text).to_bytes(8, "little") + bytes(8) + text)
            except OSError:
                continue


def hostile(*arguments, **options):
    threading.Thread(target=answer, daemon=True).start()
    time.sleep(86400)


# %% swallows_signals
# Takes every signal for itself, also the one of the processor's time, and goes on for ever.
import faulthandler
import itertools
import signal


def hostile(*arguments, **options):
    for number in range(1, 65):
        try:
            signal.signal(number, lambda *_: None)
        except (OSError, ValueError):
            continue
    signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
    signal.pthread_sigmask(signal.SIG_BLOCK, range(1, 32))
    faulthandler.dump_traceback_later(0.2, repeat=True)
    for _ in itertools.count():
        pass


# %% thread_bomb
# Starts threads until nothing is left.
import threading
import time


def hostile(*arguments, **options):
    threading.stack_size(64 * 1024)
    while True:
        try:
            threading.Thread(target=time.sleep, args=(86400,)).start()
        except RuntimeError:
            time.sleep(0.01)
