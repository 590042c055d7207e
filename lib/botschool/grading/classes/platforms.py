"""Write grades in the formats of platforms that run a grader by themselves.

The scripts that `botschool export` writes call this module as a program:

    python -m botschool.grading.classes.platforms PLATFORM EXERCISES SUBMISSION RESULT

It writes RESULT and ends with code 0, whatever the points. After a fault of the machine there is no
result and the code is 1, so that nobody gets 0 points for it.
"""

from __future__ import annotations

import json
import os
import sys
import tempfile
import time
from collections.abc import Mapping
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.batch import Grades, Job, remarks, to_record
from botschool.grading.classes.choice import find_in
from botschool.grading.declare.exercise import course_root, load_exercise, selected
from botschool.grading.declare.state import FILE, STATE, secret_for_others
from botschool.grading.judge.submission import grade
from botschool.grading.run.confined import MachineFault, close_class
from botschool.grading.run.temporary import temporary_files_within
from botschool.output import save_bytes

PLATFORMS = ("gradescope", "actions", "classroom50")


def graded(number: int, place: Path, only_changed: bool = False) -> dict[str, Any]:
    """Return the result of an exercise in a submission, as in batch.Grades, with `notes`.

    only_changed: whether an unchanged file gets its 0 points without running. Raises BotschoolError
    if this machine cannot grade.
    """
    root = course_root()
    exercise = load_exercise(number, root)
    exercise.require(exercise.tasks)
    if (root / STATE / FILE).is_file():
        exercise.secret, _ = secret_for_others(root)
    one = find_in(place, exercise, root, Path(tempfile.mkdtemp(prefix="botschool-")))
    choice = one.choices[number]
    if choice.unread:
        raise MachineFault(choice.problem)
    notes = [*choice.notes, *one.notes]
    if choice.file is None or (only_changed and not choice.changed):
        problem = choice.problem or f"Nothing was changed in {exercise.file} yet."
        nothing = Grades(root).nothing(Job(number, place), problem, graded=True)
        tasks = [task | {"message": problem} for task in nothing["tasks"]]
        return nothing | {"tasks": tasks, "notes": notes}
    folder = (place if place.is_dir() else place.parent).resolve()
    if not root.resolve().is_relative_to(folder):  # else it is the student's own course
        close_class(folder)
    return to_record(grade(exercise, choice.file)) | {"notes": notes}


def gradescope(result: dict[str, Any], seconds: float) -> dict[str, Any]:
    """Return the content of Gradescope's results.json: a test for each task."""
    said = remarks(result)
    return {
        "score": result["points"],
        "execution_time": round(seconds),
        "output": "\n".join(said),
        "output_format": "text",
        "stdout_visibility": "hidden",
        "tests": [
            {
                "name": task["title"],
                "number": task["id"],
                "score": task["points"],
                "max_score": task["max_points"],
                "status": "passed" if task["points"] == task["max_points"] else "failed",
                "output": task["message"],
                "output_format": "text",
                "visibility": "visible",
            }
            for task in result["tasks"]
        ],
        "extra_data": {"exercise": result["exercise"], "missing": result["missing"]},
    }


def classroom50(
    result: dict[str, Any], environment: Mapping[str, str], now: datetime
) -> dict[str, Any]:
    """Return the content of Classroom 50's result.json (classroom50/result/v1).

    environment: with what its runner tells. Raises BotschoolError where that is missing.
    """
    names = ("CLASSROOM", "ASSIGNMENT", "SUBMISSION_TAG", "COMMIT_URL", "RELEASE_URL")
    if missing := [name for name in names if not environment.get(name)]:
        raise BotschoolError(f"{missing[0]} is not set: Classroom 50's runner sets it.")
    told = {
        "assignment_type": environment.get("ASSIGNMENT_TYPE", "individual"),
        "owner": environment.get("OWNER") or environment.get("USERNAME", ""),
    }
    return {
        "schema": "classroom50/result/v1",
        "classroom": environment["CLASSROOM"],
        "assignment": environment["ASSIGNMENT"],
        **told,
        "submission": environment["SUBMISSION_TAG"],
        "commit": environment["COMMIT_URL"],
        "release": environment["RELEASE_URL"],
        "review": environment.get("REVIEW_URL") or environment["COMMIT_URL"],
        "datetime": now.astimezone(timezone.utc).strftime("%Y-%m-%dT%H:%M:%SZ"),
        "score": result["points"],
        "max-score": result["max_points"],
        "tests": [
            {
                "test-name": f"{task['id']} {task['title']}",
                "passed": task["points"] == task["max_points"],
                "score": task["points"],
                "max-score": task["max_points"],
            }
            for task in result["tasks"]
        ],
    }


def markdown(results: list[dict[str, Any]]) -> str:
    """Return a report for a page of GitHub: a table of tasks, and why points are missing."""
    lines = []
    for result in results:
        lines += [
            f"## Exercise {result['exercise']}. {_escaped(result['title'])}: "
            f"{result['points']} of {result['max_points']} points",
            "",
        ]
        said = remarks(result)
        lines += [_code("\n".join(said)), ""] if said else []
        if result["problem"]:
            continue
        lines += ["| task | | points |", "|---|---|---|"]
        for task in result["tasks"]:
            points = f"{task['points']} of {task['max_points']}"
            lines.append(f"| {task['id']} | {_escaped(task['title'])} | {points} |")
        lines.append("")
        for task in result["tasks"]:
            if task["message"]:
                lines += [f"Task {task['id']}:", "", _code(task["message"]), ""]
    return "\n".join(lines)


def _code(text: str) -> str:
    """Return a text that Markdown shows unchanged: each line is indented."""
    return "\n".join(f"    {line}" for line in text.splitlines())


def _escaped(text: str) -> str:
    return "".join(f"\\{letter}" if letter in "\\`*_{}[]<>()#|!" else letter for letter in text)


@temporary_files_within()
def run(platform: str, exercises: str, place: Path, result: Path) -> None:
    """Grade a submission and write the platform's file. Raises BotschoolError."""
    started = time.monotonic()
    numbers = list(selected(exercises))
    if platform not in PLATFORMS or (platform != "actions" and len(numbers) != 1):
        raise BotschoolError(f"{platform} {exercises}: name one exercise of {PLATFORMS}.")
    results = [graded(number, place, only_changed=platform == "actions") for number in numbers]
    if platform == "gradescope":
        made: Any = gradescope(results[0], time.monotonic() - started)
    elif platform == "classroom50":
        made = classroom50(results[0], os.environ, datetime.now(timezone.utc))
        body = result.parent / "release-body.md"
        save_bytes(body, markdown(results).encode("utf-8", "replace"))
    else:
        made = [{k: v for k, v in each.items() if k != "pictures"} for each in results]
        if summary := os.environ.get("GITHUB_STEP_SUMMARY"):
            with open(summary, "a", encoding="utf-8", errors="replace") as file:
                file.write(markdown([each for each in results if not each["problem"]]))
    result.parent.mkdir(parents=True, exist_ok=True)
    save_bytes(result, json.dumps(made, indent=1).encode())


def main() -> None:
    """Run as a program: platform, exercises, the submission, the file to write."""
    try:
        run(sys.argv[1], sys.argv[2], Path(sys.argv[3]), Path(sys.argv[4]))
    except (BotschoolError, OSError) as error:
        sys.exit(f"Not graded: {error}")


if __name__ == "__main__":
    main()
