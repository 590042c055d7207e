"""Graders in the students' copy: packed, so that nobody reads an answer there by accident.

A grader computes again what a task asks for, and so tells how it is done. This hides it from
readers, not from somebody who is determined to unpack it: what counts is graded elsewhere.
"""

from __future__ import annotations

import base64
import linecache
import zlib
from pathlib import Path
from typing import Any


def pack(grader: str) -> str:
    """The text of a Python file that declares the same exercise as this one."""
    packed = base64.b85encode(zlib.compress(grader.encode(), 9)).decode()
    lines = "\n".join(f'    "{packed[at : at + 90]}"' for at in range(0, len(packed), 90))
    return (
        '"""The grader of this exercise, packed because it computes what you are asked for."""\n\n'
        "from botschool.grading.packed import unpack\n\n"
        f"exercise = unpack(\n    __file__,\n{lines},\n)\n"
    )


def unpack(file: str, packed: str) -> Any:
    """The exercise that a packed grader declares; `file` is where it lies."""
    source = zlib.decompress(base64.b85decode(packed)).decode()
    name = str(Path(file).with_suffix(".unpacked"))
    # so that the source of its drivers can be sent to a child
    linecache.cache[name] = (len(source), None, source.splitlines(keepends=True), name)
    names: dict[str, Any] = {"__name__": Path(file).stem, "__file__": file}
    exec(compile(source, name, "exec"), names)
    return names["exercise"]
