"""Forgets the packages of this environment that are not whole, and prints them, as NAME==VERSION.

An installation that was interrupted leaves packages of which files are missing or cut short. Their
lists of files are removed, so that pip can install them again; all others stay as they are.
"""

import csv
import shutil
from importlib.metadata import distributions
from pathlib import Path


def whole(info: Path) -> bool:
    """Tell whether all files that a package's RECORD names are there, with their sizes."""
    try:
        rows = list(csv.reader((info / "RECORD").open(encoding="utf-8")))
        sizes = [(info.parent / name, size) for name, _, size in rows if size]
        return bool(sizes) and all(path.stat().st_size == int(size) for path, size in sizes)
    except (OSError, ValueError):
        return False


for folder in {Path(each.locate_file("")) for each in distributions()}:
    for info in folder.glob("*.dist-info"):
        # what is installed in place (direct_url.json) changes, and its step installs it anew
        if not (info / "direct_url.json").exists() and not whole(info):
            shutil.rmtree(info)
            print("==".join(info.stem.rsplit("-", 1)))
