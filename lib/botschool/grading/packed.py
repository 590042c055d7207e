"""Graders and answers in the students' copy: packed, so that nobody reads one there by accident.

A grader computes again what a task asks for, and has our solution and its known mistakes: the tasks
that others need are taken from it, and the mistakes are tried where an answer is wrong. This hides
them from readers, not from somebody who is determined to unpack them: what counts is graded
elsewhere.
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
"""In an exercise's folder of the copy, if the instructor allows it."""


def pack(grader: str, solution: str = "", mistakes: str = "") -> str:
    """The text of a Python file that declares the same exercise as this one.

    solution, mistakes: what the exercise knows, packed with it. Its extras stay readable, since
    `make test-exN` must know them before there is a Python.
    """
    all_of_it = json.dumps([grader, solution, mistakes]).encode()
    packed = base64.b85encode(zlib.compress(all_of_it, 9)).decode()
    lines = "\n".join(f'    "{packed[at : at + 90]}"' for at in range(0, len(packed), 90))
    extras = re.search(r"extras=\([^)]*\)", grader)
    needs = f"# Needs {extras[0]}.\n" if extras else ""
    return (
        '"""The grader of this exercise, packed because it computes what you are asked for."""\n\n'
        f"{needs}from botschool.grading.packed import unpack\n\n"
        f"exercise = unpack(\n    __file__,\n{lines},\n)\n"
    )


def is_packed(text: str) -> bool:
    """Whether a Python file has been packed."""
    return "from botschool.grading.packed import " in text


def unpack(file: str, packed: str) -> Any:
    """The exercise that a packed grader declares; `file` is where it lies."""
    source, *known = json.loads(zlib.decompress(base64.b85decode(packed)))
    name = str(Path(file).with_suffix(".unpacked"))
    # so that the source of its drivers can be sent to a child
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    module = types.ModuleType(f"unpacked_{Path(file).stem}")
    module.__file__ = file
    sys.modules[module.__name__] = module  # dataclasses look their module up
    exec(compile(source, name, "exec", dont_inherit=True), vars(module))
    module.exercise.knows(*known)
    return module.exercise


def pack_module(text: str) -> str:
    """The text of a Python file with the same names in it as this one."""
    lines = "\n".join(f'    "{line}"' for line in pack_answers(text).split())
    return (
        '"""A part of the check, packed because it computes what you are asked for."""\n\n'
        "from botschool.grading.packed import restore\n\n"
        f"restore(\n    globals(),\n{lines},\n)\n"
    )


def restore(names: dict[str, Any], packed: str) -> None:
    """Define what `pack_module` has packed."""
    exec(compile(unpack_answers(packed), names["__file__"], "exec", dont_inherit=True), names)


def pack_answers(text: str) -> str:
    """The text so that nobody reads it by accident."""
    packed = base64.b85encode(zlib.compress(text.encode(), 9)).decode()
    return "\n".join(packed[at : at + 90] for at in range(0, len(packed), 90)) + "\n"


def unpack_answers(packed: str) -> str:
    """The text again. Raises ValueError or zlib.error."""
    return zlib.decompress(base64.b85decode("".join(packed.split()))).decode()
