"""Write data/episodes/locomotors.npz: exercise 9 is graded by it where PyBullet is missing.

python tools/studies record_locomotors    needs PyBullet
"""

from pathlib import Path

from botschool.course.recordings import RECORDED, write_recordings


def main() -> None:
    file = Path(__file__).parents[2] / "data" / "episodes" / RECORDED
    file.parent.mkdir(exist_ok=True)
    write_recordings(file)
    print(f"{file.name}: {file.stat().st_size} bytes")
