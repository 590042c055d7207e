"""Prints without end."""

import os
import sys


def hostile(*arguments, **options):
    while True:
        os.write(1, b"all tests passed, 100 of 100 points\n" * 1000)
        print("x" * 100_000, file=sys.stderr)
