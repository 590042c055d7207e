"""Folders that cannot be written and disks that fill up: one sentence, and nothing is lost."""

import os
import shutil
import subprocess
import sys

import numpy as np
import pytest

from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.record import RunFiles
from botschool.evolution.run import Run, evolve
from botschool.output import save_npy, save_npz
from running import call, contents, experiment, finish, one_sentence, run_seeds, same, start

POLICY = {"normalize": 1}
linux = pytest.mark.skipif(sys.platform != "linux", reason="Linux only")
posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such limit")


@pytest.fixture
def own(tmp_path):
    """The experiment in tmp_path/own.ini, saved each generation; about 20 generations."""
    return experiment(tmp_path, "CartPole-v1", "SSS", POLICY, maxmsteps=0.004, saveeach=0)


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 200 kB; only root can make one."""
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=200k", "tmpfs", str(disk)]
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("mount"):
        pytest.skip("only root can mount a small disk")
    if subprocess.run(mount, capture_output=True).returncode:
        pytest.skip("mounting is not allowed here")
    yield disk
    subprocess.run(["umount", "-l", str(disk)], check=True)


def readable(folder, seed=1):
    """Whether the files of a run are whole; gives its generations."""
    files = RunFiles(folder, seed)
    assert not [path for path in folder.iterdir() if path.name.startswith(".")]
    for path in (files.best, files.bestg):
        assert np.isfinite(np.load(path)).all()
    words = files.fit.read_text().split()
    assert words[0::2] == ["seed", "gen", "steps", "bestfit", "bestgfit"]
    np.load(files.checkpoint)
    return len(np.load(files.stat)) // 6


# full disks


@pytest.mark.slow
@posix
def test_files_that_may_not_grow(own, tmp_path):
    """A limit on the size of files is met in the middle of the run, at the checkpoint."""
    import resource

    assert run_seeds(own, tmp_path / "whole")
    limit = (tmp_path / "whole" / "checkpointS1.npz").stat().st_size - 400

    def limited():
        resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))

    folder = tmp_path / "limited"
    process = start("es", "-f", tmp_path / "own.ini", "-o", folder, preexec_fn=limited)
    code, _, errors = finish(process)
    one_sentence(code, errors, [folder / "checkpointS1.npz", "cannot be written", "free some"])
    assert readable(folder) > 1
    before = contents(folder)
    process = start(
        *("es", "-f", tmp_path / "own.ini", "-o", folder, "--resume"), preexec_fn=limited
    )
    code, _, errors = finish(process)
    one_sentence(code, errors, "checkpointS1.npz")
    assert contents(folder) == before
    assert run_seeds(own, folder, resume=True)
    assert same(tmp_path / "whole", folder)


@pytest.mark.slow
@linux
def test_a_disk_that_fills_up_while_a_run_goes_on(own, small_disk, tmp_path):
    assert run_seeds(own, tmp_path / "whole")
    folder = small_disk / "results"
    ini = tmp_path / "own.ini"
    assert call("es", "-f", ini, "-o", folder, "--steps", 1000)[0] == 0
    before = contents(folder)
    with open(small_disk / "ballast", "wb", buffering=0) as ballast:
        try:
            while True:
                ballast.write(bytes(4096))
        except OSError:
            pass
    code, _, errors = call("es", "-f", ini, "-o", folder, "--resume")
    one_sentence(code, errors, [folder, "No space left on device", "free some space"])
    assert contents(folder) == before
    (small_disk / "ballast").unlink()
    assert run_seeds(own, folder, resume=True)
    assert same(tmp_path / "whole", folder)


@pytest.mark.slow
@linux
def test_output_to_a_full_disk(own, tmp_path):
    """botschool es ... > FILE, where the disk of FILE is full: what was done is saved."""
    with open("/dev/full", "w") as full:
        process = start("es", "-f", tmp_path / "own.ini", "-o", tmp_path / "results", stdout=full)
        code, _, errors = finish(process)
    one_sentence(code, errors, ["standard output", "No space left on device"])
    assert readable(tmp_path / "results") >= 1  # lines are printed every tenth of a second
    assert run_seeds(own, tmp_path / "results", resume=True)
    assert run_seeds(own, tmp_path / "whole")
    assert same(tmp_path / "whole", tmp_path / "results")


# folders


@posix
@pytest.mark.parametrize(("mode", "says"), [(0o555, "Permission denied"), (0o000, "readable")])
def test_a_folder_without_permission(mode, says, own, tmp_path):
    folder = tmp_path / "results"
    folder.mkdir()
    folder.chmod(mode)
    try:
        if os.access(folder, os.W_OK):
            pytest.skip("root may write everywhere")
        code, _, errors = call("es", "-f", tmp_path / "own.ini", "-o", folder)
        one_sentence(code, errors, [folder, says])
    finally:
        folder.chmod(0o755)
    assert not list(folder.iterdir())


# the functions beneath


def test_a_file_is_replaced_whole_or_not_at_all(tmp_path, monkeypatch):
    path = tmp_path / "numbers.npy"
    save_npy(path, np.arange(3.0))

    def fails(*arguments):
        raise OSError(28, "No space left on device")

    for function in ("fsync", "replace"):
        with monkeypatch.context() as patch:
            patch.setattr(os, function, fails)
            with pytest.raises(BotschoolError, match=r"numbers.npy cannot be .*No space left"):
                save_npy(path, np.arange(4.0))
            with pytest.raises(BotschoolError, match=r"new.npz cannot be written"):
                save_npz(tmp_path / "new.npz", {"a": np.arange(3)})
        assert np.load(path).tolist() == [0, 1, 2]
        assert [file.name for file in tmp_path.iterdir()] == ["numbers.npy"]
    save_npy(path, np.arange(4.0))
    assert len(np.load(path)) == 4


# folders that disappear


def evolved(own, folder, disturb=lambda folder: None, keep_every=None):
    """Evolve nine generations and call `disturb` after the fourth; return the files."""
    folder.mkdir(parents=True)

    def report(run):
        if run.record.generation == 4 and left.pop("disturb", None):
            disturb(folder)

    left = {"disturb": True}
    run = (Coevolution if own.competitive else Run)(own, 1)
    evolve(run, folder, report=report, generations=9, keep_every=keep_every)
    return contents(folder)


@pytest.mark.parametrize("what", ["folder", "parent", "events"])
@pytest.mark.parametrize("saveeach", [0, 60])
@pytest.mark.parametrize("keep_every", [None, 2])
def test_a_removed_folder_is_made_again(what, saveeach, keep_every, tmp_path, capfd):
    own = experiment(tmp_path, "CartPole-v1", "SSS", POLICY, maxmsteps=1, saveeach=saveeach)
    whole = evolved(own, tmp_path / "whole" / "run", keep_every=keep_every)
    assert capfd.readouterr().err == ""

    def remove(folder):
        shutil.rmtree({"folder": folder, "parent": folder.parent}.get(what, events(folder).parent))

    def events(folder):
        return next(folder.glob("tensorboardS1/*"))

    folder = tmp_path / "again" / "run"
    again = evolved(own, folder, remove, keep_every)
    lost = set() if what == "events" else {f"bestgS1G{g}.npy" for g in (0, 2, 4)}
    assert again == {name: content for name, content in whole.items() if name not in lost}
    assert events(folder).stat().st_size == events(tmp_path / "whole" / "run").stat().st_size
    assert capfd.readouterr().err.count("run was removed: it is made again") == (what != "events")
