"""Changes modes, owners, times and attributes of files that are not its own."""

import os
import time


def hostile(*arguments, **options):
    for top in (COURSE, HOME):
        for folder, _, files in os.walk(top):
            for path in (folder, *(os.path.join(folder, name) for name in files)):
                attempt(path)
        attempt(top)
        for name in ("solutions", "exercises", "tests", "precious.txt"):
            attempt(os.path.join(top, name))
    return 0


def attempt(path):
    for change in (
        lambda: os.chmod(path, 0),
        lambda: os.utime(path, (1, time.time())),
        lambda: os.chown(path, 65534, 65534),
        lambda: os.setxattr(path, "user.hostile", b"1"),
    ):
        try:
            change()
        except OSError:
            continue
