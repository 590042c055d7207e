"""Makes a hundred thousand files."""

import os


def hostile(*arguments, **options):
    for number in range(100_000):
        os.close(os.open(f"{number}", os.O_CREAT, 0))
    return 0
