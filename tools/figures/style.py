"""What the figures of the exercises' texts have in common: colours, sizes, files."""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path

import imageio.v3 as imageio
import matplotlib
import numpy as np
from matplotlib.figure import Figure
from PIL import Image

matplotlib.use("Agg")
matplotlib.rcParams.update({"font.size": 11, "axes.titlesize": 12})

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "docs" / "images" / "course"
BLUE, ORANGE, GREEN, RED, GREY = "#0072b2", "#d55e00", "#009e73", "#c1272d", "#8a8a8a"
PALE = "#e8eef4"
DPI = 100
MAX_BYTES = 60_000


def new(width: float, height: float, rows: int = 1, columns: int = 1, **options):
    """A figure of so many hundred pixels, and its axes (an array if there are several)."""
    figure = Figure(figsize=(width, height), layout="constrained")
    return figure, figure.subplots(rows, columns, **options)


def plain(*axes) -> None:
    """Axes without a frame on top and on the right."""
    for one in axes:
        one.spines[["top", "right"]].set_visible(False)


def sketch(axes, width: float, height: float) -> None:
    """Axes to draw on: no frame, equal units, from 0."""
    axes.set(xlim=(0, width), ylim=(0, height), aspect="equal")
    axes.axis("off")


def arrow(axes, start, end, colour: str = "black", width: float = 1.6, bend: float = 0.0) -> None:
    axes.annotate(
        "", end, start,
        arrowprops={"arrowstyle": "-|>", "color": colour, "lw": width, "mutation_scale": 14,
                    "connectionstyle": f"arc3,rad={bend}", "shrinkA": 0, "shrinkB": 0},
    )  # fmt: skip


def box(axes, x, y, width, height, text, colour: str = PALE, size: float = 11) -> None:
    """A rounded box with its lower left corner at (x, y)."""
    from matplotlib.patches import FancyBboxPatch

    shape = FancyBboxPatch(
        (x, y), width, height, boxstyle="round,pad=0,rounding_size=0.12", fc=colour, ec="#555555"
    )
    axes.add_patch(shape)
    axes.text(x + width / 2, y + height / 2, text, ha="center", va="center", fontsize=size)


def save(figure: Figure, name: str, colours: int = 256) -> None:
    """Writes docs/images/course/NAME.png, with few colours."""
    made = BytesIO()
    figure.savefig(made, dpi=DPI)
    write(Image.open(made), name, colours)


def write(picture: Image.Image, name: str, colours: int = 256) -> None:
    """A picture as large as MAX_BYTES allow; the same bytes whenever it is the same."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    picture = picture.convert("RGB")
    for share in np.arange(1, 0.6, -0.04):
        size = round(share * picture.width), round(share * picture.height)
        smaller = picture if share == 1 else picture.resize(size, Image.Resampling.LANCZOS)
        content = BytesIO()
        few = smaller.quantize(colours, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
        few.save(content, "PNG", optimize=True)
        if content.tell() <= MAX_BYTES:
            break
    else:
        sys.exit(f"{name} is too large: {content.tell()} bytes")
    (FOLDER / f"{name}.png").write_bytes(content.getvalue())
    print(f"{name}.png {size} {content.tell()} bytes")


def made(number: int, file: str) -> Path:
    """What the solution of an exercise has made; runs it if it is not there."""
    from botschool.grading.declare.exercise import submission_file
    from botschool.grading.report.showing import show

    path = ROOT / "results" / f"ex{number:02d}" / file
    if not path.is_file():
        show(number, submission_file(number, "solutions", ROOT), ROOT)
    return path


def result(number: int, file: str, width: int = 900, parts=None) -> Image.Image:
    """A picture that the solution has made, made smaller; parts: (left, top, right, bottom)."""
    picture = Image.open(made(number, file)).convert("RGB")
    if parts:
        wide, high = picture.size
        left, top, right, bottom = parts
        picture = picture.crop((left * wide, top * high, right * wide, bottom * high))
    height = round(picture.height * width / picture.width)
    return picture.resize((width, height), Image.Resampling.LANCZOS)


def frames(film: Path, shares, width: int, crop=(0, 0, 1, 1)) -> Image.Image:
    """Frames of a film side by side, at these shares of its length."""
    images = imageio.imread(film, plugin="pyav") if film.suffix == ".gif" else _read(film)
    chosen = [images[min(len(images) - 1, round(share * (len(images) - 1)))] for share in shares]
    return beside([Image.fromarray(each) for each in chosen], width, crop)


def _read(film: Path) -> list[np.ndarray]:
    import imageio.v2

    with imageio.v2.get_reader(film) as reader:
        return [np.asarray(frame) for frame in reader]


def beside(images: list[Image.Image], width: int, crop=(0, 0, 1, 1), gap: int = 4) -> Image.Image:
    """Pictures side by side, each cropped by shares (left, top, right, bottom)."""
    each = (width - gap * (len(images) - 1)) // len(images)
    parts = []
    for image in images:
        wide, high = image.size
        part = image.crop((crop[0] * wide, crop[1] * high, crop[2] * wide, crop[3] * high))
        size = each, round(part.height * each / part.width)
        parts.append(part.resize(size, Image.Resampling.LANCZOS))
    whole = Image.new("RGB", (width, max(part.height for part in parts)), "white")
    for i, part in enumerate(parts):
        whole.paste(part, (i * (each + gap), 0))
    return whole


def above(*images: Image.Image, gap: int = 6) -> Image.Image:
    """Pictures of one width, one above the other."""
    height = sum(image.height for image in images) + gap * (len(images) - 1)
    whole, at = Image.new("RGB", (images[0].width, height), "white"), 0
    for image in images:
        whole.paste(image, (0, at))
        at += image.height + gap
    return whole


def solution(number: int):
    """The solution of an exercise as a module."""
    import importlib.util

    (path,) = ROOT.glob(f"solutions/ex{number:02d}_*/*.py")
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
