"""Pack the graders and answers of the students' copy, so that nobody reads one by accident.

A grader computes what a task asks for, and holds our solution and its known mistakes. It takes the
tasks that others need from the solution, and tries the mistakes on a wrong answer. Packing does not
stop somebody who is determined to unpack: points that count are graded elsewhere.
"""

from __future__ import annotations

import base64
import json
import linecache
import re
import sys
import types
import zlib
from pathlib import Path
from typing import Any

PACKED = "ANSWERS.packed"
"""A file in an exercise's folder of the copy, if the instructor allows it."""


def pack(grader: str, solution: str = "", mistakes: str = "") -> str:
    """Return the text of a Python file that declares the same exercise as a grader file.

    solution, mistakes: what the exercise knows, packed with it. The extras stay readable, because
    `make test-exN` reads them before there is a Python.
    """
    all_of_it = json.dumps([grader, solution, mistakes]).encode()
    packed = base64.b85encode(zlib.compress(all_of_it, 9)).decode()
    lines = "\n".join(f'    "{packed[at : at + 90]}"' for at in range(0, len(packed), 90))
    extras = re.search(r"extras=\([^)]*\)", grader)
    needs = f"# Needs {extras[0]}.\n" if extras else ""
    return (
        '"""The grader of this exercise, packed because it contains the answers."""\n\n'
        f"{needs}from botschool.grading.packed import unpack\n\n"
        f"exercise = unpack(\n    __file__,\n{lines},\n)\n"
    )


def is_packed(text: str) -> bool:
    """Return whether a Python file is packed."""
    return "from botschool.grading.packed import " in text


def unpack(file: str, packed: str) -> Any:
    """Return the exercise that a packed grader declares; file: the grader's path."""
    source, solution, mistakes = json.loads(zlib.decompress(base64.b85decode(packed)))
    name = str(Path(file).with_suffix(".unpacked"))
    # so that a child can be sent the source of its drivers
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    module = types.ModuleType(f"unpacked_{Path(file).stem}")
    module.__file__ = file
    sys.modules[module.__name__] = module  # dataclasses look up their module
    exec(compile(source, name, "exec", dont_inherit=True), vars(module))
    module.exercise.grader = module
    module.exercise.knows(solution, mistakes)
    return module.exercise


def pack_module(text: str) -> str:
    """Return the text of a packed Python file that defines the same names as this one."""
    lines = "\n".join(f'    "{line}"' for line in pack_answers(text).split())
    return (
        '"""A part of the check, packed because it contains the answers."""\n\n'
        "from botschool.grading.packed import restore\n\n"
        f"restore(\n    globals(),\n{lines},\n)\n"
    )


def restore(names: dict[str, Any], packed: str) -> None:
    """Define the names of a packed module."""
    exec(compile(unpack_answers(packed), names["__file__"], "exec", dont_inherit=True), names)


def pack_answers(text: str) -> str:
    """Return the text in a packed form, so that nobody reads it by accident."""
    packed = base64.b85encode(zlib.compress(text.encode(), 9)).decode()
    return "\n".join(packed[at : at + 90] for at in range(0, len(packed), 90)) + "\n"


def unpack_answers(packed: str) -> str:
    """Return the text of a packed answer. Raises ValueError or zlib.error."""
    return zlib.decompress(base64.b85decode("".join(packed.split()))).decode()
