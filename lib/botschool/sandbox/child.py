"""Run the confined process: server.py forks it, and it answers the requests of process.py.

The untrusted code runs in this very process, so the caller must not trust any answer.
"""

from __future__ import annotations

import faulthandler
import functools
import importlib.util
import os
import signal
import sys
import tempfile
import threading
import types
from pathlib import Path
from typing import Any

import numpy

from botschool.sandbox import confine, protocol
from botschool.sandbox.exceptions import Missing, explain
from botschool.sandbox.parts import run_parts

WAIT = 24 * 3600
"""Seconds to wait for the next request; the caller kills this process long before."""


def load(path: Path, in_parts: bool = False) -> Any:
    """Import the untrusted file as a module named `student`; it may import files beside it.

    in_parts: a statement that fails costs only what uses its names.
    """
    sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location("student", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["student"] = module
    if in_parts:
        run_parts(path.read_text(encoding="utf-8"), str(path), vars(module))
    else:
        spec.loader.exec_module(module)
    return module


class Pipes:
    """The pipes to and from the caller."""

    def __init__(self, requests: int, answers: int) -> None:
        self._requests, self._answers = requests, answers
        self._asking = threading.Lock()

    def receive(self) -> bytes | None:
        """Return the next packed request; None if the caller has ended."""
        return protocol.receive(self._requests, WAIT)

    def send(self, answer: bytes) -> None:
        """Write a packed answer."""
        while answer:
            answer = answer[os.write(self._answers, answer) :]

    def ask(self, question: Any) -> Any:
        """Ask the caller, who is waiting for an answer, and return what it says."""
        message = protocol.pack({"asks": question})
        with self._asking:  # one thread after another
            self.send(message)
            return protocol.unpack(self.receive() or b"")


def called(driver: str, name: str, *arguments: Any) -> Any:
    """Call a function that was sent as source."""
    names: dict[str, Any] = {}
    exec(_compiled(driver), names)
    return names[name](*arguments)


@functools.cache
def _compiled(driver: str) -> types.CodeType:
    return compile(driver, "<driver>", "exec")


def run(module: Any, request: dict[str, Any], pipes: Pipes | None = None) -> Any:
    """Call a function of the untrusted module, or a driver with it; return the result.

    request: {"name", "arguments", "options"}, or {"driver": source, "name", "arguments"}. With
    "asks", the driver's second argument is a function that asks the caller through the pipes.
    """
    if "driver" in request:
        given = [module, pipes.ask] if pipes and request.get("asks") else [module]
        return called(request["driver"], request["name"], *given, *request["arguments"])
    function = getattr(module, request["name"], None)
    if function is None:
        raise Missing(request["name"], module)
    return function(*request["arguments"], **request["options"])


def run_twice(module: Any, message: bytes, pipes: Pipes) -> dict[str, Any]:
    """Return the answers to two copies of a request, and the first copy's final arguments."""
    first, second = protocol.unpack(message), protocol.unpack(message)
    answers = [run(module, first, pipes)]
    return {"answers": [*answers, run(module, second, pipes)], "arguments": first["arguments"]}


def changed_arguments(request: dict[str, Any], message: bytes) -> list[int]:
    """Return the numbers, from 1, of the arguments that a function has changed.

    request: as the call left it; message: the packed request before the call.
    """
    before, after = protocol.unpack(message), request
    pairs = zip(
        [*before["arguments"], *before["options"].values()],
        [*after["arguments"], *after["options"].values()],
        strict=True,
    )
    return [i for i, (old, new) in enumerate(pairs, 1) if _differ(old, new)]


def _differ(old: Any, new: Any) -> bool:
    if not isinstance(old, (list, dict, numpy.ndarray)):
        return False
    try:
        return protocol.pack(old) != protocol.pack(new)
    except protocol.NotPlain:
        return True


def substitute(module: Any, references: dict[str, Any]) -> None:
    """Replace functions of the untrusted module by others, and methods of its classes.

    references: {"source": text of a file, "names": of its functions, "Class.method" for a method}.
    """
    other: dict[str, Any] = {"__name__": "references"}
    exec(compile(references["source"], "<references>", "exec"), other)
    for name in references["names"]:
        owner, _, method = name.rpartition(".")
        if not owner:
            setattr(module, name, other[name])
        elif isinstance(kind := getattr(module, owner, None), type):
            setattr(kind, method, _method_of(kind, vars(other[owner])[method]))


def _method_of(kind: type, function: Any) -> Any:
    """Return a method of another class for this one: super() must mean its parent."""
    cells = zip(function.__code__.co_freevars, function.__closure__ or (), strict=True)
    closure = [types.CellType(kind) if name == "__class__" else cell for name, cell in cells]
    method = types.FunctionType(
        function.__code__, function.__globals__, function.__name__, function.__defaults__,
        tuple(closure) or None,
    )  # fmt: skip
    method.__kwdefaults__ = function.__kwdefaults__
    return method


def answer_to(module: Any, message: bytes, file: Path, pipes: Pipes) -> bytes:
    """Return the packed answer to a packed request; any exception becomes an answer, too."""
    try:
        request = protocol.unpack(message)
        if request.get("twice"):
            return protocol.pack({"value": run_twice(module, message, pipes)})
        answer = {"value": run(module, request, pipes)}
        if "driver" not in request:
            answer["changed"] = changed_arguments(request, message)
        return protocol.pack(answer)
    except protocol.NotPlain as error:
        return protocol.pack({"error": "NotPlain", "text": str(error), "line": None})
    except BaseException as error:
        return _explained(error, file, module)


def _explained(error: BaseException, file: Path, module: Any = None, **more: bool) -> bytes:
    try:
        return protocol.pack(explain(error, file, module) | more)
    except BaseException:
        return protocol.pack({"error": "an exception", "text": "", "line": None} | more)


def serve(requests: int, answers: int) -> None:
    """Confine this process as the first request says, then answer requests until killed.

    requests, answers: file descriptors of pipes.
    """
    pipes = Pipes(requests, answers)
    set_up = protocol.unpack(pipes.receive())
    file = Path(set_up["file"])
    os.environ.update(set_up["environment"])
    tempfile.tempdir = None
    numpy.random.seed()  # noqa: NPY002 (or all children, being copies, would draw alike)
    if "torch" in sys.modules:
        sys.modules["torch"].seed()
    confine.limit(set_up["seconds"], set_up["memory"], set_up["file_size"])
    # nothing untrusted has run yet
    prepared = called(*set_up["prepare"]) if set_up["prepare"] else None
    references, in_parts = set_up["references"], set_up["in_parts"]
    places = ("readable", "listed", "writable")
    missing = confine.confine(*([Path(path) for path in set_up[each]] for each in places))
    del set_up
    pipes.send(protocol.pack({"missing": missing}))
    # on this signal, Python writes where the program is, for Child.where
    faulthandler.register(signal.SIGUSR1, answers, all_threads=True)
    module = failure = None
    while (message := pipes.receive()) is not None:
        if module is None and failure is None:
            try:
                module = load(file, in_parts)
                if references:
                    substitute(module, references)
                if prepared is not None:
                    prepared()
            except BaseException as error:
                failure = _explained(error, file, loading=True)
        answer = failure or answer_to(module, message, file, pipes)
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except BaseException:  # the untrusted code has closed or replaced the stream
                continue
        pipes.send(answer)
