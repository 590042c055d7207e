"""Run the subcommands for a whole class: export and grade-all."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType

from botschool.console import Console
from botschool.errors import BotschoolError, BotschoolErrors
from botschool.grading.classes.collect import PAGES, TABLE, Asked, Class, Laboratory, grade_all
from botschool.grading.classes.exporting import export
from botschool.grading.classes.files import listed
from botschool.grading.classes.outputs import filled
from botschool.grading.classes.policy import FILE, read_policy
from botschool.grading.classes.roster import read_answers, read_roster
from botschool.grading.classes.rules import Policy
from botschool.grading.classes.statistics import by_task, hardest
from botschool.grading.classes.term import TABLE as TERM
from botschool.grading.classes.term import Term, read_output, say_term, write_term
from botschool.grading.declare import weights
from botschool.grading.declare.exercise import Number, course_root, selected
from botschool.grading.declare.state import secret_for_others
from botschool.grading.judge.submission import SYNTAX
from botschool.grading.report.screen import counting, say_missing
from botschool.grading.run.confined import close_class
from botschool.terminal import exits_on_signals


def export_command(platform: str, exercises: str, output: Path, wheel: Path | None) -> None:
    """Write the files with which a platform grades by itself, and print how to use them."""
    root = course_root()
    asked = selected(exercises, root)
    if any(asked.values()):
        raise BotschoolError(f"'{exercises[:30]}' names a task: export works on whole exercises.")
    for path in export(platform, list(asked), exercises, output, root, wheel):
        print(f"made: {path}")
    print(
        {
            "gradescope": "Upload each zip file as the autograder of its assignment. It "
            "holds your secret: give it to nobody else.",
            "actions": "Put the folder .github into the repository that students start from, "
            "which is a copy made by botschool release.",
            "classroom50": "Put the folder autograders into the classroom's folder of your "
            "classroom50 repository. Give runtime.json to 'gh teacher assignment add --runtime'.",
        }[platform]
    )


@exits_on_signals()
def grade_all_command(
    folder: Path,
    output: Path,
    exercise: str,
    workers: int | None,
    fresh: bool,
    roster: Path | None = None,
    gradebook: Path | None = None,
    column: str = "",
    settings: Path | None = None,
    laboratories: Mapping[Number, Laboratory] = MappingProxyType({}),
) -> bool:
    """Grade a class and print where the results are.

    exercise: as in `selected`, or names of laboratories; "all" stands for all exercises and those
    laboratories that somebody handed in.

    Return True if all submissions could be graded, and if all students of the roster and nobody
    else handed in.
    """
    root = course_root()
    asked = _asked(exercise, root, laboratories)
    console = Console(highlight=False)
    policy = _policy(folder.absolute().parent, roster, gradebook, column, settings)
    os.environ[SYNTAX] = policy.syntax
    os.environ[weights.VARIABLE] = weights.text_of(policy.tasks)
    secret, said = secret_for_others(root)
    close_class(folder, output)
    with counting("Grading", console) as (start, step):
        found = grade_all(
            folder,
            output,
            asked,
            root,
            workers or os.cpu_count() or 1,
            fresh,
            secret,
            start,
            step,
            policy,
            laboratories,
            exercise == "all",
        )
    good = say_class(console, found)
    console.print(
        f"Table: {output / TABLE}   Feedback: {output / PAGES}", markup=False, soft_wrap=True
    )
    shown = "   ".join(str(path) for path in found.written)
    console.print(f"Also: {shown}", markup=False, soft_wrap=True)
    if said:
        console.print(said, markup=False, soft_wrap=True)
    say_missing(console, [result for row in found.register.rows for result in row.results])
    return good


def _asked(text: str, root: Path, laboratories: Mapping[Number, Laboratory]) -> Asked:
    """Return what to grade. Raises BotschoolError."""
    if text.strip() == "all":
        every: Asked = dict(selected(text, root).items())
        return every | dict.fromkeys(laboratories, ())
    parts = [part.strip().lower() for part in text.split(",")]
    labs = [part for part in parts if part.startswith("lab")]
    exercises = ",".join(part for part in parts if part not in labs)
    asked: Asked = dict(selected(exercises, root).items() if exercises or not labs else ())
    for name in labs:
        key = f"lab{name[3:].lstrip('0')}"
        if key not in laboratories:
            raise BotschoolError(
                f"'{name[:30]}' is not a laboratory: there are {', '.join(map(str, laboratories))}."
            )
        asked[key] = ()
    return asked


def _policy(
    folder: Path,
    roster: Path | None,
    gradebook: Path | None,
    column: str,
    settings: Path | None,
) -> Policy:
    """Return the class's settings; the function finds class.yaml in a folder by itself."""
    beside = folder / FILE
    if settings is None and beside.is_file() and not beside.is_symlink():
        settings = beside
    policy = read_policy(settings, collect=True) if settings else Policy()
    policy.answers = read_answers(settings.parent if settings else folder)
    roster = roster or policy.roster
    policy.people = read_roster(roster) if roster else None
    policy.gradebook = read_roster(gradebook) if gradebook else None
    policy.column = column
    if policy.gradebook and policy.gradebook.kind == "plain" and not column:
        raise BotschoolError(
            f"{gradebook} is neither Moodle's grading worksheet nor Canvas's gradebook: name the "
            "column that takes the grades with --column, or the table with --roster."
        )
    return policy


def tasks_of(settings: Path | None) -> str:
    """Return the points of tasks in a class.yaml, as in declare/weights.py."""
    return weights.text_of(read_policy(settings).tasks) if settings else ""


def gradebook_command(
    outputs: list[Path],
    output: Path,
    roster: Path | None,
    gradebook: Path | None,
    column: str,
    settings: Path | None,
) -> bool:
    """Join outputs of grade-all into the table of a term, and print where it is.

    Return True if nobody is missing, unknown, doubtful or not graded.
    """
    read = [read_output(folder) for folder in outputs]
    files = {each.settings for each in read}
    if settings is None and len(files) > 1:
        raise BotschoolError(
            f"The gradings used different settings ({', '.join(sorted(files - {''}))}): name the "
            "term's with --class."
        )
    if settings is None and (name := files.pop()):
        settings = Path(name)
    policy = _policy(output, roster, gradebook, column, settings)
    if policy.errors:
        raise BotschoolErrors(policy.errors)
    term = Term(read, policy)
    written = write_term(term, output, filled(output, term, lambda row: " ".join(row.said)))
    console = Console(highlight=False)
    good = say_term(console, term, read)
    console.print(f"Table: {output / TERM}", markup=False, soft_wrap=True)
    for path in written[1:]:
        console.print(f"Also: {path}", markup=False, soft_wrap=True)
    return good


def say_class(console: Console, found: Class) -> bool:
    """Print a class's results in a few lines; True if nobody is missing, unknown or ungraded."""
    register, rows = found.register, found.register.rows
    handed_in = [row for row in rows if row.page]
    ungraded = sum(row.total is None for row in handed_in)
    left = f"{ungraded} not graded and not counted" if ungraded else ""
    missing = f"{len(register.missing)} handed in nothing" if register.missing else ""
    unknown = f"{len(register.unknown)} not on the roster" if register.unknown else ""
    parts = [f"{len(handed_in)} submissions", register.average(), left, missing, unknown]
    lines = [", ".join(filter(None, parts)) + "."]
    lines += [*found.notes, *register.lacking()]
    if found.nobodys:
        lines.append(f"Nobody's: {listed(found.nobodys)}.")
    problems = [row.name for row in handed_in if any(r["problem"] for r in row.results)]
    if problems:
        more = f" and {len(problems) - 5} more" if len(problems) > 5 else ""
        shown = ", ".join(problems[:5]) + more
        lines.append(f"Some submissions could not be graded, see the notes in the table: {shown}")
    hard = hardest(by_task((row.name, row.page, row.results) for row in rows))
    if hard and len(handed_in) > 1:
        shown = ", ".join(f"{t.id} {t.title} ({round(100 * t.reached)}%)" for t in hard)
        lines.append(f"Where the class stumbled: {shown}.")
    for line in lines:
        console.print(line, markup=False, soft_wrap=True)
    return not (ungraded or register.missing or register.unknown or register.doubts)
