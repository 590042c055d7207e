"""Put the course into a wheel that is being built: tools/material.py FOLDER-OF-THE-PACKAGE.

Like a students' copy it holds no plain solutions and no plain graders.
"""

import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "lib"))


def main(package: Path) -> None:
    from botschool.grading.copies.release import pack_measures, release
    from botschool.paths import MATERIAL

    release(ROOT, package / MATERIAL, compiled=False, trusted=False, pages=False)
    pack_measures(ROOT / "lib" / "botschool", package)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
