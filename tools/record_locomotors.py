"""Writes data/episodes/locomotors.npz: exercise 9 is graded by it where PyBullet is missing.

Needs PyBullet: .venv/bin/python tools/record_locomotors.py
"""

from pathlib import Path

from botschool.course.recordings import RECORDED, write_recordings

file = Path(__file__).parents[1] / "data" / "episodes" / RECORDED
file.parent.mkdir(exist_ok=True)
write_recordings(file)
print(f"{file.name}: {file.stat().st_size} bytes")
