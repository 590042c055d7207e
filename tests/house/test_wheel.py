"""The way of a stranger: build a wheel, install it away from the checkout, make a course, grade."""

import os
import re
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[2]
WORKFLOWS = sorted((ROOT / ".github" / "workflows").glob("*.yml"))


@pytest.fixture(scope="module")
def wheel(tmp_path_factory):
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "pip", "wheel", "--no-build-isolation", "--no-deps"]
    command += ["-C", "build-dir=build/wheel", "-w", folder, ROOT]
    path = os.pathsep.join([sysconfig.get_path("scripts"), os.environ["PATH"]])
    done = subprocess.run(command, env=os.environ | {"PATH": path}, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    (made,) = folder.glob("botschool-*.whl")
    return made


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory):
    """Calls the command of a new environment, in an empty folder; packages are this one's."""
    top = tmp_path_factory.mktemp("stranger")
    subprocess.run([sys.executable, "-m", "venv", "--without-pip", top / "venv"], check=True)
    python = top / "venv" / "bin" / "python"
    ours = sysconfig.get_path("purelib")
    theirs = sysconfig.get_path("purelib", vars={"base": str(top / "venv")})
    pip = [sys.executable, "-m", "pip", "--python", python, "install", "--no-deps", "--no-index"]
    subprocess.run([*pip, wheel], check=True, capture_output=True)
    Path(theirs, "packages.pth").write_text(f"{ours}\n")  # read no .pth of ours: no checkout
    (top / "empty").mkdir()
    settings = {key: os.environ[key] for key in ("PATH", "LANG") if key in os.environ}

    def call(*arguments, cwd=top / "empty"):
        command = [top / "venv" / "bin" / "botschool", *map(str, arguments)]
        environment = settings | {"HOME": str(top), "MPLBACKEND": "Agg"}
        done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True)
        return done.returncode, done.stdout + done.stderr

    call.folder = top / "empty"
    return call


@pytest.mark.long
def test_a_stranger_evolves_and_grades_with_a_wheel_alone(installed):
    code, said = installed("es", "-f", "acrobot.ini", "-s", "1", "--steps", "20000")
    assert code == 0, said
    assert "acrobot" in installed("examples")[1]
    code, said = installed("course", "my course")
    assert code == 0, said
    course = installed.folder / "my course"
    assert not [path for path in course.rglob("*") if path.suffix in (".cpp", ".hpp", ".so")]
    for number in (1, 2, 3):
        (solution,) = (ROOT / "solutions").glob(f"ex{number:02d}_*/[a-z]*.py")
        place = course / "exercises" / solution.parent.name / solution.name
        assert installed("grade", number, cwd=course)[0] == 1
        shutil.copy(solution, place)
        code, said = installed("grade", number, cwd=course)
        assert code == 0 and "100 of 100 points" in said, said


# --- what a public repository runs elsewhere, as far as it can be looked at here
@pytest.mark.parametrize("path", WORKFLOWS, ids=lambda path: path.stem)
def test_workflows_name_what_exists(path):
    jobs = yaml.safe_load(path.read_text())["jobs"]
    makefile = (ROOT / "Makefile").read_text()
    for job in jobs.values():
        assert job.get("needs") is None or set([job["needs"]] if isinstance(
            job["needs"], str) else job["needs"]) <= set(jobs)  # fmt: skip
        for step in job["steps"]:
            used, run = step.get("uses", ""), step.get("run", "")
            assert bool(run) != bool(re.fullmatch(r"[\w-]+/[\w.-]+@[\w./]+", used)), step
            for target in run.removeprefix("make ").split() if run.startswith("make ") else ():
                assert re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE), target
            for file in re.findall(r"tests/[\w/]+\.py", run):
                assert (ROOT / file).is_file(), file


def test_the_version_stands_in_one_place():
    text = (ROOT / "lib/botschool/__init__.py").read_text()
    assert re.search(r'^__version__ = "\d+\.\d+.*"', text, re.MULTILINE)
    assert 'dynamic = ["version"]' in (ROOT / "pyproject.toml").read_text()
    for name in ("CITATION.cff", "lib/CMakeLists.txt"):
        written = (ROOT / name).read_text()
        assert not re.search(r"^version|project\(.*VERSION", written, re.MULTILINE)
