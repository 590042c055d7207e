"""Print the digest of the C++ sources of the cores of pages, which `make web` compiles."""

import hashlib
from pathlib import Path

LIB = Path(__file__).parents[1] / "lib"
FOLDERS = ("arena", "evolution", "evonet", "policy_gradient", "web")


def digest() -> str:
    """Return the digest of all names and contents."""
    files = sorted(path for folder in FOLDERS for path in (LIB / folder).rglob("*.[ch]pp"))
    found = hashlib.sha256()
    for path in files:
        found.update(path.relative_to(LIB).as_posix().encode() + b"\0" + path.read_bytes())
    return found.hexdigest()


if __name__ == "__main__":
    print(digest())
