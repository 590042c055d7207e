"""Walks up the stack and changes what it finds there: drivers, requests, records."""

import gc
import sys


def hostile(*arguments, **options):
    frame = sys._getframe()
    while frame is not None:
        for value in list(frame.f_locals.values()):
            if isinstance(value, dict) and "name" in value:
                value["name"] = "len"
            if isinstance(value, list):
                value.clear()
        frame = frame.f_back
    for thing in gc.get_objects():
        if type(thing).__name__ in ("Task", "TaskResult", "Exercise"):
            thing.points = 100
    return {"points": 100, "best": [], "fitness": 0, "history": [], "population": []}
