"""Let a submission import PyBullet where it is not installed: it gets what stands in for it."""

from __future__ import annotations

import sys
from importlib.util import find_spec

NAMES = ("pybullet", "pybullet_data")

if not all(map(find_spec, NAMES)):
    from botschool.course import stand_in

    sys.modules |= dict.fromkeys(NAMES, stand_in)
