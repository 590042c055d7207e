"""What an instructor sees of a class's grading, on the screen."""

from __future__ import annotations

from rich.console import Console

from botschool.grading.classes.choice import listed
from botschool.grading.classes.collect import Class
from botschool.grading.classes.statistics import by_task, hardest


def say_class(console: Console, found: Class) -> bool:
    """Print a class's results in a few lines; True if nobody is missing, unknown or ungraded."""
    register, rows = found.register, found.rows
    handed_in = [row for row in rows if row.page]
    totals = [row.total for row in rows if row.total is not None]
    maximum = register.maximum(rows[0].results)
    average = f"{sum(totals) / len(totals):.1f} of {maximum} points on average" if totals else ""
    ungraded = sum(row.total is None for row in handed_in)
    left = f"{ungraded} not graded and not counted" if ungraded else ""
    missing = f"{len(register.missing)} handed in nothing" if register.missing else ""
    unknown = f"{len(register.unknown)} not on the roster" if register.unknown else ""
    parts = [f"{len(handed_in)} submissions", average, left, missing, unknown]
    lines = [", ".join(filter(None, parts)) + "."]
    if register.missing:
        lines.append(f"Nothing from: {listed([each.name for each in register.missing])}.")
    if register.unknown:
        lines.append(f"Not on the roster: {listed(register.unknown)}.")
    lines += found.notes
    if found.nobodys:
        lines.append(f"Nobody's: {listed(found.nobodys)}.")
    problems = [row.name for row in handed_in if any(r["problem"] for r in row.results)]
    if problems:
        more = f" and {len(problems) - 5} more" if len(problems) > 5 else ""
        shown = ", ".join(problems[:5]) + more
        lines.append(f"Not all could be graded, see the notes in the table: {shown}")
    hard = hardest(by_task(result for row in rows for result in row.results))
    if hard and len(handed_in) > 1:
        shown = ", ".join(f"{t.id} {t.title} ({round(100 * t.reached)}%)" for t in hard)
        lines.append(f"Where the class stumbled: {shown}.")
    for line in lines:
        console.print(line, markup=False, soft_wrap=True)
    return not (ungraded or register.missing or register.unknown)
