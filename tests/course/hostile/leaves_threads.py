"""Answers, and leaves threads that keep the processor busy and the interpreter alive."""

import threading


def busy():
    while True:
        sum(range(1000))


def hostile(*arguments, **options):
    for _ in range(4):
        threading.Thread(target=busy).start()
    return 1.0
