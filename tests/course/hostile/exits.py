"""Ends the program with success."""

import sys


def hostile(*arguments, **options):
    sys.exit(0)
