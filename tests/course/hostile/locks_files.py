"""Locks files that others use, for as long as it runs."""

import fcntl
import json
import time

LOCKED = []


def hostile(*arguments, **options):
    for path in ("/etc/passwd", json.__file__, "/dev/null"):
        try:
            LOCKED.append(open(path))
            fcntl.flock(LOCKED[-1], fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            continue
    time.sleep(1000)
    return 0
