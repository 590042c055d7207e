"""`make demo`: its commands, with fewer steps, make what it says it has made."""

import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest

from botschool.cli.app import commands as command_line

ROOT = Path(__file__).parents[1]
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


def test_the_readme_says_what_the_demo_evolves():
    """The steps that its captions give are those of the Makefile."""
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    steps = [int(number) for number in re.findall(r"--steps (\d+) --force", makefile)]
    text = " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    words = {3_000_000: "three million steps", 10_000_000: "ten million"}
    assert len(steps) == 2 and all(words[count] in text for count in steps)
