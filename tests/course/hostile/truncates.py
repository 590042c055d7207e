"""Cuts files to nothing, by path and by opening them."""

import os


def hostile(*arguments, **options):
    for path in (f"{HOME}/precious.txt", f"{COURSE}/solutions/precious.txt", __file__):
        for cut in (
            lambda: os.truncate(path, 0),
            lambda: open(path, "w").close(),
            lambda: os.open(path, os.O_RDONLY | os.O_TRUNC),
        ):
            try:
                cut()
            except OSError:
                continue
    return 0
