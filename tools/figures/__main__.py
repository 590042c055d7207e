"""Draws the figures of the exercises' texts: `make figures`, or `make figures ONLY="3 5"`."""

import importlib
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
os.environ.setdefault("BOTSCHOOL_COURSE", str(Path(__file__).parents[2]))

for number in map(int, sys.argv[1:] or range(1, 16)):
    importlib.import_module(f"ex{number:02d}").draw()
