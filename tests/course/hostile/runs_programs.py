"""Starts other programs, in every way."""

import os
import subprocess
import sys


def hostile(*arguments, **options):
    touch = f"open({HOME + '/touched'!r}, 'w')"
    for start in (
        lambda: os.system(f"touch {HOME}/touched"),
        lambda: subprocess.run([sys.executable, "-c", touch]),
        lambda: subprocess.Popen(["sleep", "86400"], start_new_session=True),
        lambda: os.posix_spawn("/bin/sh", ["sh", "-c", f"touch {HOME}/touched"], {}),
        lambda: os.execv("/bin/sh", ["sh", "-c", "echo 100 of 100 points"]),
    ):
        try:
            start()
        except OSError:
            continue
    return 0
