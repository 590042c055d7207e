"""Makes folders in folders that are hard to remove: deep, unreadable, strangely named."""

import os


def hostile(*arguments, **options):
    os.mkdir("closed", 0o300)
    os.mkdir("closed/inside", 0)
    os.mkdir("\n\x1b[2J\udcff")
    for _ in range(3000):
        os.mkdir("d" * 200, 0o700)
        os.chdir("d" * 200)
    os.mkdir("last", 0)
    return 0
