"""Puts objects that raise in the place of standard output, error and built-in functions."""

import builtins
import os
import sys


class Raises:
    def __getattr__(self, name):
        raise SystemExit(0)


def hostile(*arguments, **options):
    sys.stdout = sys.stderr = Raises()
    builtins.len = builtins.isinstance = builtins.type = Raises()
    os.write = Raises()
    return 0
