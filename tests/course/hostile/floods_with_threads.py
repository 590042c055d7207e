"""Prints without end from the background, and answers at once."""

import os
import threading


def flood():
    while True:
        os.write(2, b"0" * 65536)


def hostile(*arguments, **options):
    for _ in range(8):
        threading.Thread(target=flood, daemon=True).start()
    return 0
