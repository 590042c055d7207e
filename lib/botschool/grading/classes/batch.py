"""Grade many submissions, each in a process of its own, and cache results by content.

A submission that crashes or blocks its grader's process harms no other one. A submission is graded
again only if it, the grader or botschool has changed.
"""

from __future__ import annotations

import base64
import contextlib
import functools
import hashlib
import json
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import ThreadPoolExecutor, as_completed
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.declare import weights
from botschool.grading.declare.checks import Wrong
from botschool.grading.declare.exercise import Exercise, Number, folder_of, load_exercise
from botschool.grading.declare.state import DEFAULT, STATE, VARIABLE, given_secret, make_state
from botschool.grading.judge.submission import SYNTAX, Result, TaskResult, grade
from botschool.grading.run.confined import MachineFault, Unread, content_digest, machine_fault
from botschool.grading.run.temporary import temporary_folder
from botschool.output import save_bytes
from botschool.sandbox.paths import IMPORT_ROOT
from botschool.sandbox.scratch import remove_tree
from botschool.sandbox.server import interpreter

MAX_KEPT = 5000
"""Results in the cache; it drops those that were not asked for longest."""
SPARE_SECONDS = 60
WALL_FACTOR = 5
"""A grader's process may take this many times the limits of its tasks, plus 5 seconds for each task
and SPARE_SECONDS, in the time that passes, with other programs running.
"""
RECORDED = ("id", "title", "points", "max_points", "message", "printed", "graded")
"""What is kept of each task's result."""
MACHINE_FAULT = 75
"""Exit code of a grader's process, as EX_TEMPFAIL of sysexits.h."""


@dataclass(frozen=True)
class Job:
    """A submission's file of an exercise."""

    number: Number
    file: Path
    tasks: tuple[str, ...] = ()
    """Tasks to grade; () for all."""


class Grades:
    """Grade submissions of the course in a folder, and cache their results.

    A result is a dict: exercise, title, points, max_points, tasks (with what they printed),
    pictures ([name, base64]), missing, problem (why there are no points; ""), and graded: False if
    the grader or its machine failed, so that the 0 points mean nothing.
    """

    def __init__(
        self,
        root: Path,
        fresh: bool = False,
        secret: str | None = None,
        laboratories: Mapping[Number, Exercise] = MappingProxyType({}),
    ) -> None:
        """Prepare grading.

        fresh: whether to grade again what the cache holds. secret: None for
        BOTSCHOOL_GRADING_SEED's.
        laboratories: graded like exercises, by a program of their own.
        """
        self._root = root
        self._fresh = fresh
        self._secret = secret or given_secret() or DEFAULT
        self._cache = root / STATE / "grades"
        self._exercises: dict[Number, Exercise] = dict(laboratories)
        self._running: set[subprocess.Popen] = set()
        self._temporary: Path | None = None
        self._stopped = threading.Event()

    def exercise(self, number: Number) -> Exercise:
        """Return the exercise as its grader declares it."""
        if number not in self._exercises:
            assert isinstance(number, int)
            self._exercises[number] = load_exercise(number, self._root)
        return self._exercises[number]

    def of(
        self,
        jobs: Iterable[Job],
        workers: int,
        report: Callable[[Job, dict], None] = lambda job, result: None,
    ) -> dict[Job, dict[str, Any]]:
        """Return the results of all jobs; report each as soon as it is there.

        After a fault of the machine (MachineFault, a grader that was killed or took too long), the
        job runs again at the end, while no other job runs.
        """
        results, again = {}, []
        with temporary_folder() as self._temporary, ThreadPoolExecutor(workers) as pool:
            try:
                futures = {pool.submit(self._result, job): job for job in dict.fromkeys(jobs)}
                for future in as_completed(futures):
                    job, result = futures[future], future.result()
                    if result is None:
                        again.append(job)
                    else:
                        results[job] = result
                        report(job, result)
                for job in again:
                    results[job] = pool.submit(self._result, job, alone=True).result()
                    report(job, results[job])
            except BaseException:
                self._stopped.set()
                for process in list(self._running):
                    process.kill()
                pool.shutdown(cancel_futures=True)
                raise
        self._forget()
        return results

    def _forget(self) -> None:
        with contextlib.suppress(OSError):
            kept = sorted(self._cache.glob("*.json"), key=lambda path: -path.stat().st_mtime_ns)
            for path in kept[MAX_KEPT:]:
                path.unlink()

    def _result(self, job: Job, alone: bool = False) -> dict[str, Any] | None:
        """Return a job's result; None if it must run again, alone."""
        try:
            key = self._key(job)
        except Wrong as error:
            return self.nothing(job, str(error), not isinstance(error, Unread))
        except OSError as error:
            return self.nothing(job, f"Cannot read a file ({error.strerror}).")
        except Exception as error:
            return self.nothing(job, f"Cannot read the files ({type(error).__name__}: {error}).")
        place = self._cache / f"{key}.json"
        if not self._fresh:
            with contextlib.suppress(OSError):
                digest, _, content = place.read_bytes().partition(b"\n")
                if digest == _digest(content):
                    place.touch()
                    return json.loads(content)
        result = self._grade(job, alone)
        if result is None:
            return None
        if not result["problem"] and not self._stopped.is_set():
            with contextlib.suppress(OSError, BotschoolError):
                make_state(self._root)
                self._cache.mkdir(exist_ok=True)
                content = json.dumps(result).encode()
                save_bytes(place, _digest(content) + b"\n" + content)
        return result

    def _grade(self, job: Job, alone: bool) -> dict[str, Any] | None:
        exercise = self.exercise(job.number)
        try:
            exercise.require([*map(exercise.find, job.tasks)] or exercise.tasks)
        except BotschoolError as error:
            return self.nothing(job, str(error))
        times = [1 + bool(task.needs) for task in exercise.tasks]  # as often as it may be run
        seconds = [n * (task.seconds + 5) for n, task in zip(times, exercise.tasks, strict=True)]
        limit = WALL_FACTOR * sum(seconds) + SPARE_SECONDS
        temporary = Path(tempfile.mkdtemp(prefix="botschool-", dir=self._temporary))
        lifeline, ours = os.pipe()
        kind, tasks = "alone" if alone else "", ",".join(job.tasks)
        arguments = str(job.number), str(job.file), str(lifeline), kind, tasks
        environment = os.environ | {
            "TMPDIR": str(temporary),
            "BOTSCHOOL_COURSE": str(self._root),
            VARIABLE: self._secret,
        }
        try:
            process = subprocess.Popen(
                interpreter(exercise.program, *arguments),
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                pass_fds=(lifeline,),
                start_new_session=True,
            )
            self._running.add(process)
            if self._stopped.is_set():
                process.kill()
            try:
                out, errors = process.communicate(timeout=limit)
            except subprocess.TimeoutExpired:
                process.kill()
                process.communicate()
                reason = f"The grading took longer than {limit:.0f} seconds."
                return self.nothing(job, reason) if alone else None
            finally:
                self._running.discard(process)
            if process.returncode == 0:
                with contextlib.suppress(ValueError, TypeError, RecursionError):
                    return self.nothing(job, "") | {"graded": True} | json.loads(out)
                return self.nothing(job, "The grader's result is damaged.")
            if not alone and (process.returncode == MACHINE_FAULT or process.returncode < 0):
                return None
            lines = errors.decode(errors="replace").strip().splitlines()
            reason = lines[-1] if lines else f"exit code {process.returncode}"
            if process.returncode == MACHINE_FAULT:
                return self.nothing(job, reason)
            return self.nothing(job, f"The grader failed: {reason}.")
        finally:
            os.close(lifeline)
            os.close(ours)
            remove_tree(temporary)

    def nothing(self, job: Job, problem: str, graded: bool = False) -> dict[str, Any]:
        """Return a result without points.

        graded: whether the submission deserves no points; otherwise it was not graded.
        """
        exercise = self.exercise(job.number)
        asked = [task for task in exercise.tasks if not job.tasks or task.id in job.tasks]
        results = [TaskResult(task.id, task.title, 0, task.max_points, "") for task in asked]
        told = to_record(Result(exercise.number, exercise.title, results))
        return told | {"exercise": job.number, "problem": problem, "graded": graded}

    def _key(self, job: Job) -> str:
        digest = content_digest(job.file)
        digest.update(f"{self._secret}\n{_versions(self._root, job.number)}\n".encode())
        rule = f"{os.environ.get(SYNTAX, '')} {os.environ.get(weights.VARIABLE, '')}".strip()
        digest.update(f"{job.file.name} {job.tasks} {rule}".encode(errors="surrogateescape"))
        return digest.hexdigest()


def _digest(content: bytes) -> bytes:
    """Return the first line of a file in the cache, by which a damaged one is graded again."""
    return hashlib.sha256(content).hexdigest().encode()


def remarks(result: dict[str, Any]) -> list[str]:
    """Return the sentences on a whole result: notes, why there are no points, what is broken."""
    return [*result["notes"], *filter(None, [result["problem"], result["banner"]])]


def to_record(result: Result) -> dict[str, Any]:
    """Return a result as plain data, without repeated pictures."""
    tasks = [{name: getattr(task, name) for name in RECORDED} for task in result.tasks]
    pictures: dict[bytes, str] = {}
    for task in result.tasks:
        for name, content in task.pictures:
            pictures.setdefault(content, name)
    return {
        "exercise": result.exercise,
        "title": result.title,
        "points": result.points,
        "max_points": result.max_points,
        "tasks": tasks,
        "pictures": [[name, base64.b64encode(c).decode()] for c, name in pictures.items()],
        "missing": result.missing,
        "problem": "",
        "banner": result.banner,
        "graded": True,
    }


@functools.lru_cache(maxsize=64)
def _versions(root: Path, number: Number) -> str:
    """Return what a result depends on beside the submission."""
    stamps = [sys.version, str(number)]
    own: list[Path] = []
    if isinstance(number, int):
        folder = folder_of(number, root)
        own += sorted(folder.glob("test_*.py"))
        own += sorted((root / "solutions" / folder.name).glob("*.*"))
    library = sorted((IMPORT_ROOT / "botschool").rglob("*"))
    for path in (*(path for path in library if path.suffix in (".py", ".so", ".pyd")), *own):
        status = path.stat() if path.exists() else None
        stamps.append(f"{path} {status and (status.st_size, status.st_mtime_ns)}")
    return "\n".join(stamps)


def main() -> None:
    """Grade as `serve` says."""
    serve(_of_exercise)


def _of_exercise(number: str, file: Path, tasks: list[str], alone: bool) -> dict[str, Any]:
    exercise = load_exercise(int(number))
    found = [exercise.find(task) for task in tasks] or None
    return to_record(grade(exercise, file, tasks=found, alone=alone))


def serve(grade: Callable[[str, Path, list[str], bool], dict[str, Any]]) -> None:
    """Grade a file (argument 2) of an exercise (argument 1); write the result to stdout as JSON.

    Argument 3: a pipe's descriptor; the grading ends when its other end closes.
    Argument 4: "alone" if no other grading runs meanwhile. Argument 5: the tasks to grade, with
    commas between; "" for all.
    The exit code is MACHINE_FAULT after a fault of the machine.
    """
    number, file, lifeline = sys.argv[1], Path(sys.argv[2]), int(sys.argv[3])
    threading.Thread(target=_end_with, args=(lifeline,), daemon=True).start()
    out = os.dup(1)
    os.dup2(2, 1)  # whatever a grader prints is no part of the result
    try:
        tasks = list(filter(None, sys.argv[5].split(",")))
        record = grade(number, file, tasks, sys.argv[4] == "alone")
    except MachineFault as error:
        print(error, file=sys.stderr)
        sys.exit(MACHINE_FAULT)
    except (MemoryError, OSError) as error:
        fault = machine_fault(error)
        print(fault, file=sys.stderr)
        sys.exit(MACHINE_FAULT if isinstance(fault, MachineFault) else 1)
    except BotschoolError as error:
        sys.exit(str(error))
    with open(out, "w", encoding="ascii") as stream:
        json.dump(record, stream)


def _end_with(pipe: int) -> None:
    """End this process, and so its fork server and children, when a pipe closes."""
    os.read(pipe, 1)
    os._exit(1)
