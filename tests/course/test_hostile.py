"""Hostile submissions of hostile/*.py: a function `hostile` each, which replaces students' ones.

It finds COURSE (a copy of the course with solutions), HOME, TEMPORARY (with somebody else's files),
FRIEND (an address that listens), SEGMENT (shared memory of another program) and KNOWN (the files
with the answers) to attack. What is "LEAKED" it prints.
"""

import contextlib
import ctypes
import dataclasses
import hashlib
import os
import platform
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
import time
from pathlib import Path
from unittest import mock

import psutil
import pytest

import building
from botschool.errors import BotschoolError
from botschool.grading.judge.submission import grade_task
from botschool.grading.run.confined import fork_server
from botschool.grading.run.ours import ours_of
from botschool.rl.folder import RunFolder
from botschool.rl.settings import Settings
from botschool.sandbox import process, seccomp

pytestmark = pytest.mark.course

KINDS = sorted(building.hostile())
EXERCISES = [int(n) for n in os.environ.get("HOSTILE_EXERCISES", "3 1 8").split()]
"""As many as `make check-course` has time for; HOSTILE_EXERCISES names others."""
for_each_exercise = pytest.mark.parametrize("number", EXERCISES, ids="ex{:02d}".format)
SECONDS = 1.5
"""A task's limit here, of processor time; what does nothing may take 2 * SECONDS + 2."""
PROCESSOR_SECONDS = 5
"""What judging a submission may cost the grader's own process."""


class Trap:
    """A small world to attack, and what it looked like before."""

    def __init__(self, base: Path) -> None:
        self.course, self.home, self.temporary = base / "course", base / "home", base / "tmp"
        for name in ("exercises", "solutions", "data/robots"):
            shutil.copytree(building.ROOT / name, self.course / name)
        for folder in (self.home, self.temporary / "neighbour", self.course / "tests"):
            folder.mkdir(parents=True)
            (folder / "precious.txt").write_text("precious")
        for folder in (self.home, self.course / "solutions"):
            (folder / "precious.txt").write_text("precious")
        own = building.ROOT / "lib" / "botschool"
        self.watched = [base, own / "grading", own / "sandbox"]
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.visitors = 0
        threading.Thread(target=self._listen, daemon=True).start()
        self.segment, self.shared = shared_memory(b"precious")
        self.before = self.snapshot()

    def _listen(self) -> None:
        while True:
            self.listener.accept()[0].sendall(b"1.0")
            self.visitors += 1

    def close(self) -> None:
        """Removes what would outlive this process."""
        ctypes.CDLL(None).shmctl(self.segment, 0, None)

    def snapshot(self) -> dict[str, tuple]:
        found = {"shared memory": (ctypes.string_at(self.shared, 8),) if self.shared else ()}
        for top in self.watched:
            for path in [top, *top.rglob("*")]:
                if "__pycache__" in path.parts or "submissions" in path.parts:
                    continue
                if path.parent == self.temporary or path == self.temporary:
                    found[str(path)] = (path.lstat().st_mode,)
                    continue
                status = path.lstat()
                found[str(path)] = (status.st_mode, status.st_uid)
                if path.is_file():  # a folder changes when Python caches its modules there
                    digest = hashlib.md5(path.read_bytes()).hexdigest()
                    found[str(path)] += (status.st_mtime_ns, digest)
        return found

    def attack(self, number: int, kind: str) -> str:
        """What is added to a submission: the hostile function and what it attacks."""
        text = building.hostile()[kind]
        one = building.source(number)
        known = [
            str(building.ROOT / "solutions" / one.folder / one.file),
            *map(str, (building.ROOT / "exercises" / one.folder).glob("test_*.py")),
            str(self.course / "solutions" / one.folder / one.file),
            str(self.temporary / "neighbour" / "precious.txt"),
        ]
        names = {
            "COURSE": str(self.course), "HOME": str(self.home), "KNOWN": known,
            "TEMPORARY": str(self.temporary), "FRIEND": self.listener.getsockname(),
            "SEGMENT": self.segment,
        }  # fmt: skip
        return "\n".join(f"{name} = {value!r}" for name, value in names.items()) + f"\n\n{text}"


def shared_memory(content: bytes) -> tuple[int, int]:
    """(number, address) of a new System V segment that anybody may use; (-1, 0) without them."""
    libc = ctypes.CDLL(None)
    libc.shmat.restype = ctypes.c_void_p
    libc.shmat.argtypes = (ctypes.c_int, ctypes.c_void_p, ctypes.c_int)
    segment = libc.shmget(0, 4096, 0o1666)
    if segment < 0:
        return -1, 0
    address = libc.shmat(segment, None, 0)
    ctypes.memmove(address, content, len(content))
    return segment, address


@pytest.fixture(scope="module")
def trap(tmp_path_factory):
    with contextlib.closing(Trap(tmp_path_factory.mktemp("trap"))) as one:
        yield one


@pytest.fixture(scope="module")
def servers():
    """exercise -> fork server, shared by all tests."""
    with contextlib.ExitStack() as stack:
        yield {n: stack.enter_context(fork_server(building.exercise(n).imports)) for n in EXERCISES}


SECRET = "another secret of ours"


@pytest.fixture(scope="module")
def graders(servers):
    """The exercises, whose solutions have been graded once: some graders make files of their own
    then, and keep them (exercise 14 trains agents)."""
    found = {number: building.exercise(number) for number in EXERCISES}
    with pytest.MonkeyPatch.context() as patch, contextlib.ExitStack() as stack:
        patch.setenv("BOTSCHOOL_GRADING_SEED", SECRET)
        for number, exercise in found.items():
            exercise.ours = ours_of(exercise, servers[number])
            stack.callback(exercise.ours.close)
            one = building.source(number)
            file = building.ROOT / "solutions" / one.folder / one.file
            for task in exercise.tasks:
                result = grade_task(task, file, servers[number])
                assert result.points == task.max_points, result
        patch.undo()
        yield found


@pytest.fixture(scope="module")
def missing(graders, servers, tmp_path_factory):
    """What this system cannot confine."""
    probe = building.write(tmp_path_factory.mktemp("probe"), EXERCISES[0], "")
    task = graders[EXERCISES[0]].tasks[0]
    return grade_task(task, probe, servers[EXERCISES[0]]).missing


@pytest.fixture(autouse=True)
def confined(trap, missing, servers, monkeypatch, tmp_path_factory):
    """Only where the system confines submissions; afterwards nothing has changed."""
    if missing:
        pytest.skip(f"this system cannot confine a submission's {', '.join(missing)}")
    monkeypatch.setattr(tempfile, "tempdir", str(trap.temporary))
    monkeypatch.setenv("HOME", str(trap.home))
    # graders may draw, which leaves a cache of fonts
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path_factory.getbasetemp() / "matplotlib"))
    monkeypatch.setenv("BOTSCHOOL_GRADING_SEED", SECRET)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(trap.course))
    processes = psutil.Process().children(recursive=True)
    before = trap.snapshot()
    priority = os.getpriority(os.PRIO_PROCESS, 0), os.sched_getaffinity(0), os.sched_getscheduler(0)
    yield
    assert trap.snapshot() == before == trap.before
    assert priority == (
        os.getpriority(os.PRIO_PROCESS, 0), os.sched_getaffinity(0), os.sched_getscheduler(0)
    )  # fmt: skip
    assert psutil.Process().children(recursive=True) == processes
    assert not trap.visitors
    assert (
        not Path("/hostile_was_here.py").exists() and not Path("/etc/hostile_was_here.py").exists()
    )


def judged(task, file, server):
    """A task's result; that it is waited for in bounds, told safely, and tells nothing hidden."""
    allowances, ask = [], process.Child.ask

    def watched(child, request, allowance):
        allowances.append(allowance)
        return ask(child, request, allowance)

    start = time.process_time()
    with mock.patch.object(process.Child, "ask", watched):
        result = grade_task(dataclasses.replace(task, seconds=SECONDS), file, server)
    assert time.process_time() - start < PROCESSOR_SECONDS
    for allowance in allowances:  # and what passes until a busy machine looks
        assert allowance.processor <= SECONDS + 2
        assert allowance.active <= 2 * SECONDS + 2 + 2
    assert "LEAKED" not in result.printed
    assert all(c.isprintable() or c in "\n\t" for c in result.printed + result.message)
    (result.printed + result.message).encode()
    assert len(result.message) < 10_000
    assert all(name.endswith(".png") for name, _ in result.pictures)
    return result


@for_each_exercise
@pytest.mark.parametrize("kind", KINDS)
def test_earns_nothing(trap, graders, servers, tmp_path, kind, number):
    """In the place of every function that students write."""
    one = building.source(number)
    names = [name for functions in one.functions.values() for name in functions]
    replace = f"{' = '.join(names)} = hostile"
    text = building.inserted(one.skeleton, f"{trap.attack(number, kind)}\n\n{replace}")
    file = building.write(tmp_path / "submissions", number, text)
    slow = 0
    for task in graders[number].tasks:
        result = judged(task, file, servers[number])
        assert result.points == 0, f"{task.id}: {result}"
        assert result.message
        slow += "did not return within" in result.message
        if slow == 2:
            break


@for_each_exercise
@pytest.mark.parametrize("kind", KINDS)
def test_next_task_is_graded(trap, graders, servers, tmp_path, kind, number):
    """In a solution, in the place of one task's functions: another task keeps its points."""
    one, loaded = building.source(number), graders[number]
    alone = [
        task
        for task in loaded.tasks[1:]
        if one.functions.get(task.id) and not one.used_by_others & set(one.functions[task.id])
    ]
    names = one.functions[alone[0].id]
    text = building.inserted(
        one.solution, f"{trap.attack(number, kind)}\n\n{' = '.join(names)} = hostile"
    )
    file = building.write(tmp_path / "submissions", number, text)
    result = judged(alone[0], file, servers[number])
    assert result.points == 0, result
    assert grade_task(loaded.tasks[0], file, servers[number]).points == loaded.tasks[0].max_points


@pytest.mark.parametrize("kind", KINDS)
def test_while_the_file_is_loaded(trap, graders, servers, tmp_path, kind):
    one = building.source(EXERCISES[0])
    text = building.inserted(one.skeleton, f"{trap.attack(one.number, kind)}\n\nhostile()")
    file = building.write(tmp_path / "submissions", one.number, text)
    result = judged(graders[one.number].tasks[0], file, servers[one.number])
    assert result.points == 0, result


def no_confinement():
    """As on a kernel without Landlock and seccomp, for the process and its children."""
    libc = ctypes.CDLL(None)
    libc.prctl(38, 1, 0, 0, 0)
    absent = (0x06, 0, 0, 0x00050000 | 38)  # ENOSYS
    code = [(0x20, 0, 0, 0)]
    for number in (444, 445, 446, 317, 157):  # Landlock, seccomp, prctl
        code += [(0x15, 0, 1, number), absent]
    seccomp.install(libc, [*code, (0x06, 0, 0, 0x7FFF0000)])


@pytest.mark.skipif(platform.machine() != "x86_64", reason="numbers of x86-64")
@pytest.mark.parametrize(
    "kind",
    [
        "changes_modes",
        "reads_processes",
        "reads_solutions",
        "shares_memory",
        "truncates",
        "uses_the_network",
    ],
)
def test_attacks_are_real(tmp_path, kind):
    """Unconfined they do succeed (only those that harm nothing but the trap)."""
    with contextlib.closing(Trap(tmp_path / "trap")) as trap:
        succeeds(kind, trap, tmp_path)


def succeeds(kind, trap, tmp_path):
    """Grades the attack as on a system that cannot confine, and looks for what it has done."""
    number = 3
    one = building.source(number)
    names = [name for functions in one.functions.values() for name in functions]
    replace = f"{' = '.join(names)} = hostile"
    text = building.inserted(one.skeleton, f"{trap.attack(number, kind)}\n\n{replace}")
    file = building.write(tmp_path / "submissions", number, text)
    done = subprocess.run(
        [sys.executable, "-m", "botschool", "grade", f"{number}.2", "--submission", file.parent],
        env=os.environ | {"TMPDIR": str(trap.temporary), "BOTSCHOOL_COURSE": str(trap.course)},
        preexec_fn=no_confinement, capture_output=True, text=True,
    )  # fmt: skip
    assert "Notice:" in done.stdout, done.stderr
    changed = trap.snapshot() != trap.before
    stolen = " 0 of " not in done.stdout
    assert changed or trap.visitors or stolen or "LEAKED" in done.stdout, done.stdout


def test_there_are_enough():
    assert len(KINDS) >= 28


# --- A hostile file in the folder of a training.


def test_aliases_do_not_hold_up_whoever_reads_it(tmp_path):
    """A YAML file: lists of lists of lists that are all the same one."""
    lines = ["l0: &l0 [0, 0]"]
    lines += [f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 400)}]" for n in range(1, 8)]
    lines += [f"{field.name}: *l7" for field in dataclasses.fields(Settings)]
    (tmp_path / "config.yaml").write_text("\n".join(lines))
    start = time.process_time()
    with pytest.raises(BotschoolError, match="has an alias"):
        RunFolder(tmp_path).settings()
    assert time.process_time() - start < 10  # minutes without a limit


AGAIN = """
def master(table):
    import sys
    import botschool.analysis.tournament
    for name in [each for each in sys.modules if each.startswith("botschool")]:
        del sys.modules[name]
    from botschool.analysis.tournament import summarised
    mean, prey = summarised(table, 1)
    return {"predators": mean.mean, "prey": prey.mean}
"""


@pytest.mark.parametrize("again", [AGAIN, AGAIN.replace("del sys.modules[name]", "pass")])
def test_the_librarys_answer_is_refused_though_it_is_imported_again(tmp_path, again):
    loaded = building.exercise(15)
    file = building.write(tmp_path, 15, building.inserted(building.source(15).skeleton, again))
    with fork_server(loaded.imports) as server, contextlib.closing(ours_of(loaded, server)) as ours:
        loaded.ours = ours
        result = grade_task(loaded.find("15.3"), file, server)
    assert result.points == 0
    assert "write it yourself: botschool.analysis.tournament.summarised" in result.message
