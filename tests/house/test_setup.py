"""tools/setup.sh: which packages it asks pip for, and what it says of those without wheels."""

import math
import os
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

import botschool
from botschool.cli.app import commands as command_line
from botschool.terminal import readable

ROOT = Path(__file__).parents[2]
PYTHON = """#!/bin/sh
# Stands for .venv/bin/python: writes down what pip is called with, and has no wheels for $WITHOUT.
case "$*" in
    "-m pip install"*)
        echo "$*" >>calls
        for extra in $WITHOUT; do
            case "$*" in *"botschool[$extra]"*)
                [ -z "$OFFLINE" ] || echo "Retrying after connection broken by name resolution"
                echo "ERROR: Cannot install botschool[$extra]: conflicting dependencies."
                exit 1 ;;
            esac
        done ;;
    "-m pip download"*)
        [ -n "$CONFLICT" ] && exit
        echo "ERROR: No matching distribution found for $WITHOUT"
        exit 1 ;;
    *) echo 3.13 ;;
esac
"""


@pytest.fixture
def setup(tmp_path):
    """Runs a step in a folder with a Python that only writes down what it is asked for."""
    (tmp_path / "exercises").symlink_to(ROOT / "exercises")
    (tmp_path / ".venv" / "bin").mkdir(parents=True)
    python = tmp_path / ".venv" / "bin" / "python"
    python.write_text(PYTHON)
    python.chmod(0o755)

    def run(*arguments, **variables):
        (tmp_path / "calls").write_text("")
        done = subprocess.run(
            ["sh", ROOT / "tools" / "setup.sh", *arguments],
            cwd=tmp_path,
            env={"PATH": os.environ["PATH"]} | variables,
            capture_output=True,
            text=True,
        )
        calls = (tmp_path / "calls").read_text().splitlines()
        stamps = sorted(path.name for path in (tmp_path / ".venv").glob(".*"))
        return done.returncode, done.stdout, done.stderr, calls, stamps

    return run


@pytest.mark.skipif(not shutil.which("sh"), reason="needs a shell")
@pytest.mark.parametrize(
    ("exercise", "extras"),
    [("3", ""), ("5", "box2d"), ("10", "pybullet rl"), ("13.2", "rl"), ("16", "")],
)
def test_extras_of_an_exercise(setup, exercise, extras):
    assert setup("extras", exercise)[:2] == (0, extras and extras + "\n")


@pytest.mark.skipif(not shutil.which("sh"), reason="needs a shell")
def test_torch_without_cuda_is_a_switch(setup):
    cpu = "--extra-index-url https://download.pytorch.org/whl/cpu"
    for arguments in (["extra", "rl"], ["tests"]):
        _, _, _, calls, _ = setup(*arguments, TORCH="cpu")
        assert [cpu in call for call in calls] == ["botschool[rl]" in call for call in calls]
        assert any(cpu in call for call in calls)
    code, _, errors, calls, _ = setup("extra", "rl", TORCH="gpu")
    assert code == 2 and "TORCH=cpu" in errors and not calls


@pytest.mark.skipif(not shutil.which("sh"), reason="needs a shell")
def test_what_has_no_wheel_is_left_out_with_one_notice(setup):
    code, out, errors, calls, stamps = setup("tests", WITHOUT="pybullet")
    assert (code, errors) == (0, "")
    assert stamps == [".extra-atari", ".extra-box2d", ".extra-rl", ".tests"]
    assert out.count("Notice") == 1 and "PyBullet (exercise 10)" in out
    assert "PYTHON=python3.11 make test" in out and "pip install 'botschool[pybullet]'" in out
    assert not any("compare" in call for call in calls)
    code, out, *_ = setup("tests", WITHOUT="pybullet box2d rl")
    assert code == 0 and out.count("Notice") == 1
    assert "Box2D (exercise 5)" in out and "botschool[box2d,pybullet,rl]" in out


@pytest.mark.skipif(not shutil.which("sh"), reason="needs a shell")
def test_an_exercise_without_wheels_says_how_to_get_them(setup):
    code, _, errors, _, stamps = setup("extra", "box2d", WITHOUT="box2d")
    assert code == 2 and not stamps
    assert errors.startswith("error: No wheels for Python 3.13") and "exercise 5" in errors


# --- `make demo`: its commands, with fewer steps, make what it says it has made.


STEPS = {"acrobot": "20000", "planarhopper": "40000"}
"""Instead of those of the Makefile: enough to have a robot."""


def steps_of_demo(folder):
    """The commands of its recipe, as lists of words, and what it prints at the end."""
    make = ["make", "-n", "demo", f"DEMO={folder}"]
    done = subprocess.run(make, cwd=ROOT, capture_output=True, text=True, check=True)
    lines = [shlex.split(line) for line in done.stdout.replace("\\\n", " ").splitlines()]
    commands = [words for words in lines if words[0].endswith("/botschool")]
    (said,) = [words[1] for words in lines if words[0] == "echo"]
    return commands, said


@pytest.mark.slow
@pytest.mark.skipif(not shutil.which("make"), reason="needs make")
def test_the_demo_makes_what_it_names(tmp_path, monkeypatch):
    commands, said = steps_of_demo(tmp_path)
    named = [Path(word) for word in said.split() if "/" in word]
    assert {path.suffix for path in named} == {".png", ".mp4"} and len(named) == 4
    monkeypatch.chdir(ROOT)
    evolved = 0
    for _, *words in commands:
        if "--steps" in words:
            words[words.index("--steps") + 1] = STEPS[Path(words[words.index("-f") + 1]).stem]
            evolved += 1
        elif "--episodes" not in words and "-p" in words:
            words += ["--episodes", "1"]
        assert not command_line(words[0])(words, standalone_mode=False), words
    assert evolved == 2
    for path in named:
        assert path.stat().st_size > 5_000, path


# --- What the command says of itself and of fitness.


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2261.44, "2261.4"),
        (500, "500.0"),
        (-66.314, "-66.31"),
        (9.996, "10.00"),
        (0.65, "0.6500"),
        (-0.0123456, "-0.01235"),
        (0.00001, "0.00001000"),
        (0.0, "0.00"),
        (12345678.0, "1.235e+07"),
        (-1.5e-9, "-1.500e-09"),
        (-math.inf, "-inf"),
        (math.nan, "nan"),
    ],
)
def test_fitness_has_the_digits_that_its_size_asks_for(value, text):
    assert readable(value) == text


def test_the_version(command):
    assert command("--version") == (0, f"botschool {botschool.__version__}\n", "")
