"""Reads address 0."""

import ctypes


def hostile(*arguments, **options):
    return ctypes.string_at(0)
