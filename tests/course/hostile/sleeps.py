"""Sleeps for a day."""

import time


def hostile(*arguments, **options):
    time.sleep(86400)
