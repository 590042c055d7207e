"""The sandbox imports nothing of botschool but itself."""

import ast
import subprocess
import sys
from pathlib import Path

import botschool.sandbox

FILES = sorted(Path(botschool.sandbox.__file__).parent.glob("*.py"))


def imported(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"{file.name}: a relative import"
            yield node.module


def test_no_file_names_another_part_of_botschool():
    assert len(FILES) >= 8
    for file in FILES:
        for name in imported(file):
            own = name == "botschool.sandbox" or name.startswith("botschool.sandbox.")
            assert own or name.split(".")[0] != "botschool", f"{file.name} imports {name}"


def test_nothing_else_of_botschool_is_loaded():
    modules = ", ".join(f"botschool.sandbox.{file.stem}" for file in FILES)
    loaded = subprocess.run(
        [sys.executable, "-c", f"import sys, {modules}\nprint(*sys.modules)"],
        capture_output=True, text=True, check=True,
    ).stdout.split()  # fmt: skip
    others = {name for name in loaded if name.startswith("botschool.")}
    alone = {name for name in others if not name.startswith("botschool.sandbox")}
    assert alone == {"botschool.moved"}  # botschool/__init__.py itself
