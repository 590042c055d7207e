"""Puts functions of its own in the place of those that pack and send what it returns."""

import json
import os
import struct
import sys

import numpy


def hostile(*arguments, **options):
    protocol = sys.modules["botschool.sandbox.protocol"]
    child = sys.modules["botschool.sandbox.child"]
    right = {"value": [1, 2, 0], "points": 100, "error": None, "missing": []}
    message = protocol.pack(right)
    protocol.pack = child.answer_to = child.explain = child._explained = lambda *_, **__: message
    protocol._simple = lambda value, *_: right
    protocol.NotPlain = Exception
    json.dumps = lambda *_, **__: '{"value": true}'
    struct.pack = lambda *_: b""
    numpy.asarray = numpy.array = numpy.allclose = lambda *_, **__: numpy.ones(3)
    child.run = lambda *_: True
    write = os.write
    os.write = lambda fd, data: write(fd, message) and len(data)
    return 0
