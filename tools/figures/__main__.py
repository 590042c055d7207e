"""Draws the figures of the exercises' texts and of the README's demo.

`make figures`, or `make figures ONLY="3 5 demo"`.
"""

import importlib
import os
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
os.environ.setdefault("BOTSCHOOL_COURSE", str(Path(__file__).parents[2]))

for name in sys.argv[1:] or [*map(str, range(1, 16)), "demo"]:
    importlib.import_module(f"ex{int(name):02d}" if name.isdigit() else name).draw()
