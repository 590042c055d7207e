"""The league: entries that are made, refused, measured, ranked and shown."""

import csv
import json

import numpy as np
import pytest

from botschool import problems
from botschool.config import load, to_dict
from botschool.errors import BotschoolError
from botschool.evolution.limit import Limit
from botschool.evolution.run import Run
from botschool.labs.declare import load_lab
from botschool.labs.entries import SUFFIX, Unusable, read_entry, write_entry
from botschool.labs.league import compete, longest_pole, means, metres, ranked
from botschool.output import save_npz
from botschool.paths import course_root
from running import call, one_sentence

EXPERIMENTS = course_root() / "data" / "experiments"
ROBOTS = course_root() / "data" / "genotypes"


def entry(folder, genotype, ini, name=""):
    """The entry of a saved robot, as `botschool enter` makes it."""
    path = folder / f"{name or 'nobody'}-{ini}{SUFFIX}"
    folder.mkdir(exist_ok=True)
    return write_entry(genotype, EXPERIMENTS / f"{ini}.ini", name, path)


def random_genotype(folder, ini, seed):
    experiment = load(EXPERIMENTS / f"{ini}.ini")
    policy = problems.of(experiment).policy(experiment.policy)
    saved = policy.initial(seed)
    ones = [np.zeros(policy.spec.inputs), np.ones(policy.spec.inputs)]
    np.save(folder / "g.npy", np.concatenate([saved, *(ones if policy.spec.normalize else [])]))
    return folder / "g.npy"


def test_a_league_measures_ranks_and_shows(tmp_path):
    folder = tmp_path / "entries"
    entry(folder, ROBOTS / "planarhopper.npy", "planarhopper", "Ada")
    bo = entry(folder, random_genotype(tmp_path, "planarhopper", 1), "planarhopper", "<Bo>")
    bo.rename(folder / "bo.robot-1.npz")  # a second attempt, as Canvas names it
    entry(folder, random_genotype(tmp_path, "cartpole", 3), "cartpole")
    for seed, name in ((1, "Cy"), (2, "Dee")):
        entry(folder, random_genotype(tmp_path, "predprey", seed), "predprey", name)
    (folder / f"x{SUFFIX}").write_bytes(b"PK")
    page = tmp_path / "out" / "league.html"
    code, out, errors = call("league", str(folder), "-o", str(page))
    assert code == 0, errors
    assert f"not in the league: x{SUFFIX} is damaged, or no entry" in out
    text = page.read_text()
    assert "&lt;Bo&gt;" in text and "<Bo>" not in text and "anonymous" in text
    assert text.count("<iframe") == 3 and "http://" not in text.replace("http://www.w3.org", "")
    with open(page.with_suffix(".csv"), encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    hoppers = [row for row in rows if row["discipline"] == "hopper"]
    assert [row["name"] for row in hoppers] == ["Ada", "<Bo>"]
    assert 20 < float(hoppers[0]["result"]) < 25 > float(hoppers[1]["result"])
    assert {row["discipline"] for row in rows} == {"hopper", "cart-pole", "predator", "prey"}


def test_metres_and_poles_are_those_of_the_robots(tmp_path):
    hopper = read_entry(entry(tmp_path, ROBOTS / "planarhopper.npy", "planarhopper", "Ada"))
    native, policy, genotype, normalisation = hopper.robot()
    tape = native.engine(policy).record(genotype[None], normalisation, 1, 2, 1000)
    assert metres(hopper) == pytest.approx(tape["states"][-1, 0] - tape["states"][0, 0], abs=1.5)
    assert longest_pole(read_entry(balancing(tmp_path))) > 1.5


def balancing(folder):
    """A controller of CartPole after 30,000 steps."""
    run = Run(load(EXPERIMENTS / "cartpole.ini"), 106)
    run.limit = Limit(steps=30_000)
    while not run.limit.reached(run):
        run.advance(goes_on=True)
    run.settle()
    np.save(folder / "g.npy", run.record.bestg)
    return entry(folder, folder / "g.npy", "cartpole", "Gus")


def test_a_laboratory_tells_its_experiment(tmp_path):
    condition = load_lab(9).conditions[0]
    folder = tmp_path / "lab09" / "runs" / condition.name
    folder.mkdir(parents=True)
    experiment = condition.load()
    hopper = problems.of(experiment).policy(experiment.policy).initial(1)
    np.save(folder / "bestgS1.npy", hopper)
    code, out, errors = call("enter", str(folder / "bestgS1.npy"), "--name", "Ada", cwd=tmp_path)
    assert code == 0 and "Ada" in out, errors
    read = read_entry(tmp_path / f"bestgS1{SUFFIX}")
    assert (read.name, read.discipline) == ("Ada", "hopper")
    one_sentence(*call("enter", str(ROBOTS / "hopper.npy"), cwd=tmp_path)[::2], "add -f FILE.ini")
    one_sentence(*call("league", str(tmp_path / "lab09"))[::2], "holds no entries")


def spoiled(path, **arrays):
    with np.load(path) as read:
        kept = {key: read[key] for key in read.files}
    save_npz(path, {k: v for k, v in (kept | arrays).items() if v is not None})
    return path


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"genotype": None}, "lacks"),
        ({"name": 5.0}, "no name or experiment as text"),
        ({"name": np.array([{}], dtype=object)}, "damaged"),
        ({"experiment": "{"}, "cannot be read"),
        (
            {"experiment": '{"exp": {"environment": "os:system"}, "policy": {}}'},
            "has no discipline",
        ),
        ({"genotype": np.zeros(3)}, "cannot play: The genotype has shape"),
        ({"genotype": np.array(["a"])}, "cannot play"),
        ({"genotype": np.zeros(600_000)}, "more than 4 MB"),
    ],
)
def test_what_is_no_entry_is_refused_in_a_sentence(tmp_path, change, says):
    good = entry(tmp_path, ROBOTS / "planarhopper.npy", "planarhopper", "Ada")
    if change.get("genotype") is not None and change["genotype"].size > 9:
        np.savez_compressed(good, name="", experiment="", **change)
    else:
        spoiled(good, **change)
    with pytest.raises(Unusable, match=says):
        read_entry(good)


def test_a_network_that_fills_the_memory_is_refused(tmp_path):
    good = entry(tmp_path, ROBOTS / "planarhopper.npy", "planarhopper", "Ada")
    experiment = to_dict(load(EXPERIMENTS / "planarhopper.ini"))
    experiment["policy"]["nhiddens"] = 10**6
    spoiled(good, experiment=json.dumps(experiment))
    with pytest.raises(Unusable, match="nhiddens above 1000"):
        read_entry(good)


def test_ranks_and_means():
    one, two, three = (type("E", (), {"file": name})() for name in "abc")
    assert [(r.rank, r.entry.file) for r in ranked([one, two, three], [1.0, 3.0, 3.0])] == [
        (1, "b"),
        (1, "c"),
        (3, "a"),
    ]
    predators, prey = means(np.array([[1.0, 0.5], [0.25, 1.0]]))
    assert predators == [0.5, 0.25] and prey == [0.75, 0.5]


def test_equal_robots_are_said_whatever_their_names(tmp_path):
    for name, seed in (("Ada", 1), ("Bob", 1), ("Cy", 2), ("", 1)):
        genotype = random_genotype(tmp_path, "cartpole", seed)
        entry(tmp_path / "entries", genotype, "cartpole", name)
    (told,) = compete(tmp_path / "entries").equal
    ada, bob, nobody = (f"{each}-cartpole{SUFFIX}" for each in ("Ada", "Bob", "nobody"))
    assert told == f"The same robot: {ada} (Ada), {bob} (Bob), {nobody} (anonymous)."


def test_a_folder_that_is_not_there(tmp_path):
    with pytest.raises(BotschoolError, match="There is no folder"):
        compete(tmp_path / "none")
