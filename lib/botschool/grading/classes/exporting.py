"""Write folders and zip files with which platforms grade by themselves (`botschool export`).

Each holds a student's copy of the course, with packed graders, and a script that calls
platforms.py in it.
"""

from __future__ import annotations

import re
import shutil
import tempfile
from pathlib import Path

from botschool.errors import BotschoolError
from botschool.grading.classes.platforms import PLATFORMS
from botschool.grading.copies.release import release
from botschool.grading.declare.exercise import load_exercise
from botschool.grading.declare.state import FILE, STATE, secret_for_others

_MODULE = "botschool.grading.classes.platforms"
_SETUP = """\
#!/usr/bin/env bash
# Made by `botschool export gradescope`: installs what the grader needs, once for an assignment.
set -euo pipefail
base="${{AUTOGRADER:-/autograder}}"
export DEBIAN_FRONTEND=noninteractive
apt-get update
apt-get install -y --no-install-recommends {packages}
cd "$base/source/course"
{install}
"""
_COMPILER = "g++ make python3 python3-dev python3-venv"
_FROM_SOURCE = "make build{extras}"
_FROM_WHEEL = """\
python3 -c 'import sys
if not {fits}:
    sys.exit("This image has Python %d.%d, but {wheel} is for Python {words}: choose an image "
             "with it, or export with another wheel." % sys.version_info[:2])'
python3 -m venv .venv
.venv/bin/python -m pip install "$base/source/{wheel}{extras}\""""
_RUN = """\
#!/usr/bin/env bash
# Made by `botschool export gradescope`: grades a submission of exercise {number}.
base="${{AUTOGRADER:-/autograder}}"
export BOTSCHOOL_COURSE="$base/source/course"
cd "$base"
exec "${{BOTSCHOOL_PYTHON:-$BOTSCHOOL_COURSE/.venv/bin/python}}" -m {module} \\
  gradescope {number} "$base/submission" "$base/results/results.json"
"""
_WORKFLOW = """\
# Made by `botschool export actions`: grades exercises whenever somebody pushes, and shows the
# points on the run's page. The secret BOTSCHOOL_GRADING_SEED is optional: where it is set, nobody
# knows the numbers that the grader calls functions with.
name: botschool
on: [push, workflow_dispatch]
permissions:
  contents: read
jobs:
  grade:
    runs-on: ubuntu-latest
    timeout-minutes: 120
    steps:
      - uses: actions/checkout@v4
      - uses: actions/setup-python@v5
        with:
          python-version: "3.11"
      - run: make build{extras}
      - name: Grade
        env:
          BOTSCHOOL_COURSE: ${{{{ github.workspace }}}}
          BOTSCHOOL_GRADING_SEED: ${{{{ secrets.BOTSCHOOL_GRADING_SEED }}}}
        run: .venv/bin/python -m {module} actions {exercises} . grades.json
      - uses: actions/upload-artifact@v4
        with:
          name: grades
          path: grades.json
"""
_AUTOGRADER = '''\
"""Made by `botschool export classroom50`: grades exercise {number} of the present folder.

Classroom 50's runner calls it in a student's repository. The course lies beside this file.
"""

import os
import subprocess
import sys
from pathlib import Path

COURSE = Path(__file__).resolve().parent / "course"
python = os.environ.get("BOTSCHOOL_PYTHON")
if not python:
    subprocess.run(["make", "-C", str(COURSE), "build"{extras}], check=True)
    python = str(COURSE / ".venv" / "bin" / "python")
command = [python, "-m", "{module}", "classroom50", "{number}", ".", "result.json"]
environment = os.environ | {{"BOTSCHOOL_COURSE": str(COURSE)}}
sys.exit(subprocess.run(command, env=environment).returncode)
'''
_RUNTIME = '{\n "runs-on": "ubuntu-latest",\n "python": "3.11",\n "apt": ["g++", "make"]\n}\n'


def export(
    platform: str, numbers: list[int], text: str, output: Path, root: Path, wheel: Path | None
) -> list[Path]:
    """Write a platform's files into a folder and return their paths.

    text: the exercises as the user named them. Raises BotschoolError before overwriting anything.
    """
    if platform not in PLATFORMS:
        raise BotschoolError(
            f"'{platform}' is not a platform: choose one of {', '.join(PLATFORMS)}."
        )
    if wheel and (platform != "gradescope" or not wheel.is_file() or wheel.suffix != ".whl"):
        raise BotschoolError(f"--wheel {wheel}: name a .whl file, for gradescope.")
    if wheel:
        _pythons(wheel)
    places = {
        "gradescope": [output / f"gradescope-ex{number:02d}.zip" for number in numbers],
        "classroom50": [output / "autograders" / f"ex{number:02d}" for number in numbers],
        "actions": [output / ".github" / "workflows" / "botschool.yml"],
    }[platform]
    if there := [place for place in places if place.exists()]:
        raise BotschoolError(f"{there[0]} exists already: move it away, or choose another folder.")
    if platform == "actions":
        extras = _extras(numbers, root)
        made = _WORKFLOW.format(module=_MODULE, exercises=text, extras=_targets(extras))
        places[0].parent.mkdir(parents=True, exist_ok=True)
        places[0].write_text(made, encoding="utf-8")
        return places
    for number, place in zip(numbers, places, strict=True):
        place.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(prefix="botschool-export-") as temporary:
            folder = Path(temporary) / "made"
            release(root, folder / "course", {number}, trusted=False)
            if platform == "gradescope":
                _gradescope(folder, number, root, wheel)
                shutil.make_archive(str(place.with_suffix("")), "zip", folder)
                place.chmod(0o600)  # it holds the secret
            else:
                _classroom50(folder, number, root)
                shutil.move(folder, place)
    return places


def _extras(numbers: list[int], root: Path) -> list[str]:
    found = [extra for number in numbers for extra in load_exercise(number, root).extras]
    return sorted(set(found))


def _targets(extras: list[str]) -> str:
    return "".join(f" .venv/.extra-{extra}" for extra in extras)


def _gradescope(folder: Path, number: int, root: Path, wheel: Path | None) -> None:
    extras = _extras([number], root)
    if wheel:
        shutil.copy2(wheel, folder / wheel.name)
        listed = f"[{','.join(extras)}]" if extras else ""
        fits, words = _pythons(wheel)
        install = _FROM_WHEEL.format(wheel=wheel.name, extras=listed, fits=fits, words=words)
        packages = "python3 python3-venv"
    else:
        install, packages = _FROM_SOURCE.format(extras=_targets(extras)), _COMPILER
    _script(folder / "setup.sh", _SETUP.format(install=install, packages=packages))
    _script(folder / "run_autograder", _RUN.format(number=number, module=_MODULE))
    secret, _ = secret_for_others(root)
    state = folder / "course" / STATE
    state.mkdir()
    (state / ".gitignore").write_text("*\n")
    (state / FILE).write_text(f"{secret}\n")


def _pythons(wheel: Path) -> tuple[str, str]:
    """Return which versions of Python a wheel is for, as an expression and in words.

    Raises BotschoolError for a wheel that is not for Linux.
    """
    tags = re.fullmatch(r"botschool-.+-cp3(\d+)-(\w+)-(\w+)", wheel.stem)
    if not tags or not tags[3].startswith(("linux", "manylinux")):
        raise BotschoolError(f"--wheel {wheel}: Gradescope needs a wheel of botschool for Linux.")
    later = tags[2] == "abi3"
    fits = f"sys.version_info[:2] {'>=' if later else '=='} (3, {tags[1]})"
    return fits, f"3.{tags[1]}{' and later' if later else ''}"


def _classroom50(folder: Path, number: int, root: Path) -> None:
    extras = "".join(f', ".venv/.extra-{extra}"' for extra in _extras([number], root))
    text = _AUTOGRADER.format(number=number, module=_MODULE, extras=extras)
    (folder / "autograder.py").write_text(text, encoding="utf-8")
    (folder / "runtime.json").write_text(_RUNTIME)


def _script(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8", newline="\n")
    path.chmod(0o755)
