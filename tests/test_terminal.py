"""What the command says of itself and of fitness."""

import math

import pytest

import botschool
from botschool.terminal import readable
from running import finished_run


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


def test_small_differences_of_a_small_fitness_are_seen(tmp_path, command):
    """Those of a problem whose returns are near 0.001, in the lines of a run and its result."""
    ini, results = finished_run(tmp_path, "tiny_envs:Small-v0", maxmsteps=0.001)
    code, out, _ = command("es", "-f", ini, "-o", results, "-s", 2)
    assert code == 0
    lines = out.splitlines()
    told = {word for line in lines for word in line.split() if word.startswith("0.00")}
    assert len(told) > 3 and all(len(word.rstrip(",")) >= 8 for word in told)
    best = float((results / "S2.fit").read_text().split()[-1])
    assert f"best post-evaluated {readable(best)} after" in lines[-1]


def test_the_version(command):
    assert command("--version") == (0, f"botschool {botschool.__version__}\n", "")
