"""Looks for the grading seed and the answers in other processes."""

import os


def hostile(*arguments, **options):
    for number in (os.getppid(), 1, *range(os.getpid() - 50, os.getpid())):
        for name in ("environ", "cmdline", "maps", "cwd/Makefile"):
            try:
                with open(f"/proc/{number}/{name}", "rb") as file:
                    print("LEAKED", file.read(1000))
            except OSError:
                continue
    print("LEAKED" if "BOTSCHOOL_GRADING_SEED" in os.environ else "nothing")
    return os.environ.get("BOTSCHOOL_GRADING_SEED")
