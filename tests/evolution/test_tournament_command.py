"""Post-evaluation of co-evolved populations, `es -p -g M-100-20`, and `botschool tournament`."""

import csv
import re

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from botschool import config
from botschool.analysis import coevolution
from botschool.analysis.populations import Populations
from botschool.analysis.tournament import Contest, master_tournament
from botschool.errors import BotschoolError
from duels import GENERATIONS, write_run
from test_analysis import drawn  # noqa: F401
from test_replay import held


@pytest.fixture
def results(tmp_path):
    return write_run(tmp_path / "results")


# Strings


@pytest.mark.parametrize("text", ["P-100-5", "p-0-1", "m-40-10", "M-1000-100"])
def test_strings_are_read(text, tmp_path):
    request = coevolution.parse(text, tmp_path)
    assert f"{request.kind}-{request.generation}-{request.number}" == text


GOOD = re.compile(r"[PpmM]-[0-9]{1,9}-0*[1-9][0-9]*|c-.*", re.DOTALL)


@given(
    st.text(alphabet="PpmMcQ-0123456789 ./\n\0é", max_size=14).filter(
        lambda t: not GOOD.fullmatch(t)
    )
)
@example("P-10")
@example("P-10-0")
@example("P--1-5")
@example("P-10-5\n")
@example("p-10-5-2")
@example("P-１-2")
def test_malformed_strings_are_refused_in_a_sentence_that_lists_what_is_there(text):
    import tempfile
    from pathlib import Path

    with tempfile.TemporaryDirectory() as folder:
        for generation in (0, 30):
            np.save(Path(folder) / f"S7G{generation}.npy", np.zeros((2, 2)))
        with pytest.raises(BotschoolError) as refused:
            coevolution.parse(text, Path(folder))
    sentence = str(refused.value)
    assert "P-100-5" in sentence and "generations 0 and 30 of seed 7" in sentence
    assert "\n" not in sentence


# The command


@pytest.fixture
def es(results, command):
    return lambda text, *more: command(
        "es", "-f", results / "own.ini", "-s", 12, "-o", results, "-p", "-g", text, *more
    )


def test_pairs_are_measured_and_shown(es):
    code, measured, _ = es("p-10-2")
    assert code == 0 and "generation 10" in measured and "mean fitness of the prey: " in measured
    code, shown, _ = es("P-10-2", "--render", "none")
    assert code == 0 and shown.endswith(measured)
    assert re.findall(r"predator \d, prey \d", shown) == [
        f"predator {i}, prey {j}" for i in (1, 2) for j in (1, 2)
    ]
    code, single, _ = es("p-10-1")
    assert code == 0 and "interval" not in single


def test_one_generation_meets_those_before_it(es):
    code, said, _ = es("m-40-20")
    assert code == 0
    assert re.findall(r"^ ?generation (\d+)  ", said, re.M) == ["0", "20", "40"]
    assert len(re.findall(r"\d\.\d\d \(\d\.\d\d to \d\.\d\d\)", said)) == 6


@pytest.mark.parametrize(
    ("text", "missing", "takes_part"),
    [
        ("m-40-10", "generation 30 is", "generations 0, 10, 20 and 40"),
        ("m-41-17", "generations 7, 24 and 41 are", "generations 10, 20 and 40"),
        ("M-1000-500", "generations 500 and 1000 are", "generations 0 and 40"),
        ("m-25-25", "generation 25 is", "generations 0 and 20"),
    ],
)
def test_the_nearest_generations_take_part_with_a_warning(es, text, missing, takes_part):
    code, said, _ = es(text)
    assert f"warning: {missing} not saved; the nearest take part: {takes_part}\n" in said
    assert code == 0


def test_without_a_run_of_your_own_the_one_of_the_course_takes_part(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    own = ("es", "-f", "predprey.ini", "-p", "-g", "p-1000-1")
    code, said, note = command(*own, "-s", 12)
    assert code == 0 and "generation 300: fitness" in said
    assert "This folder has no such run; here is the one that comes with botschool: " in note
    code, _, refusal = command(*own, "-s", 3)
    assert code == 2 and "holds no populations of seed 3" in refusal
    code, _, refusal = command(*own, "-s", 12, "-o", tmp_path)
    assert code == 2 and "holds no populations of seed 12" in refusal
    write_run(tmp_path)
    (tmp_path / "own.ini").rename("predprey.ini")
    code, said, note = command(*own, "-s", 12)
    assert code == 0 and "generation 40: fitness" in said and "comes with" not in note


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("p-10-4", "at most 3"),
        ("m-0-5", "generations 0, 10, 20 and 40 of seed 12"),
        ("m-0-1", "no generation before 0"),
        ("Q-1-2", "generations 0, 10, 20 and 40 of seed 12"),
        ("missing.npy", "no genotype file missing.npy"),
        ("c-one.npy-two.npy", "generations 0, 10, 20 and 40 of seed 12"),
    ],
)
def test_what_cannot_be_is_refused(results, refused, text, says):
    file = results / "own.ini"
    refused("es", "-f", file, "-s", 12, "-o", results, "-p", "-g", text, says=says)


def test_a_replay_says_who_meets_whom(es, results):
    page = results / "chase.html"
    code, _, _ = es("P-10-2", "--replay", page)
    data = held(page)
    assert code == 0 and "generation 10" in data["about"] and "predator's" in data["about"]
    assert [episode["label"] for episode in data["episodes"]][2] == "predator 2, prey 1"
    assert {name for name, *_ in data["scene"]["closeups"]} == {"predator", "prey"}


@pytest.mark.slow
def test_the_tournament_is_drawn_with_its_numbers_beside_it(results, command, drawn):  # noqa: F811
    picture = results / "all.png"
    code, said, _ = command("tournament", results, "-f", results / "own.ini", "-o", picture)
    assert code == 0 and "Later prey do " in said and str(picture) in said
    axes = [axes for part in drawn[-1].subfigs for axes in part.axes]
    titles = [axes.get_title() for axes in axes]
    assert "fitness of the predators" in titles and any("progress" in title for title in titles)

    contest = Contest(config.load(results / "own.ini"), 12)
    populations = Populations(results, 12, contest.policy)
    tables = master_tournament(contest, coevolution.select(populations, list(GENERATIONS)))
    expected = {table.role: table for table in tables}
    rows = list(csv.DictReader((results / "all.csv").open()))
    assert len(rows) == 2 * len(GENERATIONS) ** 2
    for row in rows:
        table = expected[row["side"]]
        place = [GENERATIONS.index(int(row[name])) for name in ("generation", "competitors")]
        assert float(row["fitness"]) == pytest.approx(table.mean[tuple(place)], abs=1e-6)
        assert float(row["low"]) <= float(row["fitness"]) <= float(row["high"])
    image = axes[0].images[0].get_array()
    np.testing.assert_array_equal(image, expected["predators"].mean)


def test_a_tournament_that_cannot_be_is_refused(results, refused, tmp_path):
    own = ("tournament", results, "-f", results / "own.ini")
    refused("tournament", results, says="-f FILE.ini")
    refused(*own, "--generations", "0;10", says="0,100,200")
    refused(*own, "--generations", "0,5", says="generations 0, 10, 20 and 40")
    refused(*own, "--generations", "10", says="two generations")
    refused(*own, "--generations", "0,10", "--every", 10, says="one of them")
    refused(*own, "--every", 30, says="generations 0, 10, 20 and 40")
    refused(*own, "--best", 9, says="at most 3")
    refused(*own, "-o", results / "all.txt", says=".png")
    refused("tournament", tmp_path, "-f", results / "own.ini", says="no populations")
    np.save(results / "S13G0.npy", np.zeros((6, 50)))
    refused(*own, says="several seeds (12, 13)")


def test_an_experiment_of_one_robot_has_no_tournament(tmp_path, refused):
    path = tmp_path / "own.ini"
    path.write_text("[EXP]\nenvironment = ErDiscrim\nalgo = coevo2\n[POLICY]\n[ALGO]\n")
    np.save(tmp_path / "S1G0.npy", np.zeros((2, 2)))
    refused("tournament", tmp_path, "-f", path, says="ErDiscrim has one robot")
