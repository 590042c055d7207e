"""Open files that users name, and read the numbers of .npy files."""

from __future__ import annotations

import errno
import os
import warnings
from pathlib import Path
from stat import S_ISDIR, S_ISREG
from typing import BinaryIO

import numpy as np

OBJECTS = (
    "it holds Python objects, which could run code; if you trust it, make it plain numbers: "
    "numpy.save(FILE, numpy.load(FILE, allow_pickle=True).astype(float))"
)

DAMAGED = "it is damaged: take a copy of it, or make it again"


class NotNumbers(ValueError):
    """Says what is wrong with a file, as the end of a sentence without full stop."""


def opened(path: Path | str | os.PathLike[str]) -> BinaryIO:
    """Open a regular file. Raises OSError, also for pipes and devices, which might never end."""
    mode = os.stat(path).st_mode
    if not S_ISREG(mode) and not S_ISDIR(mode):
        raise OSError(errno.EINVAL, "it is a pipe or a device, not a file")
    return open(path, "rb")


def read_numbers(path: Path | str | os.PathLike[str]) -> np.ndarray:
    """Return the array of plain numbers in a .npy file. Raises OSError and NotNumbers."""
    with opened(path) as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")  # a damaged header causes warnings
        magic = file.read(len(np.lib.format.MAGIC_PREFIX))
        if magic.startswith(b"PK"):
            raise NotNumbers("it is a zip or .npz file, not a .npy file of numbers")
        if magic != np.lib.format.MAGIC_PREFIX:
            raise NotNumbers("it is not in numpy's .npy format")
        file.seek(0)
        try:
            numbers = np.lib.format.read_array(file, allow_pickle=False)
        except Exception as error:  # a damaged file can fail in any way
            objects = str(error).startswith("Object arrays")
            raise NotNumbers(OBJECTS if objects else DAMAGED) from error
    if numbers.dtype.kind not in "fiu":
        raise NotNumbers("it does not hold plain numbers")
    return numbers
