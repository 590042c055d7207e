"""The film of the README (docs/images/learning.gif): an ant learns to run.

`make figures ONLY=learning`. The run (42 s of a core) stays in results/learning.
"""

import subprocess
import sys

import numpy as np
from PIL import Image, ImageDraw, ImageFont
from style import ROOT

from botschool import config
from botschool.render.canvas import draw_offscreen
from botschool.render.scenes import scene_of
from botschool.render.watch import PostEvaluation, read_genotype

SEED, STEPS = 17, 30_000_000
STAGES = (0, 5, 20, 30, 90, 382)
FIRST, LENGTH, EVERY = 60, 40, 2
"""Steps of each episode that the film shows: from FIRST on, every second one."""
SIZE, COLOURS, BAND = (448, 252), 40, 30
ZOOM = 1.25
MOST = 1_500_000


def draw() -> None:
    file = ROOT / "data" / "experiments" / "spatialant_linear.ini"
    runs = ROOT / "results" / "learning"
    if not (runs / f"bestgS{SEED}G{STAGES[-1]}.npy").is_file():
        run = ["-f", file, "-s", SEED, "-o", runs, "--steps", STEPS, "--keep-every", 1, "--force"]
        command = [sys.executable, "-m", "botschool", "es", *map(str, run)]
        subprocess.run(command, cwd=ROOT, check=True)
    experiment = config.load(file)
    draw_offscreen()
    pictures = []
    for stage in STAGES:
        saved = read_genotype(runs / f"bestgS{SEED}G{stage}.npy")
        pictures += _labelled(PostEvaluation(experiment, SEED, saved, f"generation {stage}"))
    whole = Image.new("RGB", (SIZE[0], SIZE[1] * len(STAGES)))
    for i in range(len(STAGES)):
        whole.paste(pictures[i * LENGTH // EVERY], (0, i * SIZE[1]))
    palette = whole.quantize(COLOURS, Image.Quantize.MEDIANCUT)
    few = [each.quantize(palette=palette, dither=Image.Dither.NONE) for each in pictures]
    path = ROOT / "docs" / "images" / "learning.gif"
    few[0].save(path, save_all=True, append_images=few[1:], duration=100, loop=0)
    size = path.stat().st_size
    assert size < MOST, f"{size} bytes: take a smaller SIZE"
    print(f"learning.gif {SIZE} {len(few)} frames {size} bytes")


def _labelled(robot: PostEvaluation) -> list[Image.Image]:
    """Return the pictures of a part of the first episode, with generation and speed."""
    steps = list(robot.play(0, render=True))
    scene = scene_of(robot.problem)
    metres = (steps[-1].state[0] - steps[0].state[0]) / (len(steps) / scene.fps)
    text = f"{robot.name}: {max(metres, 0):.1f} m/s"
    frames = [scene.draw_transition(step) for step in steps[: FIRST + LENGTH]]
    return [_framed(frame, text) for frame in frames[FIRST::EVERY]]


def _framed(frame: np.ndarray, text: str) -> Image.Image:
    width, height = SIZE[0], SIZE[1] - BAND
    picture = Image.fromarray(frame)
    scale = ZOOM * max(width / picture.width, height / picture.height)
    picture = picture.resize((round(picture.width * scale), round(picture.height * scale)))
    left, top = (picture.width - width) // 2, (picture.height - height) * 3 // 4
    whole = Image.new("RGB", SIZE, "white")
    whole.paste(picture.crop((left, top, left + width, top + height)), (0, BAND))
    font = ImageFont.load_default(19)
    ImageDraw.Draw(whole).text((10, 4), text, fill="black", font=font)
    return whole
