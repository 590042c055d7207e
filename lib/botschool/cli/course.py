"""Define the course's subcommands: first those for students, then those for instructors."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()
LAB = "lab"
"""Begins the name of a laboratory, as in lab9."""

Submission = Annotated[
    str | None,
    typer.Option(
        help="Use another folder, zip file or file; `solutions` is the reference.",
        metavar="FOLDER",
    ),
]
GradingWorkers = Annotated[
    int | None,
    typer.Option(
        "-w",
        "--workers",
        min=1,
        max=1024,
        help="Number of submissions graded at the same time.",
        show_default="all cores",
    ),
]


Number = Annotated[str, typer.Argument(help="Exercise N.", metavar="N")]


@app.command(epilog="Example: botschool start 3")
def start(
    exercise: Number,
    notebook: Annotated[
        bool, typer.Option("--notebook", help="Also open your file as a notebook.")
    ] = False,
    opens: Annotated[
        bool,
        typer.Option(
            "--open/--no-open",
            help="Open the exercise's page with figures in your browser, if there is a display.",
        ),
    ] = True,
    name: Annotated[str | None, typer.Option(help="Of a laboratory (labN): your name.")] = None,
) -> None:
    """Print what to read, where to write and which command comes next; open the page."""
    from botschool.grading.commands import start_command
    from botschool.labs import commands as labs

    if exercise.startswith(LAB):
        labs.start_command(exercise, name)
    else:
        start_command(exercise, notebook, opens)


@app.command(epilog="Example: botschool reset 3")
def reset(exercise: Number) -> None:
    """Put your file back to its beginning; your version is kept beside it."""
    from botschool.grading.commands import reset_command

    reset_command(exercise)


@app.command(epilog="Example: botschool grade 3, or botschool grade 3.2 for one task")
def grade(
    what: Annotated[
        str, typer.Argument(help="Exercise N, task N.T, or several: 1-3,7.", metavar="N[.T]")
    ],
    submission: Submission = None,
    json: Annotated[bool, typer.Option("--json", help="Print the result as JSON.")] = False,
    debug: Annotated[
        bool,
        typer.Option(
            help="Run one task in this process, without points, so that breakpoints work."
        ),
    ] = False,
) -> None:
    """Grade your solution of an exercise, of one task, or a laboratory (labN)."""
    from botschool.grading.commands import grade_command
    from botschool.labs import commands as labs

    if what.startswith(LAB):
        full = labs.check_command(what, json, submission and Path(submission))
    else:
        full = grade_command(what, submission, json, debug)
    if not full:
        raise typer.Exit(1)


@app.command(epilog="Example: botschool explain 3.2")
def explain(
    task: Annotated[str, typer.Argument(help="Task N.T.", metavar="N.T")],
    submission: Submission = None,
) -> None:
    """Show all calls of a task, what your code returned and what was expected."""
    from botschool.grading.commands import explain_command

    explain_command(task, submission)


@app.command(epilog="Example: botschool hint 3.2")
def hint(
    task: Annotated[str, typer.Argument(help="Task N.T.", metavar="N.T")],
) -> None:
    """Show one more hint for a task with each call."""
    from botschool.grading.commands import hint_command

    hint_command(task)


@app.command(epilog="Example: botschool progress")
def progress(
    grade: Annotated[
        bool, typer.Option("--grade", help="Grade all exercises first (takes minutes).")
    ] = False,
    workers: GradingWorkers = None,
) -> None:
    """Show your last points in all exercises, and what comes next."""
    from botschool.grading.commands import progress_command

    progress_command(grade, workers)


@app.command(epilog="Example: botschool watch 3, or botschool watch 3.2 for one task")
def watch(
    what: Annotated[str, typer.Argument(help="Exercise N or task N.T.", metavar="N[.T]")],
    submission: Submission = None,
) -> None:
    """Grade again whenever you save; stop with Ctrl-C."""
    from botschool.grading.commands import watch_command

    watch_command(what, submission)


@app.command(epilog="Example: botschool show 3, or botschool show 3.2 for one task")
def show(
    what: Annotated[str, typer.Argument(help="Exercise N or task N.T.", metavar="N[.T]")],
    submission: Submission = None,
    opens: Annotated[
        bool,
        typer.Option(
            "--open/--no-open", help="Open the result in your browser, if there is a display."
        ),
    ] = True,
    answers: Annotated[
        bool, typer.Option("--answers", help="Show the answers instead; you need full marks.")
    ] = False,
) -> None:
    """Draw what you have done in results/exNN and open it: all of it, or a task beside ours.

    Of a finished exercise, the command runs your file and shows what it makes; of a laboratory
    (labN), it writes the report.
    """
    from botschool.grading.commands import answers_command, show_command
    from botschool.labs import commands as labs

    if what.startswith(LAB):
        labs.report_command(what)
    elif answers:
        answers_command(what)
    else:
        labs.lead_to(show_command(what, submission, opens))


@app.command(epilog="Example: botschool trust ~/course")
def trust(
    folder: Annotated[Path, typer.Argument(help="The course's folder.", metavar="FOLDER")],
) -> None:
    """Trust a course, so that botschool runs its graders; do so only if you know the sender."""
    from botschool.grading.commands import trust_command

    trust_command(folder)


Exercises = Annotated[
    str,
    typer.Option(
        "-e",
        "--exercises",
        "--exercise",
        help="Exercises to add, such as 1-3,7; exercises of an earlier call stay.",
        metavar="N,N-N",
    ),
]


@app.command(epilog="Example: botschool course my-course")
def course(
    folder: Annotated[
        Path, typer.Argument(help="A new folder, or a course folder to update.", metavar="FOLDER")
    ],
    exercises: Exercises = "all",
) -> None:
    """Make a folder with the exercises, which the installed botschool grades.

    In an existing folder, the command keeps the files that you have edited.
    """
    from botschool.grading.copies.commands import course_command

    course_command(folder, exercises)


@app.command(epilog="Example: botschool release ../course-for-students --exercises 1-3")
def release(
    folder: Annotated[
        Path, typer.Argument(help="A new folder, or a copy to update.", metavar="FOLDER")
    ],
    exercises: Exercises = "all",
    answers: Annotated[
        bool | None,
        typer.Option(
            "--answers/--no-answers",
            help="Whether students with full marks see our answers to the questions; an existing "
            "copy stays as it is.",
            show_default="--answers",
        ),
    ] = None,
    wheel: Annotated[
        list[Path] | None,
        typer.Option(
            help="A wheel that the copy installs, so that students compile nothing; repeat the "
            "option for several systems.",
            metavar="FILE",
        ),
    ] = None,
    settings: Annotated[
        Path | None,
        typer.Option(
            "--class", help="A class.yaml, whose 'tasks' the copy has, too.", metavar="FILE"
        ),
    ] = None,
) -> None:
    """For instructors: make a copy of the course for students, without solutions.

    Outside a repository, the command copies the installed botschool's course, as `botschool course`
    does.

    In an existing copy, the command keeps edited files and the answers of the exercises.
    """
    from botschool.grading.classes.commands import tasks_of
    from botschool.grading.copies.commands import release_command

    release_command(folder, exercises, answers, wheel or [], tasks_of(settings))


ClassList = Annotated[
    Path | None, typer.Option(help="A table of the class: names, ids, mail.", metavar="CSV")
]
Gradebook = Annotated[
    Path | None,
    typer.Option(
        help="Moodle's grading worksheet or Canvas's gradebook; the command fills in a copy.",
        metavar="CSV",
    ),
]
Column = Annotated[
    str, typer.Option(help="Name of the assignment in Canvas's gradebook.", metavar="NAME")
]


@app.command("grade-all", epilog="Example: botschool grade-all submissions --exercise 3 -o grades")
def grade_all(
    folder: Annotated[
        Path,
        typer.Argument(
            help="A folder with a sub-folder per student, or a learning platform's zip file.",
            metavar="DOWNLOAD",
        ),
    ],
    exercise: Annotated[
        str,
        typer.Option(
            "-e",
            "--exercise",
            "--exercises",
            help="Exercises or tasks: 3, 1-3,7, 3.2, lab9 or all.",
            metavar="N",
        ),
    ] = "all",
    output: Annotated[
        Path,
        typer.Option(
            "-o", "--output", help="Folder for the table and the feedback.", metavar="FOLDER"
        ),
    ] = Path("results/grades"),
    workers: GradingWorkers = None,
    fresh: Annotated[
        bool, typer.Option("--fresh", help="Grade all submissions again, also unchanged ones.")
    ] = False,
    roster: ClassList = None,
    gradebook: Gradebook = None,
    column: Column = "",
    settings: Annotated[
        Path | None,
        typer.Option(
            "--class",
            help="A file of deadlines and other rules.",
            metavar="FILE",
            show_default="class.yaml beside the download",
        ),
    ] = None,
) -> None:
    """For instructors: grade a class into a table and a page of feedback per student.

    If this machine fails to grade a submission, its cell stays empty. The exit code is 1 if a cell
    stays empty, if somebody on the roster has no submission, or if a submission's author is not on
    it.
    """
    from botschool.grading.classes.commands import grade_all_command
    from botschool.labs.classes import laboratories

    tables = roster, gradebook, column, settings
    good = grade_all_command(folder, output, exercise, workers, fresh, *tables, laboratories())
    if not good:
        raise typer.Exit(1)


@app.command(epilog="Example: botschool gradebook results/ex03 results/ex05 -o results/term")
def gradebook(
    outputs: Annotated[
        list[Path], typer.Argument(help="Folders that grade-all has written.", metavar="OUT")
    ],
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder for the table.", metavar="FOLDER")
    ] = Path("results/term"),
    roster: ClassList = None,
    gradebook: Gradebook = None,
    column: Column = "",
    settings: Annotated[
        Path | None,
        typer.Option(
            "--class",
            help="A file of weights and other rules.",
            metavar="FILE",
            show_default="the class.yaml that grade-all has used",
        ),
    ] = None,
) -> None:
    """For instructors: join the results of several gradings into one table of the term.

    Each person has one row. The exit code is 1 if somebody is missing, doubtful or not graded.
    """
    from botschool.grading.classes.commands import gradebook_command

    if not gradebook_command(outputs, output, roster, gradebook, column, settings):
        raise typer.Exit(1)


@app.command(epilog="Example: botschool export gradescope -e 3 -o results/export")
def export(
    platform: Annotated[
        str, typer.Argument(help="gradescope, actions or classroom50.", metavar="PLATFORM")
    ],
    exercises: Annotated[
        str, typer.Option("-e", "--exercises", "--exercise", help="As 1-3,7.", metavar="N,N-N")
    ] = "all",
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Folder to write into.", metavar="FOLDER")
    ] = Path("results/export"),
    wheel: Annotated[
        Path | None,
        typer.Option(
            help="A wheel of botschool, so that the platform compiles nothing.", metavar="FILE"
        ),
    ] = None,
) -> None:
    """For instructors: write the files with which a platform grades by itself."""
    from botschool.grading.classes.commands import export_command

    export_command(platform, exercises, output, wheel)


@app.command(epilog="Example: botschool nbgrader results/nbgrader")
def nbgrader(
    folder: Annotated[
        Path, typer.Argument(help="A new course folder, or one to update.", metavar="DIR")
    ] = Path("results/nbgrader"),
) -> None:
    """For instructors: make a course folder for nbgrader, with the exercises as notebooks."""
    from botschool.grading.nbgrader import nbgrader_command

    nbgrader_command(folder)


@app.command()
def skeletons() -> None:
    """Generate the exercises' skeletons from the solutions; edited files stay as they are."""
    from botschool.grading.copies.skeleton import write_skeletons
    from botschool.paths import course_root

    for path in write_skeletons(course_root()):
        print(f"not changed, because it was edited: {path}")


@app.command("new-exercise", epilog='Example: botschool new-exercise 16 "Largest values"')
def new_exercise(
    number: Annotated[int, typer.Argument(help="Number of the exercise.", metavar="N")],
    title: Annotated[str, typer.Argument(help="Its title.", metavar="TITLE")],
) -> None:
    """For instructors: begin an exercise of your own, in a checkout, with a grader that works."""
    from botschool.grading.copies.new import new_exercise
    from botschool.paths import course_root

    for path in new_exercise(course_root(), number, title):
        print(path)
    print(f"Try it: botschool grade {number} --submission solutions")
