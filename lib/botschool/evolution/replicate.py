"""Run one experiment with consecutive seeds, one after another or in parallel."""

from __future__ import annotations

import multiprocessing
import os
import queue
import threading
import traceback
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from dataclasses import dataclass, replace
from multiprocessing import resource_tracker
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from botschool.config import Experiment
from botschool.errors import BotschoolError
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.progress import messages, print_lines, reporting
from botschool.evolution.record import RunFiles, claimed
from botschool.evolution.run import Options, Run
from botschool.terminal import progress_bars, stoppable, unheard

# --- Parallel runs of one experiment, each in a process of its own.  With two workers, a run of a
# native problem waits in every generation for both, and for numpy. Two parallel runs with one
# worker each do not wait. The files are the same.


STOP = "stop"


@dataclass(frozen=True)
class Task:
    """The common part of all runs."""

    kind: type[Run]
    experiment: Experiment
    folder: Path
    options: Options
    """How to run each of them."""

    def run(self, seed: int, stopping: Callable[[], bool], report: Callable[[Run], None]):
        """Evolve; return whether it is finished and a sentence about it, "" if it has not begun."""
        run = self.kind(self.experiment, seed, self.options.workers, stopping)
        done = self.options.evolve(run, self.folder, report)
        return done, run.ending(RunFiles(self.folder, seed), done)


def evolve_all(task: Task, seeds: list[int], processes: int, stopping: Callable[[], bool]) -> bool:
    """Run every seed, in this many processes; return whether all finished.

    When the user stops them or one fails, all stop and save; then the failure is raised.
    """
    with ExitStack() as stack:
        bars = stack.enter_context(progress_bars()) if task.options.terminal else None
        crew = Crew([stack.enter_context(Process(task)) for _ in range(processes)], seeds)
        try:
            while crew.running:
                for seed, message in crew.messages():
                    if isinstance(message, Ended):
                        if message.text:
                            bars.finish(seed, message.text) if bars else print_lines([message.text])
                    else:
                        bars.show(seed, *message) if bars else print_lines(message)
                if stopping():
                    crew.stop()
        except BaseException:  # perhaps standard output is gone
            crew.stop()
            while crew.running:
                list(crew.messages())
            raise
    if crew.failure:
        raise crew.failure
    return crew.finished == len(seeds)


class Crew:
    """Processes that evolve, each with the seed assigned to it."""

    def __init__(self, processes: list[Connection], seeds: list[int]) -> None:
        self._todo = list(seeds)
        self._stopped = False
        self.running: dict[Connection, int] = {}
        """The processes that evolve, and their seeds."""
        self.finished = 0
        self.failure: Exception | None = None
        """The failure of the first run that failed; it stops all others."""
        for connection in processes:
            self._give(connection)

    def _give(self, connection: Connection) -> None:
        """Give a process its next seed, if there is one."""
        self.running.pop(connection, None)
        if self._todo and not self._stopped:
            self.running[connection] = self._todo.pop(0)
            _tell(connection, self.running[connection])

    def stop(self) -> None:
        """Ask all runs to save and stop."""
        if not self._stopped:
            self._stopped = True
            for connection in self.running:
                _tell(connection, STOP)

    def messages(self) -> Iterator[tuple[int, Any]]:
        """Yield what arrives within 0.2 seconds: seeds, each with its message or its end."""
        ready: list[Any] = wait(list(self.running), timeout=0.2)
        for connection in ready:
            seed = self.running[connection]
            message = _received(connection, seed)
            if isinstance(message, Exception):
                self.failure = self.failure or message
                self.stop()
                self._give(connection)
                continue
            if isinstance(message, Ended):
                self.finished += message.finished
                self._give(connection)
            yield seed, message


@dataclass(frozen=True)
class Ended:
    """The end of a run."""

    finished: bool
    text: str


def _received(connection: Connection, seed: int) -> Any:
    """Return the next message about a run; an exception if it has failed."""
    try:
        return connection.recv()
    except (EOFError, OSError):
        return BotschoolError(
            f"The process of seed {seed} ended unexpectedly: if memory is short, use fewer "
            "workers (-w), and add --resume to continue."
        )


def _tell(connection: Connection, message: Any) -> None:
    with suppress(OSError):  # `_received` reports a process that has ended
        connection.send(message)


class Process:
    """Context of a process that evolves the seeds that it gets by its connection."""

    def __init__(self, task: Task) -> None:
        context = multiprocessing.get_context("spawn")
        self._connection, other = context.Pipe()
        self._process = context.Process(target=_work, args=(task, other), daemon=True)
        if os.name == "posix":
            resource_tracker.ensure_running()  # it would unblock these signals again
        with unheard():  # only this process stops runs
            self._process.start()
        other.close()

    def __enter__(self) -> Connection:
        return self._connection

    def __exit__(self, *error: object) -> None:
        self._connection.close()  # ends the process
        self._process.join()


def _work(task: Task, connection: Connection) -> None:
    """Evolve seeds until the connection is closed."""
    seeds: queue.SimpleQueue[int] = queue.SimpleQueue()
    stop = threading.Event()

    def listen() -> None:
        try:
            while (message := connection.recv()) != STOP:
                seeds.put(message)
            stop.set()
            connection.recv()
        except (EOFError, OSError):
            os._exit(0)

    threading.Thread(target=listen, daemon=True).start()
    while True:
        seed = seeds.get()
        try:
            with messages(task.options.terminal, connection.send) as report:
                ended = Ended(*task.run(seed, stop.is_set, report))
        except (BotschoolError, MemoryError, OSError) as error:
            connection.send(error)
        except Exception:
            traceback.print_exc()
            os._exit(1)
        else:
            connection.send(ended)


# --- Several runs of one experiment, with consecutive seeds.


def replicate(experiment: Experiment, seeds: list[int], folder: Path, options: Options) -> bool:
    """Run every seed and print where the results are; return False when the user stopped it.

    Several runs of a native problem share the workers: they run side by side, each on as many
    workers as there are for it. Everything else runs one after another, each on all workers; so
    do all runs on a cluster.
    """
    kind = Coevolution if experiment.competitive else Run
    if options.keep_every and kind is Coevolution:
        raise BotschoolError(
            "--keep-every is for one population: the files of a co-evolution keep populations "
            "every saveeach generations, so set that."
        )
    with stoppable() as stopping, ExitStack() as stack:
        problem = None
        if options.cluster:
            problem = stack.enter_context(options.cluster.problem(experiment, _say))
        runs = [kind(experiment, seed, options.workers, stopping, problem) for seed in seeds[:1]]
        stack.enter_context(claimed(folder, seeds, options.resume, options.force))
        processes = min(options.workers, len(seeds))
        if processes > 1 and runs[0].problem.native and not problem:
            share = replace(options, workers=options.workers // processes)
            return evolve_all(Task(kind, experiment, folder, share), seeds, processes, stopping)
        finished = True
        for seed in seeds:
            run = runs.pop() if runs else kind(experiment, seed, options.workers, stopping, problem)
            with reporting(seed, options.terminal) as report:
                finished = options.evolve(run, folder, report)
            if text := run.ending(RunFiles(folder, seed), finished):
                print_lines([text])
            if not finished:
                break
        if problem and (lines := problem.report()):
            print_lines(lines)
    return finished


def _say(sentence: str) -> None:
    print_lines([sentence])
