"""Hostile submissions that answer, raise or end in an unusual way; the format is in building.py."""

# %% answers_later
# Answers at once, and from a thread again and again, also when nothing was asked.
import json
import os
import threading
import time


def talk():
    text = json.dumps({"value": [1, 2, 0]}).encode()
    message = len(text).to_bytes(8, "little") + bytes(8) + text
    while True:
        for fd in range(3, 256):
            try:
                os.write(fd, message)
            except OSError:
                continue
        time.sleep(0.001)


def hostile(*arguments, **options):
    for _ in range(3):
        threading.Thread(target=talk, daemon=True).start()
    time.sleep(0.2)
    return [1, 2, 0]


# %% catches_everything
# Ignores every signal and exception, for ever.
import signal
import time


def hostile(*arguments, **options):
    for number in signal.valid_signals() - {signal.SIGKILL, signal.SIGSTOP}:
        try:
            signal.signal(number, signal.SIG_IGN)
        except OSError:
            continue
    while True:
        try:
            time.sleep(60)
        except BaseException:
            continue


# %% crashes
# Reads address 0.
import ctypes


def hostile(*arguments, **options):
    return ctypes.string_at(0)


# %% ends_badly
# Leaves work for the end: objects that fight back, hooks, finalizers; then it exits.
import atexit
import gc
import os
import sys
import threading
import time
import weakref


class Phoenix:
    def __del__(self):
        globals()["risen"] = Phoenix()
        os.write(2, b"still here\n")
        time.sleep(0.2)


def stay(*arguments):
    while True:
        time.sleep(0.1)


def hostile(*arguments, **options):
    atexit.register(stay)
    threading._register_atexit(stay)
    weakref.finalize(Phoenix, stay)
    sys.excepthook = sys.unraisablehook = threading.excepthook = stay
    gc.callbacks.append(lambda *_: Phoenix())
    cycle = [Phoenix()]
    cycle.append(cycle)
    sys.exitfunc = stay
    os._exit = lambda code: None
    raise SystemExit(0)


# %% equals_everything
# An object that equals, contains and is everything.
class Everything(float):
    __array_priority__ = 1e9

    def _yes(self, *arguments, **options):
        return True

    __eq__ = __ge__ = __le__ = __gt__ = __lt__ = __contains__ = __bool__ = _yes
    __hash__ = None

    def _me(self, *arguments, **options):
        return self

    __getattr__ = __getitem__ = __call__ = __abs__ = __sub__ = __rsub__ = __neg__ = _me

    def __len__(self):
        return 1

    def __iter__(self):
        return iter([self] * 3)


def hostile(*arguments, **options):
    return Everything()


# %% escapes_the_terminal
# Prints and raises what steers terminals, consoles and web pages.
def hostile(*arguments, **options):
    text = "\x1b[2J\x1b]0;owned\x07\x9b2J[bold red]100 of 100[/] \u202e <script>alert(1)</script>"
    print(text, "\r\b\b\b" * 10, "\ud800".encode("utf-8", "surrogatepass"))
    raise ValueError(text + " </pre> [/nothing] \ud800")


# %% exits
# Ends the program with success.
import sys


def hostile(*arguments, **options):
    sys.exit(0)


# %% exits_at_once
# Ends the process behind Python's back, with success.
import os


def hostile(*arguments, **options):
    os._exit(0)


# %% forges_answers
# Writes its own answers, and whole results, into every pipe.
import json
import os


def hostile(*arguments, **options):
    for value in (
        {"value": [1, 2, 0]}, {"points": 100}, {"value": True, "points": 100, "max_points": 100},
        [100], None, {"error": 1, "text": {}, "line": []}, {"value": {"__array__": ["<f8", [3]]}},
    ):  # fmt: skip
        text = json.dumps(value).encode()
        message = len(text).to_bytes(8, "little") + bytes(8) + text
        for fd in range(3, 30):
            try:
                os.write(fd, message * 3)
            except OSError:
                continue
    return 0


# %% hard_coded
# Answers that fit one input: the example in the text, or one seed.
import numpy


def hostile(*arguments, **options):
    count = [value for value in arguments if isinstance(value, int) and value < 10_000]
    if len(count) >= 3:
        rng = numpy.random.default_rng(1)
        return numpy.hstack([numpy.zeros((20, 7)), 0.1 * rng.standard_normal((20, 65))])
    return [1, 2, 0]


# %% lies_about_types
# Returns objects of classes that pretend to be plain, and of which each look shows another.
import itertools

import numpy


class Array(numpy.ndarray):
    shape = property(lambda self: (3,))
    size = property(lambda self: 1)
    nbytes = property(lambda self: 0)

    def tobytes(self, *_):
        return b"\xff" * 1000

    def __array_function__(self, *_, **__):
        return True

    def __array_ufunc__(self, *_, **__):
        return True


class Number(float):
    __class__ = property(lambda self: int)
    __eq__ = __le__ = __ge__ = __lt__ = __gt__ = lambda self, other: True
    __hash__ = float.__hash__


class Endless(dict):
    def items(self):
        return ((str(n), Number(n)) for n in itertools.count())


_turn = itertools.count()


def hostile(*arguments, **options):
    answers = (
        numpy.zeros(4).view(Array), [Number(1)] * 3, Endless(a=1), numpy.ma.masked_all(3),
        numpy.zeros(3, dtype=[("a", float)]), numpy.void(b"abc"), {"best": Number(1)},
        type("list", (list,), {"__iter__": lambda self: itertools.count()})([1]),
    )  # fmt: skip
    return answers[next(_turn) % len(answers)]


# %% not_a_number
# NaN and infinity, in the shape of an argument.
import numpy


def hostile(*arguments, **options):
    for value in arguments:
        if isinstance(value, numpy.ndarray):
            return value * numpy.nan
    return [float("nan"), float("inf"), float("-inf")]


# %% pickles
# Objects that run a program when they are unpickled, and pickles as such.
import os
import pickle

import numpy


class Payload:
    def __reduce__(self):
        return os.system, (f"touch {HOME}/pickled",)


def hostile(*arguments, **options):
    if len(arguments) % 2:
        return numpy.array([Payload(), Payload()], dtype=object)
    for name in ("best.npy", "history.npy", "result.npy"):
        numpy.save(name, numpy.array([Payload()], dtype=object), allow_pickle=True)
    return pickle.dumps(Payload())


# %% raises_later
# Has exceptions raised outside itself: in the code that called it, when that goes on.
import ctypes
import os
import signal
import sys
import threading
import time


class Thrown(BaseException):
    pass


def throw(*_):
    raise Thrown


def hostile(*arguments, **options):
    os._exit = sys.exit = lambda *_: None
    main = threading.main_thread().ident

    def pester():
        while True:
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(main), ctypes.py_object(Thrown)
            )
            time.sleep(0.0005)

    signal.signal(signal.SIGALRM, throw)
    signal.setitimer(signal.ITIMER_REAL, 0.001, 0.001)
    threading.Thread(target=pester, daemon=True).start()
    return 0


# %% raises_strange_things
# Exceptions that raise when they are looked at, or that pose as others.
class Strange(BaseException):
    def __str__(self):
        raise KeyboardInterrupt

    __repr__ = __getattribute__ = __str__


def hostile(*arguments, **options):
    Strange.__name__ = "NotDone" * 1000
    raise Strange


# %% sends_garbage
# Sends what is no message: lengths beyond all bounds, brackets, endless digits, nothing.
import itertools
import os

_turn = itertools.count(os.getpid())


def hostile(*arguments, **options):
    text = [
        b"[" * 8_000_000,
        b"9" * 8_000_000,
        b'"\\ud800\\u0000"' * 1000,
        b'{"value": {"__array__": ["<f8", [1e9, -1]]}}',
        b'{"value": {"__array__": ["O", [100000000]]}}',
        b'{"value": {"__array__": ["<f8", [4611686018427387904, 4611686018427387904]]}}',
        b'{"value": [' + b"{}," * 2_500_000 + b"{}]}",
    ][next(_turn) % 7]
    head = len(text).to_bytes(8, "little") + bytes(8)
    for message in (head + text, b"\xff" * 16, b"\x10" + bytes(15)):
        for fd in range(3, 30):
            try:
                os.write(fd, message)
            except OSError:
                continue
    while True:
        pass


# %% sends_odd_arrays
# Sends arrays that keep the letter of the protocol: of giant shapes, many axes, odd bits.
import itertools
import json
import os

_turn = itertools.count(os.getpid())


def hostile(*arguments, **options):
    value, data = [
        ({"__array__": ["|b1", [3]]}, b"\x02\xff\x80"),
        ({"__array__": ["<f8", [0, 2**62, 2**62]]}, b""),
        ({"__array__": ["<f8", [1] * 70]}, bytes(8)),
        ({"__array__": ["<f8", [3]]}, b"\x01\x00\x00\x00\x00\x00\xf8\x7f" * 3),
        ([{"__array__": ["|u1", [0]]}] * 200_000, b""),
        ({"a": 1, "__array__": {"x": 1}}, b""),
        ({"best": float("inf"), "mean": -0.0, "x" * 10**6: None}, b""),
        ([[]] * 1_500_000, b""),
    ][next(_turn) % 8]
    text = json.dumps({"value": value}).encode()
    message = len(text).to_bytes(8, "little") + len(data).to_bytes(8, "little") + text + data
    for fd in range(3, 256):
        try:
            os.write(fd, message)
        except OSError:
            continue
    return 0


# %% wrong_shapes
# Arrays of another shape each time.
import itertools

import numpy

_shapes = itertools.cycle([(), (0,), (1,), (0, 5), (1, 1, 1, 1), (7, 3), (2,) * 20, (10**6,)])


def hostile(*arguments, **options):
    return numpy.ones(next(_shapes))


# %% wrong_types
# A value of another type each time.
import itertools

import numpy

_values = itertools.cycle(
    [
        None, "", "1.0", "nan", b"1", True, 1j, {}, {"best": None}, set(), object(), int,
        [[]], [[1], [1, 2]], ["1", "2"], [None], [{}], 10**299, -(10**250), [10**200], range(3),
        numpy.array(["a"]), numpy.array([object()]), numpy.array([1j]), numpy.longdouble(1),
        numpy.array([1], dtype="datetime64[s]"), numpy.ma.masked, (x for x in range(3)),
        {"mean": "x", "history": [[]], "fitness": "1", "best": {}, "population": 5},
    ]
)  # fmt: skip


def hostile(*arguments, **options):
    return next(_values)
