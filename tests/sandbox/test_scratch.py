"""The folder of untrusted code: what is copied into it, read from it, and removed with it."""

import os
from pathlib import Path

import pytest

from botschool.sandbox import Refused, Scratch, scratch


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "own" / "untrusted.py"
    path.parent.mkdir()
    path.write_text("")
    return path


def test_links_hidden_and_skipped_files_are_not_copied(tmp_path, file):
    (tmp_path / "secret.txt").write_text("secret")
    for name in ("left_out.py", ".hidden", "helper.py", "data/left_out.py"):
        place = file.parent / name
        place.parent.mkdir(exist_ok=True)
        place.write_text("")
    (file.parent / "link.txt").symlink_to(tmp_path / "secret.txt")
    (file.parent / "folder").symlink_to(tmp_path)
    os.mkfifo(file.parent / "pipe")
    found = scratch.regular_files(file, lambda name, depth: name == "left_out.py" and depth == 1)
    names = [str(path.relative_to(file.parent)) for path in found]
    assert names == ["data/left_out.py", "helper.py", "untrusted.py"]
    linked = tmp_path / "linked" / "untrusted.py"
    linked.parent.mkdir()
    linked.symlink_to(file)
    with pytest.raises(Refused, match="is a link"):
        scratch.regular_files(linked)


def test_what_is_read_is_a_copy(file):
    one = Scratch(file)
    (one.folder / "best.txt").write_text("1")
    (one.folder / "link.txt").symlink_to("/etc/passwd")
    os.mkfifo(one.folder / "pipe.txt")
    place = one.copy("best.txt")
    assert place.read_text() == "1"
    assert not place.is_relative_to(one.root)
    for name in ("link.txt", "pipe.txt", "absent.txt", "../../../../etc/passwd"):
        with pytest.raises(OSError):
            one.copy(name)
    one.remove()
    assert not one.root.exists()


def test_deep_and_closed_folders_are_removed(tmp_path):
    base = tmp_path / "base"
    base.mkdir()
    here = os.open(base, os.O_RDONLY)
    for _ in range(1100):
        os.mkdir("d" * 100, dir_fd=here)
        inner = os.open("d" * 100, os.O_RDONLY, dir_fd=here)
        os.close(here)
        here = inner
    os.close(here)
    (base / "closed" / "inside").mkdir(parents=True)
    (base / "closed").chmod(0)
    scratch.remove_tree(base)
    assert not base.exists()


def test_pictures_are_few_and_small(file):
    one = Scratch(file)
    header = b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR"
    size = (10).to_bytes(4, "big")
    for number in range(6):
        (one.folder / f"{number}.png").write_bytes(header + size * 2 + bytes(20))
    (one.folder / "0.png").write_bytes(header + b"\xff" * 30)
    (one.folder / "1.png").write_bytes(b"<svg>")
    (one.folder / "2.png").write_bytes(header + size * 2 + bytes(700_000))
    (one.folder / "a.png").symlink_to("/etc/passwd")
    assert [name for name, _ in one.pictures()] == ["3.png", "4.png", "5.png"]
    one.remove()


@pytest.fixture
def in_memory(server, file):
    """A scratch folder in memory, with its server."""
    one = Scratch(file)
    one.enter(server)
    if not one.in_memory:
        pytest.skip("this system allows no mount namespace")
    yield one
    one.remove()


def mounts(server):
    return [
        line.split()[1] for line in Path(f"/proc/{server._process.pid}/mounts").open()
    ]  # fmt: skip


def test_the_memory_is_of_limited_size_and_goes_with_the_folder(server, in_memory):
    place = Path(f"/proc/{server._process.pid}/root{in_memory.folder}")
    assert (place / "untrusted.py").exists()
    assert str(in_memory.root) in mounts(server)
    assert str(in_memory.root) not in Path("/proc/self/mounts").read_text()
    with pytest.raises(OSError, match="No space left"), open(place / "large", "wb") as large:
        for _ in range(300):
            large.write(bytes(2**20))
    assert not (in_memory.folder / "large").exists()  # which is the disk, here
    assert in_memory.is_full() == "it wrote more than 256 MB of files"
    with pytest.raises(OSError):
        in_memory.copy("large")
    (place / "large").unlink()
    assert in_memory.is_full() == ""
    (place / "small").write_text("1")
    assert in_memory.copy("small").read_text() == "1"
    in_memory.remove()
    assert str(in_memory.root) not in mounts(server)


def test_folders_named_like_pictures_leave_no_descriptors_open(file):
    one = Scratch(file)
    for number in range(20):
        (one.folder / f"{number}.png").mkdir()
    before = len(os.listdir("/dev/fd"))
    assert one.pictures() == []
    assert len(os.listdir("/dev/fd")) == before
    one.remove()


def test_a_folder_that_became_a_link_is_not_followed(file, tmp_path):
    one = Scratch(file)
    (tmp_path / "secret").mkdir()
    (tmp_path / "secret" / "best.txt").write_text("1")
    (tmp_path / "secret" / "best.png").write_text("1")
    one.folder.rename(one.root / "moved")
    one.folder.symlink_to(tmp_path / "secret")
    with pytest.raises(OSError):
        one.copy("best.txt")
    assert one.pictures() == []
    one.remove()
