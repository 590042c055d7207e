"""Two commands never write the same run; Ctrl-C at any moment is a sentence at most."""

import shutil
import signal
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

from botschool.lock import NAME
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
