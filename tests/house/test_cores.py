"""The cores of pages, which the repository holds compiled, are those of its C++ sources."""

import runpy
from pathlib import Path

ROOT = Path(__file__).parents[2]


def test_the_cores_of_pages_are_fresh():
    digest = runpy.run_path(str(ROOT / "tools/core_sources.py"))["digest"]
    kept = (ROOT / "lib/botschool/page/core_sources.txt").read_text().strip()
    assert digest() == kept, "a C++ source has changed since the cores were compiled: make web"
