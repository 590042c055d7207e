"""Show a learner the grading on the screen, and grade again after every save."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from shlex import quote
from typing import NamedTuple

from rich.markup import escape
from rich.padding import Padding

from botschool.console import Console
from botschool.errors import BotschoolError, listed
from botschool.grading.declare.exercise import Exercise
from botschool.grading.judge.submission import Result, TaskResult, grade
from botschool.grading.run.confined import fork_server
from botschool.sandbox import ForkServer

MAX_MESSAGE_LINES = 12
"""Lines to show of a task's message."""
MAX_OUTPUT_LINES = 8
"""Lines to show of what a task's code printed."""


class Screen:
    """Print each task once it is judged, then the points and the next step."""

    def __init__(self, console: Console | None = None) -> None:
        self.console = console or Console(highlight=False)
        self._file = Path()

    def start(self, number: int, title: str, file: Path, notes: Sequence[str] = ()) -> None:
        """Print the heading; notes: sentences on how the file was found."""
        file = file.resolve()
        self._file = file.relative_to(Path.cwd()) if file.is_relative_to(Path.cwd()) else file
        self.console.print(f"[bold]Exercise {number}. {escape(title)}[/]")
        self.console.print(f"[dim]{escape(str(self._file))}[/]", soft_wrap=True)
        for note in notes:
            self.console.print(f"[yellow]{escape(note)}[/]", soft_wrap=True)

    def banner(self, text: str) -> None:
        """Print what must be mended before anything else."""
        first, *others = text.splitlines()
        self.console.print(f"[bold red]{escape(first)}[/]")
        for line in others:
            self.console.print(Padding(escape(line), (0, 0, 0, 1)))

    def task(self, result: TaskResult) -> None:
        """Print one task: its points, and why some are missing."""
        mark = {True: "[green]✓[/]", False: "[red]✗[/]"}[result.points == result.max_points]
        if result.undone and result.points == 0:
            mark = "[dim]·[/]"
        points = f"{result.points:>3} of {result.max_points}"
        if not result.graded:
            mark, points = "[dim]–[/]", f"  – of {result.max_points}"
        self.console.print(f" {mark} {result.id:<5} {escape(result.title):<44} {points}")
        result.complete()
        if result.message:
            self._indented(result.message.splitlines(), MAX_MESSAGE_LINES, "")
        if result.printed.strip():
            printed = f"printed: {result.printed.strip()}"
            self._indented(printed.splitlines(), MAX_OUTPUT_LINES, "dim")

    def end(self, result: Result, whole: bool = True) -> None:
        """Print the points, the next step, and what this system could not confine.

        whole: whether these are all tasks of the exercise.
        """
        if result.missing:
            self.console.print(f"[yellow]{notice(result.missing)}[/]")
        left = sum(task.max_points for task in result.tasks if not task.graded)
        said = f" ({left} of them could not be graded on this machine)" if left else ""
        self.console.print(f"[bold]{result.points} of {result.max_points} points[/]{said}")
        missing = [task for task in result.tasks if task.points < task.max_points and task.graded]
        if left and not missing:
            return
        if not missing and not whole:
            self.console.print(
                f"[green]Task {result.tasks[-1].id} done![/] All tasks: "
                f"botschool grade {result.exercise}"
            )
            return
        if not missing:
            own = "exercises" in self._file.parts
            run = f"botschool show {result.exercise}" if own else f"python {quote(str(self._file))}"
            self.console.print(
                f"[green]All done![/] See what you have made: {escape(run)}", soft_wrap=True
            )
            return
        task = missing[0]
        done = not task.undone
        calls = f"All its calls: botschool explain {task.id}   " if task.compared and done else ""
        if task.pictured and done:
            calls += f"A picture: botschool show {task.id}   "
        self.console.print(
            f"Next: task {task.id}. After a change: botschool grade {task.id}   {calls}"
            f"A hint: botschool hint {task.id}",
            soft_wrap=True,
        )

    def _indented(self, lines: list[str], longest: int, style: str) -> None:
        if len(lines) > longest:
            lines = [*lines[:longest], f"... and {len(lines) - longest} more lines"]
        for line in lines:
            self.console.print(Padding(escape(line), (0, 0, 0, 9)), style=style)


@contextmanager
def counting(
    what: str, console: Console
) -> Iterator[tuple[Callable[[int], None], Callable[[], None]]]:
    """Show a progress bar on a terminal within the block; yield start(count) and step()."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TimeRemainingColumn

    columns = (f"{what}", BarColumn(), MofNCompleteColumn(), TimeRemainingColumn())
    hidden = not console.is_terminal
    with Progress(*columns, console=console, transient=True, disable=hidden) as bar:
        task = bar.add_task(what, total=None)
        yield (lambda count: bar.update(task, total=count)), (lambda: bar.advance(task))


def say_missing(console: Console, results: list[dict]) -> None:
    """Print what the system could not confine during these gradings, if anything."""
    missing = list(dict.fromkeys(each for result in results for each in result["missing"]))
    if missing:
        console.print(f"[yellow]{notice(missing)}[/]")


def notice(missing: list[str]) -> str:
    """Return a sentence on what this system cannot confine; "" if it can confine everything."""
    if not missing:
        return ""
    return (
        f"Notice: this system cannot confine a submission's {listed(missing)}; grade only "
        "files that you trust here."
    )


POLL_SECONDS = 0.3
"""Seconds between two checks whether the student has saved."""


class Saved(Exception):
    """The student saved the file while it was being graded."""


def stamp(place: Path) -> tuple:
    """Return a value that changes when a file, or a script or notebook in a folder, is saved."""
    found = []
    for path in sorted([*place.glob("*.py"), *place.glob("*.ipynb")]) or [place]:
        try:
            status = path.stat()
            found.append((path.name, status.st_mtime_ns, status.st_size))
        except OSError:  # an editor replaces the file
            continue
    return tuple(found)


class Watched(NamedTuple):
    """What `watch` grades after every save."""

    file: Path
    shown: Path
    """Its name on the screen."""
    notes: Sequence[str]
    """Sentences on how it was found."""
    place: Path
    """The file or folder to watch for saves."""


def watch(
    exercise: Exercise,
    find: Callable[[], Watched],
    tasks: list,
    screen: Screen,
    wait: Callable[[float], None] = time.sleep,
) -> None:
    """Grade now and after every save, for ever; call `wait` between two checks.

    A file that goes away for a while, as editors and git let it, is waited for.
    """
    found = find()
    with fork_server(exercise.imports) as server:
        while True:
            seen = stamp(found.place)
            try:
                found = find()
                _once(exercise, found, tasks, screen, seen, server)
            except Saved:
                continue
            except (BotschoolError, OSError):
                if found.file.is_file():
                    raise
                wait(POLL_SECONDS)
                continue
            screen.console.print("[dim]Waiting for the next save; Ctrl-C ends.[/]")
            while stamp(found.place) == seen or not found.place.exists():
                wait(POLL_SECONDS)


def _once(
    exercise: Exercise,
    found: Watched,
    tasks: list,
    screen: Screen,
    seen: tuple,
    server: ForkServer,
) -> None:
    screen.console.clear()
    screen.start(exercise.number, exercise.title, found.shown, found.notes)

    def report(result: TaskResult) -> None:
        if stamp(found.place) != seen:
            raise Saved
        screen.task(result)

    result = grade(exercise, found.file, report, tasks, server, announce=screen.banner)
    screen.end(result, whole=len(tasks) == len(exercise.tasks))
