"""Run the grading subcommands."""

from __future__ import annotations

import contextlib
import json
import os
import signal
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from rich.markup import escape

from botschool.console import Console
from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job
from botschool.grading.declare.checks import plain
from botschool.grading.declare.exercise import (
    Exercise,
    Task,
    course_root,
    exercise_numbers,
    folder_of,
    load_exercise,
    selected,
    submission_file,
    submission_place,
)
from botschool.grading.declare.state import secret_for_others
from botschool.grading.declare.trust import trust
from botschool.grading.judge.submission import Result, grade
from botschool.grading.report.progress import digest, remember
from botschool.grading.report.screen import Screen, Watched, counting, say_missing
from botschool.grading.run.confined import close_class
from botschool.grading.run.temporary import temporary_files_within
from botschool.terminal import exits_on_signals


@exits_on_signals()
@temporary_files_within()
def grade_command(what: str, submission: str | None, as_json: bool, debug: bool) -> bool:
    """Grade exercise "3", task "3.2" or exercises "1-3" and print reports; True for full marks."""
    asked = selected(what)
    if debug and (len(asked) > 1 or len(next(iter(asked.values()))) != 1):
        number = next(iter(asked))
        raise BotschoolError(
            f"--debug runs one task: name it, for example botschool grade {number}.1"
        )
    done = [_grade_one(n, tasks, submission, as_json, debug) for n, tasks in asked.items()]
    if as_json and not debug:
        shown = [found for _, found in done]
        print(json.dumps(shown[0] if len(shown) == 1 else shown, indent=1))
    return all(full for full, _ in done)


def _grade_one(
    number: int, tasks: tuple[str, ...], submission: str | None, as_json: bool, debug: bool
) -> tuple[bool, dict]:
    exercise = load_exercise(number)
    chosen = [exercise.find(task) for task in tasks] or None
    (file, shown, notes, _), kept = _found(exercise, submission, chosen or exercise.tasks)
    graded = digest(file)
    if debug:
        if submission is not None:
            _warn_of_unconfined(shown)
        from botschool.grading.report.explain import debug_task

        debug_task(exercise, tasks[0], file)
        return False, {}
    screen = Screen()
    report: Callable[[Any], None] = screen.task
    announce: Callable[[str], None] = screen.banner
    if as_json:
        report = announce = lambda shown: None
    else:
        screen.start(exercise.number, exercise.title, shown, notes)
    result = grade(exercise, file, report, chosen, announce=announce)
    if submission is None:
        remember(course_root(), number, _points(result), graded)
    if not as_json:
        screen.end(result, whole=not tasks)
        if kept:
            screen.console.print(f"[dim]{escape(kept)}[/]", soft_wrap=True)
    found = result.to_json() | ({"notes": list(notes)} if notes else {})
    return result.points == result.max_points, found


def _found(exercise: Exercise, submission: str | None, tasks: list[Task]) -> tuple[Watched, str]:
    """Return the file to grade, and a sentence on the secret for other people's work.

    Other people's work is located as grade-all does it, and the class folder is closed to it.
    """
    number, root = exercise.number, course_root()
    if submission is None:
        file = submission_file(number, None)
        exercise.require_some(tasks)
        return Watched(file, file, [], file.parent), ""
    from botschool.grading.classes.choice import find_one

    place = submission_place(submission, root)
    one = find_one(place, exercise, root, Path(tempfile.mkdtemp(prefix="botschool-")))
    exercise.require_some(tasks)
    choice = one.choices[number]
    origin = choice.origin.path
    saved = origin.parent if place.is_dir() and origin.is_relative_to(place) else place
    kept = _prepare_for_others(exercise, origin if origin.is_relative_to(place) else place)
    shown = place / choice.origin.shown if place.is_dir() else place
    return Watched(choice.file, shown, [*choice.notes, *one.notes], saved), kept


def _prepare_for_others(exercise: Exercise, file: Path) -> str:
    """Derive the seeds from a secret and close the class folder, to grade somebody else's work.

    Return a sentence on where the secret is.
    """
    exercise.secret, kept = secret_for_others(course_root())
    student = file.resolve() if file.is_dir() else file.resolve().parent
    for name in (folder_of(exercise.number).name, "exercises"):
        student = student.parent if student.name == name else student
    close_class(student, student.parent)
    return kept


def _warn_of_unconfined(file: Path) -> None:
    """Warn that somebody's file runs with the user's rights, unless it belongs to the course."""
    if not file.resolve().is_relative_to(course_root().resolve()):
        print(
            f"{plain(str(file))} runs without the sandbox, with all your rights (files, "
            "network): stop now with Ctrl-C if you have not read it. 'botschool grade' "
            "confines it.",
            file=sys.stderr,
            flush=True,
        )


@exits_on_signals()
@temporary_files_within()
def explain_command(what: str, submission: str | None) -> None:
    """Print all calls of a task with both answers."""
    from botschool.grading.report.explain import explain

    number, task = _named(what)
    if not task:
        raise BotschoolError(f"Name a task, for example botschool explain {number}.1")
    exercise = load_exercise(number)
    chosen = exercise.find(what)
    found, _ = _found(exercise, submission, [chosen])
    explain(exercise, chosen, found.file, Console(highlight=False))


def hint_command(what: str) -> None:
    """Print the hints of a task that were shown before, and the next one."""
    from rich.markdown import Markdown
    from rich.padding import Padding

    from botschool.grading.report.hints import next_hints

    number, task = _named(what)
    if not task:
        raise BotschoolError(
            f"A hint belongs to a task: name it, for example botschool hint {number}.1"
        )
    exercise = load_exercise(number)
    title = exercise.find(what).title
    hints, many, new = next_hints(what, course_root())
    console = Console(highlight=False)
    for index, hint in enumerate(hints, 1):
        latest = index == len(hints)
        console.print(
            f"Hint {index} of {many} for task {what}, {title}" if latest else f"Hint {index}",
            style="bold" if latest else "dim",
            markup=False,
        )
        console.print(Padding(Markdown(hint), (0, 0, 0, 3)), style="" if latest else "dim")
    if not new:
        console.print(f"[bold]There are no more hints for task {what}.[/]")
    elif len(hints) == many:
        console.print("[dim]This was the last one.[/]")
    else:
        console.print(f"[dim]One more: botschool hint {what}[/]")


@exits_on_signals()
def progress_command(again: bool, workers: int | None) -> None:
    """Print the table of all exercises with their last points; again: grade them now."""
    from botschool.grading.report.progress import stored_result, summary, table

    root = course_root()
    console = Console(highlight=False)
    graded = _grade_own(root, workers, console) if again else {}
    results = {number: stored_result(number, root) for number in exercise_numbers(root)}
    for number, result in graded.items():
        if result["problem"]:
            results[number]["problem"] = result["problem"]
    console.print(table(results))
    console.print(summary(results), soft_wrap=True)
    say_missing(console, list(graded.values()))


def _grade_own(root: Path, workers: int | None, console: Console) -> dict[int, dict]:
    """Grade the student's own files and store the results: exercise number -> result."""
    jobs = {}
    for number in exercise_numbers(root):
        with contextlib.suppress(BotschoolError):
            file = submission_file(number, None, root)
            jobs[Job(number, file)] = digest(file)
    with counting("Grading", console) as (start, step):
        start(len(jobs))
        found = Grades(root).of(jobs, workers or os.cpu_count() or 1, lambda job, result: step())
    for job, result in found.items():
        if not result["problem"] and isinstance(job.number, int):
            points = [(t["id"], t["points"], t["max_points"]) for t in result["tasks"]]
            remember(root, job.number, points, jobs[job])
    return {int(job.number): result for job, result in found.items()}


def _points(result: Result) -> list[tuple[str, int, int]]:
    return [(task.id, task.points, task.max_points) for task in result.tasks if task.graded]


@exits_on_signals()
@temporary_files_within()
def watch_command(what: str, submission: str | None) -> None:
    """Grade after every save, until Ctrl-C."""
    from botschool.grading.report.screen import watch

    number, task = _named(what)
    exercise = load_exercise(number)
    tasks = [exercise.find(what)] if task else exercise.tasks
    asked = False

    class Remembering(Screen):
        def end(self, result: Result, whole: bool = True) -> None:
            if submission is None:
                file = submission_file(number, None)
                remember(course_root(), number, _points(result), digest(file))
            super().end(result, whole)

    def stop(number: int, frame: object) -> None:
        nonlocal asked
        asked = True
        raise KeyboardInterrupt

    def wait(seconds: float) -> None:
        if asked:  # Python drops an exception raised in a destructor
            raise KeyboardInterrupt
        time.sleep(seconds)

    def find() -> Watched:
        return _found(exercise, submission, tasks)[0]

    before = signal.signal(signal.SIGINT, stop)
    try:
        watch(exercise, find, tasks, Remembering(), wait)
    except KeyboardInterrupt:
        print()
    finally:
        signal.signal(signal.SIGINT, before)


def start_command(what: str, notebook: bool, opens: bool = True) -> None:
    """Print what an exercise is, where its files are and what to do; make a missing file.

    notebook: whether to open it as a notebook, until Ctrl-C. opens: whether to open its page.
    """
    from botschool.grading.copies.starting import install, open_notebook, start
    from botschool.grading.report.showing import lead_to_page

    number, root = _named(what)[0], course_root()
    exercise = load_exercise(number, root)
    file, made = start(number, root)
    console = Console(highlight=False, soft_wrap=True)
    console.print(f"[bold]Exercise {number}. {exercise.title}[/]: {len(exercise.tasks)} tasks")
    for does, path in (("Read", file.parent / "README.md"), ("Write into", file)):
        console.print(f"  {does:<11}{os.path.relpath(path)}", markup=False)
    if made:
        console.print("  (it was missing; botschool has made it)")
    lead_to_page(number, root, console, opens and not notebook)
    console.print(f"  {'Grade':<11}botschool grade {number}, or botschool watch {number}")
    console.print(f"  {'A hint':<11}botschool hint {number}.1")
    console.print(f"  {'A notebook':<11}botschool start {number} --notebook opens your file as one")
    install([*exercise.extras, *(["notebook"] if notebook else [])], root)
    exercise.require_some(exercise.tasks)
    if notebook:
        open_notebook(number, file, root)


def reset_command(what: str) -> None:
    """Put a student's file back to its beginning and keep the old one."""
    from botschool.grading.copies.starting import reset

    file, kept = reset(_named(what)[0], course_root())
    name = os.path.relpath(file)
    if kept is None:
        print(f"{name} is back at its beginning.")
    else:
        print(f"{name} is back at its beginning; your version is kept as {os.path.relpath(kept)}.")


@exits_on_signals()
@temporary_files_within()
def show_command(what: str, submission: str | None, opens: bool) -> int:
    """Show a finished exercise, what is done of one, or a task; open it.

    Return the number of a finished exercise, else 0.
    """
    from botschool.grading.report.progress import answers
    from botschool.grading.report.showing import (
        lead_to_page,
        open_page,
        show_done,
        show_one,
        show_whole,
        unfinished,
    )

    (number, task), root = _named(what), course_root().resolve()
    exercise = load_exercise(number)
    chosen = [exercise.find(what)] if task else exercise.tasks
    if submission is None:
        file = submission_file(number, None)
    else:
        found, _ = _found(exercise, submission, chosen)
        file = found.file
        for note in found.notes:
            print(note)
    whole = not task and not unfinished(file)
    if task:
        page: Path | None = show_one(exercise, chosen[0], file, root)
    elif not whole:
        page = show_done(exercise, file, root)
    else:
        if submission is not None:
            _warn_of_unconfined(found.shown)
        page = show_whole(exercise, file, root)
    if not task:
        lead_to_page(number, root, Console(highlight=False, soft_wrap=True), False)
    if page:
        opened = opens and open_page(page)
        where = "the picture" if task else "all on one page"
        print(f"{'opened' if opened else where}: {os.path.relpath(page)}")
    with contextlib.suppress(BotschoolError):
        if whole and answers(number, root):
            print(f"our answers to the questions: botschool show {number} --answers")
    return number if whole else 0


def answers_command(what: str) -> None:
    """Print what the solution measured, after full marks."""
    from rich.markdown import Markdown

    from botschool.grading.report.progress import answers

    text = answers(_named(what)[0], course_root())
    Console(highlight=False).print(Markdown(text))


def trust_command(folder: Path) -> None:
    """Remember that the user trusts a course. Raises BotschoolError if the folder holds none."""
    if not (folder / "exercises").is_dir():
        raise BotschoolError(f"{folder} holds no exercises/: name a course's folder.")
    trust(folder)
    print(f"{folder.resolve()}: botschool now runs this course's graders.")


def _named(what: str) -> tuple[int, str]:
    """Return "3.2" as (3, "2") and "3" as (3, ""). Raises BotschoolError."""
    number, dot, task = what.partition(".")
    good = [part.isascii() and part.isdigit() and len(part) < 4 for part in (number, task)]
    if not good[0] or (dot and not good[1]):
        raise BotschoolError(
            f"'{what[:30]}' names no exercise: give its number, for example 3, or a task, "
            "for example 3.2."
        )
    return int(number), task
