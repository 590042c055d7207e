"""The hopper of `make demo` (docs/images/demo_hopper.png): frames of its film, and its curve."""

import subprocess

from PIL import Image
from style import ROOT, above, beside, frames, write


def draw() -> None:
    folder = ROOT / "results" / "demo"
    if not (folder / "hopper.mp4").is_file():
        subprocess.run(["make", "demo"], cwd=ROOT, check=True)
    shares = [0.3 + 0.012 * i for i in range(7)]
    film = frames(folder / "hopper.mp4", shares, 900, (0.3, 0.06, 0.7, 0.93))
    curve = beside([Image.open(folder / "hopper.png").convert("RGB")], 660)
    page = Image.new("RGB", (900, curve.height), "white")
    page.paste(curve, (120, 0))
    write(above(film, page), "../demo_hopper")
