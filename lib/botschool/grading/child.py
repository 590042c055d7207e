"""The process that a submission runs in. Comes from nursery.py; answers process.py's requests.

Nothing here is trusted by the grader: whatever comes out of this process may have been made up by
the submission.
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

from botschool.grading import protocol, sandbox

WAIT = 24 * 3600
"""Seconds for the next request; the grader kills this process long before."""


def load(path: Path) -> Any:
    """Imports a submission's file as a module named `student`; it may import files beside it."""
    sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location("student", path)
    module = importlib.util.module_from_spec(spec)
    sys.modules["student"] = module
    spec.loader.exec_module(module)
    return module


def run(module: Any, request: dict[str, Any]) -> Any:
    """A call of a function of the submission, or of a driver with the submission at hand."""
    if "driver" in request:
        names: dict[str, Any] = {}
        exec(compile(request["driver"], "<driver>", "exec"), names)
        return names[request["name"]](module, *request["arguments"])
    function = getattr(module, request["name"], None)
    if function is None:
        raise AttributeError(f"there is no function {request['name']} in the file")
    return function(*request["arguments"], **request["options"])


def explain(error: BaseException, file: Path) -> dict[str, Any]:
    """What went wrong, and where in the student's file."""
    line = None
    for frame in traceback.extract_tb(error.__traceback__):
        if frame.filename == str(file):
            line = frame.lineno
    if isinstance(error, SyntaxError) and error.filename == str(file):
        line = error.lineno
    return {"error": type(error).__name__, "text": str(error)[:500], "line": line}


def answer_to(module: Any, message: bytes, file: Path) -> bytes:
    """What to send back for a request; the submission's exceptions end here, of any kind."""
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
    """Shuts this process in as the first request says, then answers requests until killed.

    requests, answers: the pipes that requests come from and answers go to.
    """
    set_up = protocol.unpack(protocol.receive(requests, WAIT))
    file = Path(set_up["file"])
    os.environ.update(set_up["environment"])
    tempfile.tempdir = None
    numpy.random.seed()  # noqa: NPY002 (or all children, being copies, would draw alike)
    if "torch" in sys.modules:
        sys.modules["torch"].seed()
    sandbox.limit(set_up["seconds"], set_up["memory"], set_up["file_size"])
    missing = sandbox.shut_in(
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
            except BaseException:  # closed or replaced by the submission
                continue
        while answer:
            answer = answer[os.write(answers, answer) :]
