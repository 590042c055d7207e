"""Runs leave the files that they always left, bit for bit: hashes of tests/golden.json."""

import json
import platform
import sys

import pytest

from golden import RUNS, hashes, write
from running import TESTS

GOLDEN = json.loads((TESTS / "golden.json").read_text(encoding="utf-8"))


# numpy draws normal numbers, and Gymnasium moves its car, with functions of the system's C library
@pytest.mark.skipif(
    not (sys.platform == "linux" and platform.machine() == "x86_64"),
    reason="hashes are those of Linux on x86-64",
)
@pytest.mark.parametrize("name", RUNS)
def test_files_are_as_ever(name, command, tmp_path):
    path, arguments = write(name, tmp_path)
    code, _, errors = command("es", "-f", path, *arguments, "-o", tmp_path / "results")
    assert code == 0, errors
    assert hashes(tmp_path / "results") == GOLDEN[name]
