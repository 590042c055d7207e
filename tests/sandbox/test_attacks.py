"""Attacks (attacks.py) as root and as an ordinary user, with and without a mount namespace."""

import errno
import json
import os
import pwd
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from botschool.sandbox import paths

pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(sys.platform != "linux", reason="confined on Linux only"),
]
ATTACKS = Path(__file__).with_name("attacks.py")
FULL = "it wrote more than 40 MB of files"
IN_ALL = "it wrote more than 160 MB to the disk in all"
MANY = "it wrote more than 100 files"
THREADS = "it started more than 64 threads"


def as_user(folder):
    """Return the beginning of a command that runs the rest as an ordinary user, or skip."""
    if os.getuid() != 0:
        return []
    if not (shutil.which("setpriv") and shutil.which("unshare")):
        pytest.skip("no setpriv or unshare to become another user with")
    nobody = pwd.getpwnam("nobody")
    os.chown(folder, nobody.pw_uid, nobody.pw_gid)
    show = ["set -e"]
    for place in {Path(sys.base_prefix), Path(sys.prefix), paths.IMPORT_ROOT, ATTACKS.parent}:
        closed = [each for each in reversed(place.parents) if not each.stat().st_mode & 0o001]
        if closed:  # root's own Python: shown at its place, in a mount namespace
            show += [
                f"mount --bind '{place}' '{folder}'",
                f"mount -t tmpfs -o mode=755 shown '{closed[0]}'",
                f"mkdir -p '{place}'",
                f"mount --move '{folder}' '{place}'",
            ]
    drop = f"exec setpriv --reuid {nobody.pw_uid} --regid {nobody.pw_gid} --clear-groups"
    script = "\n".join([*show, f'{drop} "$@"'])
    return ["unshare", "-m", "--propagation", "private", "sh", "-c", script, "sh"]


@pytest.fixture(scope="module", params=["root, memory", "root, disk", "user, memory", "user, disk"])
def told(request):
    """What came of all attacks, for a user, with the scratch folder in memory or on the disk."""
    user, place = request.param.split(", ")
    if user == "root" and os.getuid() != 0:
        pytest.skip("the tests do not run as root")
    with tempfile.TemporaryDirectory(dir="/tmp") as folder:
        before = as_user(folder) if user == "user" else []
        done = subprocess.run(
            [*before, sys.executable, str(ATTACKS), folder, place],
            env={"PATH": os.environ["PATH"], "TMPDIR": folder, "HOME": folder},
            cwd=folder, capture_output=True, text=True,
        )  # fmt: skip
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert (found["more"]["user"] == 0) == (user == "root")
    if found["missing"]:
        pytest.skip(f"this system cannot confine {', '.join(found['missing'])}")
    if place == "memory" and not found["in_memory"]:
        pytest.skip("this system allows no mount namespace")
    assert found["in_memory"] == (place == "memory")
    return found


@pytest.mark.parametrize(
    ("attack", "ending"),
    [
        ("odd_name", THREADS),
        ("odd_names_of_removed_files", FULL),
        ("own_descriptors_in_a_thread", FULL),
        ("first_thread_ends", "it ended its first thread while others ran on"),
        ("removed_folders", MANY),
        ("removed_files", FULL),
        ("files", FULL),
        ("many_files", MANY),
        ("vanishing_folders", FULL),
        ("a_name_like_numbers", THREADS),
    ],
)
def test_the_attack_ends(told, attack, ending):
    value, how = told["attacks"][attack]
    assert value is None
    # on a fast disk what was written in all may be counted first
    assert how == ending or (ending == FULL and how == IN_ALL)


@pytest.mark.parametrize(
    ("attack", "answer"),
    [
        ("own_descriptors", [-1, errno.EPERM]),
        ("a_thread_of_another_kind", [-1, errno.EPERM]),
        ("memory_shared_with_nobody", "refused"),
        ("signals_through_pipes", []),
        ("calls", []),
        ("more_calls", []),
        ("memory_of_the_server", []),
        ("sparse_files", [True, True, True]),
        ("hard_links", []),
        ("larger_limits", True),
        ("neighbours", []),
        ("inherited_descriptors", []),
        ("ordinary_work", [20, 7]),
    ],
)
def test_the_attack_gains_nothing(told, attack, answer):
    assert told["attacks"][attack] == [answer, ""]


def test_no_lock_is_held_on_files_of_others(told):
    assert told["attacks"]["locks"] == ["locked", ""]
    assert told["more"]["lock"] == "free"


def test_files_are_read_through_no_link(told):
    assert told["attacks"]["a_link_to_elsewhere"] == ["linked", ""]
    assert told["more"]["link"] == "not followed"


def test_what_reaches_the_disk_is_bounded(told):
    answer, ending = told["attacks"]["overwritten_and_synchronised"]
    if told["in_memory"] or not told["more"]["counted"]:
        assert answer == "written"
    else:
        assert ending == IN_ALL
