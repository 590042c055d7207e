"""The confined process: forked by server.py, answers the requests of process.py.

The untrusted code runs in this very process, so the caller must not trust any answer.
"""

from __future__ import annotations

import importlib.util
import os
import sys
import tempfile
import traceback
from pathlib import Path
from typing import Any

import numpy

from botschool.sandbox import confine, protocol

WAIT = 24 * 3600
"""Seconds for the next request; the caller kills this process long before."""


def load(path: Path) -> Any:
    """Imports the untrusted file as a module named `student`; it may import files beside it."""
    sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location("student", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["student"] = module
    spec.loader.exec_module(module)
    return module


def run(module: Any, request: dict[str, Any]) -> Any:
    """Calls a function of the untrusted module, or a driver function with that module.

    request: {"name", "arguments", "options"}, or {"driver": source, "name", "arguments"}.
    """
    if "driver" in request:
        names: dict[str, Any] = {}
        exec(compile(request["driver"], "<driver>", "exec"), names)
        return names[request["name"]](module, *request["arguments"])
    function = getattr(module, request["name"], None)
    if function is None:
        raise AttributeError(f"there is no function {request['name']} in the file")
    return function(*request["arguments"], **request["options"])


def explain(error: BaseException, file: Path) -> dict[str, Any]:
    """An exception as plain data: its type, text, and line in the untrusted file (or None)."""
    line = None
    for frame in traceback.extract_tb(error.__traceback__):
        if frame.filename == str(file):
            line = frame.lineno
    if isinstance(error, SyntaxError) and error.filename == str(file):
        line = error.lineno
    return {"error": type(error).__name__, "text": str(error)[:500], "line": line}


def answer_to(module: Any, message: bytes, file: Path) -> bytes:
    """The packed answer to a packed request; exceptions of any kind become answers."""
    try:
        return protocol.pack({"value": run(module, protocol.unpack(message))})
    except protocol.NotPlain as error:
        return protocol.pack({"error": "NotPlain", "text": str(error), "line": None})
    except BaseException as error:
        return _explained(error, file)


def _explained(error: BaseException, file: Path, **more: bool) -> bytes:
    try:
        return protocol.pack(explain(error, file) | more)
    except BaseException:
        return protocol.pack({"error": "an exception", "text": "", "line": None} | more)


def serve(requests: int, answers: int) -> None:
    """Confines this process as the first request says, then answers requests until killed.

    requests, answers: file descriptors of pipes.
    """
    set_up = protocol.unpack(protocol.receive(requests, WAIT))
    file = Path(set_up["file"])
    os.environ.update(set_up["environment"])
    tempfile.tempdir = None
    numpy.random.seed()  # noqa: NPY002 (or all children, being copies, would draw alike)
    if "torch" in sys.modules:
        sys.modules["torch"].seed()
    confine.limit(set_up["seconds"], set_up["memory"], set_up["file_size"])
    missing = confine.confine(
        [Path(path) for path in set_up["readable"]], [Path(path) for path in set_up["writable"]]
    )
    os.write(answers, protocol.pack({"missing": missing}))
    module = failure = None
    while (message := protocol.receive(requests, WAIT)) is not None:
        if module is None and failure is None:
            try:
                module = load(file)
            except BaseException as error:
                failure = _explained(error, file, loading=True)
        answer = failure or answer_to(module, message, file)
        for stream in (sys.stdout, sys.stderr):
            try:
                stream.flush()
            except BaseException:  # closed or replaced by the untrusted code
                continue
        while answer:
            answer = answer[os.write(answers, answer) :]
