"""Two commands never write the same run; Ctrl-C at any moment is a sentence at most."""

import errno
import fcntl
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import time
from pathlib import Path

import pytest

from botschool import lock
from botschool.errors import BotschoolError
from botschool.lock import NAME, locked
from running import call, finish, one_sentence, start, write_experiment

posix = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals and locks")
pytestmark = posix


@pytest.fixture
def evolving(tmp_path):
    """A run of seed 5 in tmp_path/results, once it has begun."""
    ini = write_experiment(tmp_path, maxmsteps=1000)
    arguments = ("es", "-f", ini, "-o", tmp_path / "results")
    process = start(*arguments, "-s", 5)
    process.stdout.readline()
    yield arguments, process
    process.kill()
    process.communicate()


@pytest.mark.slow
@pytest.mark.parametrize("how", ["--resume", "--force"])
def test_a_run_that_another_command_writes_is_refused(how, evolving, tmp_path):
    arguments, process = evolving
    for seed, replications in ((5, 1), (3, 4)):
        code, _, errors = call(*arguments, "-s", seed, "-n", replications, how)
        one_sentence(code, errors, ["Another command is writing", str(tmp_path / "results")])
    assert process.poll() is None
    process.send_signal(signal.SIGINT)
    code, _, errors = finish(process)
    assert (code, errors) == (130, "")
    assert not (tmp_path / "results" / NAME).exists()
    assert call(*arguments, "-s", 5, how, "--generations", 1)[0] == 0


@pytest.mark.slow
def test_other_seeds_of_the_folder_are_free(evolving, tmp_path):
    arguments, process = evolving
    for seed in (4, 6):
        assert call(*arguments, "-s", seed, "--generations", 1)[0] == 0
    assert process.poll() is None and (tmp_path / "results" / NAME).exists()


@pytest.mark.slow
def test_a_killed_command_leaves_no_lock(evolving):
    arguments, process = evolving
    process.kill()
    process.wait()
    assert call(*arguments, "-s", 5, "--resume", "--generations", 1)[0] == 0


def test_a_file_system_without_locks_is_a_warning(tmp_path, monkeypatch, capsys):
    def refuse(*_):
        raise OSError(errno.ENOLCK, "No locks available")

    monkeypatch.setattr(fcntl, "lockf", refuse)
    with locked(tmp_path, "the run with seed 1"):
        pass
    assert "warning: " in (said := capsys.readouterr().err) and "without locks" in said


def test_a_lock_whose_file_was_removed_meanwhile_is_taken_anew(tmp_path, monkeypatch):
    """Another command has removed the file between opening and locking it."""
    lockf, removed = fcntl.lockf, []

    def slow(file, *rest):
        if not removed:
            removed.append((tmp_path / NAME).unlink())
        return lockf(file, *rest)

    monkeypatch.setattr(fcntl, "lockf", slow)
    with locked(tmp_path, "the run"):
        other = "import sys; from botschool.lock import locked; from pathlib import Path\n"
        other += "with locked(Path(sys.argv[1]), 'the run'): print('both')"
        done = subprocess.run(
            [sys.executable, "-c", other, tmp_path], capture_output=True, text=True
        )
        assert "Another command is writing the run" in done.stderr and not done.stdout


def test_a_folder_that_cannot_be_written(tmp_path):
    (tmp_path / NAME).mkdir()
    with pytest.raises(BotschoolError, match="cannot be written"), locked(tmp_path, "the run"):
        pass
    assert lock.NAME == NAME


def heeding_ctrl_c():
    """Take Ctrl-C as a terminal's processes do: those of pytest-xdist ignore it."""
    signal.signal(signal.SIGINT, signal.default_int_handler)


EARLY = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # a process of pytest-xdist ignores it
from botschool.cli import main
class Slow:
    def find_spec(self, name, path=None, target=None):
        if name == "{module}":
            os.kill(os.getpid(), signal.SIGINT)
sys.meta_path.insert(0, Slow())
sys.argv = ["botschool", "--version"]
main()
"""


@pytest.mark.parametrize("module", ["botschool.cli.app", "typer", "botschool.cli.es"])
def test_ctrl_c_while_the_command_is_imported(module):
    done = subprocess.run(
        [sys.executable, "-c", EARLY.format(module=module)], capture_output=True, text=True
    )
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "Stopped before anything was done.\n"


def pressing_ctrl_c():
    """Leave a Ctrl-C that waits until the process can answer it."""
    heeding_ctrl_c()
    signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    os.kill(os.getpid(), signal.SIGINT)


COMMAND = Path(sysconfig.get_path("scripts")) / "botschool"


SHOWS = """#!{python}
import signal, sys
print(signal.SIGINT in signal.pthread_sigmask(signal.SIG_BLOCK, []), sys.argv[1:2] + sys.argv[3:])
"""


def test_the_launcher_holds_ctrl_c_back_and_hands_all_words_on(tmp_path):
    shutil.copy(COMMAND, tmp_path / "botschool")
    beside = tmp_path / f"python{sys.version_info[0]}.{sys.version_info[1]}"
    beside.write_text(SHOWS.format(python=sys.executable))
    beside.chmod(0o755)
    words = ["es", "two words", "", '"quoted"']
    done = subprocess.run([tmp_path / "botschool", *words], capture_output=True, text=True)
    assert done.stdout == f"True {['-c', *words]}\n"


def test_ctrl_c_that_waits_is_answered_by_main():
    done = subprocess.run(
        [COMMAND, "--version"], capture_output=True, text=True, preexec_fn=pressing_ctrl_c
    )
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "Stopped before anything was done.\n"


@pytest.mark.parametrize("milliseconds", [1, 4, 8, 12, 16, 24, 32, 64])
def test_ctrl_c_a_moment_after_the_start(milliseconds):
    process = subprocess.Popen(
        [COMMAND, "es", "--help"],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=heeding_ctrl_c,
    )
    time.sleep(milliseconds / 1000)
    process.send_signal(signal.SIGINT)
    errors = process.communicate()[1]
    silent = (-signal.SIGINT, ""), (0, "")  # before the launcher runs; when all is done
    said = (130, "Stopped before anything was done.\n"), (130, "Stopped.\n")
    assert (process.returncode, errors) in silent + said


def test_the_command_runs_no_module_of_the_folder_that_it_is_called_in(tmp_path):
    for name in ("botschool", "typer", "signal"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit(f'{__name__} is not trusted')")
    done = subprocess.run([COMMAND, "--version"], cwd=tmp_path, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "") and done.stdout.startswith("botschool ")


LATE = """
import atexit, os, signal, sys, threading
signal.signal(signal.SIGINT, signal.default_int_handler)
atexit.register(lambda: os.kill(os.getpid(), signal.SIGINT))
threading._register_atexit(lambda: os.kill(os.getpid(), signal.SIGINT))
from botschool.cli import main
sys.argv = ["botschool", *sys.argv[1:]]
main()
"""


@pytest.mark.parametrize(
    ("arguments", "code", "errors"),
    [(["--version"], 0, 0), (["es", "-f", "missing.ini"], 2, 1)],
)
def test_ctrl_c_while_the_command_exits(arguments, code, errors):
    done = subprocess.run([sys.executable, "-c", LATE, *arguments], capture_output=True, text=True)
    assert (done.returncode, done.stderr.count("\n")) == (code, errors), done.stderr


MIDDLE = """
import os, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)  # as a terminal's processes have it
from botschool import config
config.load = lambda path: os.kill(os.getpid(), signal.SIGINT)
from botschool.cli import main
sys.argv = ["botschool", "es", "-f", "acrobot.ini"]
main()
"""


@pytest.mark.slow
def test_ctrl_c_in_the_middle_of_a_command_is_a_sentence(tmp_path):
    """Of a command that saves nothing."""
    (tmp_path / "acrobot.ini").touch()
    done = subprocess.run(
        [sys.executable, "-c", MIDDLE], cwd=tmp_path, capture_output=True, text=True, timeout=60
    )
    assert (done.returncode, done.stderr) == (130, "Stopped.\n")
