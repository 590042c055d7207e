"""tools/setup.sh: which packages it asks pip for, and what it says of those without wheels."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
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
PIP = "--no-input --disable-pip-version-check -c constraints.txt"
pytestmark = pytest.mark.skipif(not shutil.which("sh"), reason="needs a shell")


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


@pytest.mark.parametrize(
    ("exercise", "extras"),
    [("3", ""), ("5", "box2d"), ("10", "pybullet rl"), ("13.2", "rl"), ("16", "")],
)
def test_extras_of_an_exercise(setup, exercise, extras):
    assert setup("extras", exercise)[:2] == (0, extras and extras + "\n")


def test_an_exercise_asks_for_its_own_packages_only(setup):
    code, _, _, calls, stamps = setup("extra", "rl")
    assert code == 0 and stamps == [".extra-rl"]
    (call,) = calls
    assert "botschool[rl]" in call and "-c constraints.txt" in call
    assert "pybullet]" not in call and "box2d]" not in call and "index-url" not in call


def test_torch_without_cuda_is_a_switch(setup):
    cpu = "--extra-index-url https://download.pytorch.org/whl/cpu"
    for arguments in (["extra", "rl"], ["tests"]):
        _, _, _, calls, _ = setup(*arguments, TORCH="cpu")
        assert [cpu in call for call in calls] == ["botschool[rl]" in call for call in calls]
        assert any(cpu in call for call in calls)
    code, _, errors, calls, _ = setup("extra", "rl", TORCH="gpu")
    assert code == 2 and "TORCH=cpu" in errors and not calls


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


def test_with_all_wheels_there_is_no_notice(setup):
    code, out, _, calls, stamps = setup("tests")
    assert code == 0 and "Notice" not in out and any("compare" in call for call in calls)
    assert stamps == [".extra-atari", ".extra-box2d", ".extra-pybullet", ".extra-rl", ".tests"]


def test_an_exercise_without_wheels_says_how_to_get_them(setup):
    code, _, errors, _, stamps = setup("extra", "pybullet", WITHOUT="pybullet")
    assert code == 2 and not stamps
    assert errors.startswith("error: No wheels for Python 3.13") and "exercise 10" in errors


def test_a_real_conflict_is_no_missing_wheel(setup):
    code, _, errors, _, stamps = setup("tests", WITHOUT="rl", CONFLICT="1")
    assert code == 2 and ".tests" not in stamps and "conflicting dependencies" in errors


def test_without_network_nothing_is_left_out(setup):
    code, _, errors, _, stamps = setup("tests", WITHOUT="pybullet", OFFLINE="1")
    assert code == 2 and ".tests" not in stamps and "is it there?" in errors


def test_only_what_is_half_installed_is_forgotten(tmp_path):
    """A file is missing, one is cut short, a list is missing; the others stay."""

    def package(name, text="x = 1\n"):
        info = tmp_path / f"{name}-1.0.dist-info"
        info.mkdir()
        (info / "METADATA").write_text(f"Name: {name}\nVersion: 1.0\n")
        (info / "RECORD").write_text(f"{name}.py,,6\n{name}-1.0.dist-info/RECORD,,\n")
        if text:
            (tmp_path / f"{name}.py").write_text(text)
        return info

    package("whole")
    package("cut", "x =")
    package("gone", None)
    (package("unlisted") / "RECORD").unlink()
    (package("in_place", None) / "direct_url.json").write_text("{}")
    script = ROOT / "tools" / "half_installed.py"
    run = f"import sys, runpy; sys.path.append({str(tmp_path)!r}); runpy.run_path({str(script)!r})"
    done = subprocess.run(  # -S: without this environment's own packages
        [sys.executable, "-I", "-S", "-c", run], capture_output=True, text=True, check=True
    )
    assert sorted(done.stdout.split()) == ["cut==1.0", "gone==1.0", "unlisted==1.0"]
    left = {path.name.split("-")[0] for path in tmp_path.glob("*.dist-info")}
    assert left == {"whole", "in_place"}


def test_after_an_interruption_the_environment_is_mended(setup, tmp_path):
    """It is not made anew: what is in it stays."""
    (tmp_path / "tools").symlink_to(ROOT / "tools")
    (tmp_path / ".venv" / ".made").write_text("3.13\n")
    (tmp_path / ".venv" / ".installing-abc").touch()
    code, out, errors, calls, stamps = setup("venv")
    assert (code, errors) == (0, "") and "interrupted" in out
    assert calls == [f"-m pip install {PIP} --no-deps 3.13"] and stamps == [".made"]
    assert setup("venv")[1] == ""
