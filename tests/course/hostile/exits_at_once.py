"""Ends the process behind Python's back, with success."""

import os


def hostile(*arguments, **options):
    os._exit(0)
