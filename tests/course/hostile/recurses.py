"""Calls itself without end, with no limit."""

import sys


def hostile(*arguments, **options):
    sys.setrecursionlimit(2**30)
    return hostile(*arguments, **options)
