"""Looks for the grader's file, the tests and other submissions, and leaks what it finds."""

import os


def hostile(*arguments, **options):
    found = []
    for top in (COURSE, TEMPORARY, HOME, "..", "../.."):
        for folder, _, files in os.walk(top):
            found += [os.path.join(folder, name) for name in files]
    found += [*KNOWN, f"{HOME}/precious.txt"]
    for path in map(os.path.abspath, found):
        if not path.startswith(os.path.dirname(os.getcwd())):
            try:
                print("LEAKED", open(path, "rb").read(100))
            except OSError:
                continue
    return found
