"""The hopper of `make demo` (docs/images/demo_hopper.png): frames of its film, and its curve."""

import subprocess

from PIL import Image
from style import ROOT, above, beside, frames, write


def draw() -> None:
    folder = ROOT / "results" / "demo"
    if not (folder / "hopper.mp4").is_file():
        subprocess.run(["make", "demo"], cwd=ROOT, check=True)
    shares = [0.02 + 0.012 * i for i in range(6)]
    film = frames(folder / "hopper.mp4", shares, 900, (0.28, 0.08, 0.72, 1))
    curve = beside([Image.open(folder / "hopper.png").convert("RGB")], 900)
    write(above(film, curve), "../demo_hopper")
