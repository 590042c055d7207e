"""Write frames of episodes to a video file, one at a time."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

import numpy as np

from botschool.errors import BotschoolError
from botschool.output import cannot_write, check_output, written_whole

_EVEN_SIDES = "pad=ceil(iw/2)*2:ceil(ih/2)*2:color=white"
_OWN_PALETTE = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none"

_ENCODERS = {
    ".mp4": "-vf {even} -c:v libx264 -crf 20 -preset fast -pix_fmt yuv420p "
    "-movflags +faststart -f mp4",
    ".webm": "-vf {even} -c:v libvpx-vp9 -crf 30 -b:v 0 -deadline realtime -cpu-used 8 "
    "-pix_fmt yuv420p -f webm",
    ".gif": "-vf fps={gif_fps},{palette} -f gif",
}

VIDEO_SUFFIXES = tuple(_ENCODERS)
MAX_GIF_FPS = 50.0
"""Highest frame rate of a GIF, which counts hundredths of a second; viewers slow faster ones."""


def write_video(path: Path | str, frames: Iterable[np.ndarray], fps: float) -> None:
    """Write frames, each (height, width, 3) uint8 and of one size, to a .mp4, .webm or .gif file.

    Only one frame is in memory at a time. An odd width or height is padded if the format needs even
    ones. An existing file is replaced when the new one is complete, and stays as it is if anything
    fails, including `frames`. Raises BotschoolError if the file cannot be written or there are no
    frames.
    """
    path = check_output(path, VIDEO_SUFFIXES)
    frames = iter(frames)
    first = next(frames, None)
    if first is None:
        raise BotschoolError(f"{path} is not written: there were no frames to show.")
    with written_whole(path) as temporary, TemporaryFile() as complaints:
        encoder = _start_encoder(temporary, first.shape, fps, complaints)
        try:
            accepted = _send(first, frames, encoder.stdin, path)
        except BaseException:
            encoder.kill()
            raise
        finally:
            with suppress(OSError):
                encoder.stdin.close()
            encoder.wait()
        if encoder.returncode != 0 or not accepted:
            raise cannot_write(path, _reason(complaints))


def _start_encoder(
    path: Path, shape: tuple[int, ...], fps: float, complaints: IO[bytes]
) -> subprocess.Popen:
    try:
        import imageio_ffmpeg

        ffmpeg = imageio_ffmpeg.get_ffmpeg_exe()
    except (ImportError, RuntimeError) as error:
        raise BotschoolError(
            "writing videos needs ffmpeg: install it with `pip install 'imageio[ffmpeg]'`."
        ) from error
    height, width = shape[:2]
    encoding = _ENCODERS[path.suffix.lower()].format(
        even=_EVEN_SIDES, palette=_OWN_PALETTE, gif_fps=min(fps, MAX_GIF_FPS)
    )
    command = [ffmpeg, "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgb24"]
    command += ["-s", f"{width}x{height}", "-r", f"{fps}", "-i", "pipe:0", *encoding.split()]
    # Only Python handles Ctrl-C; it then ends the encoder and removes its file.
    windows = sys.platform == "win32"
    return subprocess.Popen(
        [*command, str(path.absolute())],
        stdin=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
        stderr=complaints,
        start_new_session=not windows,
        creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
    )


def _send(first: np.ndarray, others: Iterator[np.ndarray], pipe: IO[bytes], path: Path) -> bool:
    """Send all frames; return False if the encoder ended early."""
    frame = first
    while frame is not None:
        if frame.shape[:2] != first.shape[:2]:
            raise BotschoolError(
                f"{path} is not written: its pictures have different sizes, {first.shape[1]} x "
                f"{first.shape[0]} and {frame.shape[1]} x {frame.shape[0]} pixels, and a film has "
                "one."
            )
        if frame.shape != first.shape or frame.dtype != np.uint8 or frame.shape[2:] != (3,):
            raise BotschoolError(
                f"{path} is not written: a frame of shape {frame.shape} and type {frame.dtype} "
                f"came where {first.shape[:2]} pixels of 3 uint8 are expected."
            )
        try:
            pipe.write(np.ascontiguousarray(frame).data)
        except OSError:
            return False
        frame = next(others, None)
    try:
        pipe.close()
    except OSError:
        return False
    return True


def _reason(complaints: IO[bytes]) -> str:
    """Return why the encoder failed, if it said so."""
    complaints.seek(0)
    said = complaints.read().decode(errors="replace").strip()
    for reason in ("No space left on device", "Permission denied", "Read-only file system"):
        if reason in said:
            return reason
    return said.splitlines()[-1] if said else "the encoder stopped"
