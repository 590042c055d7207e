"""Hostile files that a grader reads itself."""

import dataclasses
import time

import pytest

import building
from botschool.grading.judge.submission import grade_task
from botschool.grading.run.confined import fork_server

pytestmark = pytest.mark.course

ALIASES = """
import os


def train_variations(environment, variations, seeds, steps, folder, evaluations, episodes):
    lines = ["l0: &l0 [0, 0]"]
    lines += [f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 400)}]" for n in range(1, 8)]
    lines += [f"{name}: *l7" for name in NAMES]
    records = []
    for name in variations:
        for seed in seeds:
            place = os.path.join(folder, name, "ppo", "1")
            os.makedirs(place, exist_ok=True)
            for file in ("evaluations.npz", "config.yaml"):
                with open(os.path.join(place, file), "w") as stream:
                    stream.write("\\n".join(lines))
            records.append({"variant": name, "seed": seed, "return": 0.0, "folder": place})
    return records
"""


def test_aliases_do_not_hold_up_the_grader(tmp_path):
    """14.1's grader reads a YAML file: lists of lists of lists that are all the same one."""
    pytest.importorskip("stable_baselines3")
    from botschool.rl.settings import Settings

    loaded = building.exercise(14)
    names = [field.name for field in dataclasses.fields(Settings)]
    text = building.inserted(building.source(14).skeleton, f"NAMES = {names}\n{ALIASES}")
    file = building.write(tmp_path, 14, text)
    start = time.process_time()
    with fork_server(loaded.imports) as server:
        result = grade_task(loaded.find("14.1"), file, server)
    assert result.points == 0
    assert "has an alias" in result.message
    assert time.process_time() - start < 10  # of this process: minutes without a limit


AGAIN = """
def master(table):
    import sys
    import botschool.analysis.tournament
    for name in [each for each in sys.modules if each.startswith("botschool")]:
        del sys.modules[name]
    from botschool.analysis.tournament import summarised
    mean, prey = summarised(table, 1)
    return {"predators": mean.mean, "prey": prey.mean}
"""


@pytest.mark.parametrize("again", [AGAIN, AGAIN.replace("del sys.modules[name]", "pass")])
def test_the_librarys_answer_is_refused_though_it_is_imported_again(tmp_path, again):
    loaded = building.exercise(15)
    file = building.write(tmp_path, 15, building.inserted(building.source(15).skeleton, again))
    with fork_server(loaded.imports) as server:
        result = grade_task(loaded.find("15.3"), file, server)
    assert result.points == 0
    assert "write it yourself: botschool.analysis.tournament.summarised" in result.message
