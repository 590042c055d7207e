"""The league: entries that are made, measured, ranked and shown; what is none is refused alone."""

import csv
import io
import json
import os
import struct
import zipfile

import numpy as np
import pytest

from botschool import problems
from botschool.config import load, to_dict
from botschool.evolution.limit import Limit
from botschool.evolution.run import Run
from botschool.labs.declare import load_lab
from botschool.labs.entries import SUFFIX, Unusable, read_entry, write_entry
from botschool.labs.league import compete, in_turn, longest_pole, metres
from botschool.paths import course_root
from odd_arrays import GENOTYPE, HEADERS, HOPPER, npy, shaped
from running import one_sentence

EXPERIMENTS = course_root() / "data" / "experiments"
ROBOTS = course_root() / "data" / "genotypes"


def entry(folder, genotype, ini, name=""):
    """The entry of a saved robot, as `botschool enter` makes it."""
    folder.mkdir(exist_ok=True)
    path = folder / f"{name or 'nobody'}-{ini}{SUFFIX}"
    return write_entry(genotype, EXPERIMENTS / f"{ini}.ini", name, path)


def random_genotype(folder, ini, seed):
    experiment = load(EXPERIMENTS / f"{ini}.ini")
    policy = problems.of(experiment).policy(experiment.policy)
    saved = policy.initial(seed)
    ones = [np.zeros(policy.spec.inputs), np.ones(policy.spec.inputs)]
    np.save(folder / "g.npy", np.concatenate([saved, *(ones if policy.spec.normalize else [])]))
    return folder / "g.npy"


@pytest.mark.slow
def test_a_league_measures_ranks_and_shows(command, tmp_path):
    folder, page = tmp_path / "entries", tmp_path / "out" / "league.html"
    entry(folder, ROBOTS / "planarhopper.npy", "planarhopper", "Ada")
    bo = entry(folder, random_genotype(tmp_path, "planarhopper", 1), "planarhopper", "<Bo>")
    bo.rename(folder / "bo.robot-1.npz")  # a second attempt, as Canvas names it
    for name in ("Ada", "Bob", ""):
        entry(folder, random_genotype(tmp_path, "cartpole", 3), "cartpole", name)
    for seed in (1, 2):  # of the same file name
        cy = entry(tmp_path, random_genotype(tmp_path, "predprey", seed), "predprey", "Cy")
        (folder / str(seed)).mkdir()
        cy.rename(folder / str(seed) / cy.name)
    (folder / f"x{SUFFIX}").write_bytes(b"PK")
    code, out, errors = command("league", folder, "-o", page)
    assert code == 0 and "chases: 2 pairs" in out, errors
    assert f"not in the league: x{SUFFIX} is damaged, or no entry" in out
    ada, bob, nobody = (f"{each}-cartpole{SUFFIX}" for each in ("Ada", "Bob", "nobody"))
    assert f"The same robot: {ada} (Ada), {bob} (Bob), {nobody} (anonymous)." in out
    text = page.read_text()
    assert "&lt;Bo&gt;" in text and "<Bo>" not in text and "anonymous" in text
    assert text.count("<iframe") == 3 and "http://" not in text.replace("http://www.w3.org", "")
    with open(page.with_suffix(".csv"), encoding="utf-8-sig", newline="") as file:
        rows = list(csv.DictReader(file))
    hoppers = [row for row in rows if row["discipline"] == "hopper"]
    assert [(row["rank"], row["name"]) for row in hoppers] == [("1", "Ada"), ("2", "<Bo>")]
    assert 20 < float(hoppers[0]["result"]) < 25 > float(hoppers[1]["result"])
    assert {row["rank"] for row in rows if row["discipline"] == "cart-pole"} == {"1"}
    assert {row["discipline"] for row in rows} == {"hopper", "cart-pole", "predator", "prey"}
    chases = [float(row["result"]) for row in rows if row["discipline"] in ("predator", "prey")]
    assert len(chases) == 4 and all(0 <= result <= 1 for result in chases)


@pytest.mark.slow
def test_metres_and_poles_are_those_of_the_robots(tmp_path):
    hopper = read_entry(entry(tmp_path, ROBOTS / "planarhopper.npy", "planarhopper", "Ada"))
    native, policy, genotype, normalisation = hopper.robot()
    tape = native.engine(policy).record(genotype[None], normalisation, 1, 2, 1000)
    assert metres(hopper) == pytest.approx(tape["states"][-1, 0] - tape["states"][0, 0], abs=1.5)
    run = Run(load(EXPERIMENTS / "cartpole.ini"), 106)
    run.limit = Limit(steps=30_000)
    while not run.limit.reached(run):
        run.advance()
    np.save(tmp_path / "g.npy", run.record.bestg)
    assert longest_pole(read_entry(entry(tmp_path, tmp_path / "g.npy", "cartpole", "Gus"))) > 1.5


@pytest.mark.slow
def test_a_laboratory_tells_its_experiment(command, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    condition = load_lab(9).conditions[0]
    folder = tmp_path / "lab09" / "runs" / condition.name
    folder.mkdir(parents=True)
    experiment = condition.load()
    hopper = problems.of(experiment).policy(experiment.policy).initial(1)
    np.save(folder / "bestgS1.npy", hopper)
    code, out, errors = command("enter", folder / "bestgS1.npy", "--name", "Ada")
    assert code == 0 and "Ada" in out, errors
    read = read_entry(tmp_path / f"bestgS1{SUFFIX}")
    assert (read.name, read.discipline) == ("Ada", "hopper")
    one_sentence(*command("enter", ROBOTS / "hopper.npy")[::2], "add -f FILE.ini")
    one_sentence(*command("league", tmp_path / "lab09")[::2], "holds no entries")
    one_sentence(*command("league", tmp_path / "none")[::2], "There is no folder")
    ini = EXPERIMENTS / "planarhopper.ini"
    for name in ("PK", "unary signs", "half a string", "huge shape"):
        (tmp_path / "bestgS1.npy").write_bytes(HEADERS[name])
        code, _, errors = command("enter", "bestgS1.npy", "-f", ini)
        one_sentence(code, errors, "bestgS1.npy is not a genotype")


# --- what is no entry
def about(ini="planarhopper", **policy):
    told = to_dict(load(EXPERIMENTS / f"{ini}.ini"))
    return json.dumps({"exp": told["exp"], "policy": told["policy"] | policy})


def packed(members=(), method=zipfile.ZIP_STORED, **changed):
    """Return an entry whose members are changed, None: left out; members: more of them."""
    parts = {"name": npy("Ada"), "experiment": npy(about()), "genotype": npy(GENOTYPE)} | changed
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, content in [*((f"{k}.npy", v) for k, v in parts.items()), *members]:
            if content is not None:
                archive.writestr(name, content)
    return stream.getvalue()


def flagged(at, value):
    """Return an entry with other bytes in each header: `at` of a central one, less 2 of a local."""
    content = bytearray(packed())
    for sign, less in ((b"PK\1\2", 0), (b"PK\3\4", 2)):
        found = content.find(sign)
        while found >= 0:
            content[found + at - less : found + at - less + len(value)] = value
            found = content.find(sign, found + 4)
    return bytes(content)


def with_name(*letters):
    code = np.array(letters, dtype="<u4").tobytes()
    return shaped("()", f"'<U{len(letters)}'")[:-8] + code


SYSTEM = '{"exp": {"environment": "os:system"}, "policy": {}}'
BAD = {
    "empty": (b"", "is damaged, or no entry"),
    "no zip": (b"PK", "is damaged, or no entry"),
    "cut": (packed()[:-30], "is damaged, or no entry"),
    "encrypted": (flagged(8, b"\1\0"), "is damaged, or no entry"),
    "other method": (flagged(10, struct.pack("<H", 99)), "is damaged, or no entry"),
    "another CRC": (flagged(16, b"\1\2\3\4"), "is damaged, or no entry"),
    "lzma": (packed(method=zipfile.ZIP_LZMA), "another compression"),
    "100 MB": (packed(method=zipfile.ZIP_DEFLATED, genotype=b"\0" * 10**8), "more than 4 MB"),
    "too many": (packed([(f"{i}", b"") for i in range(2000)]), "too many arrays"),
    "no genotype": (packed(genotype=None), "lacks"),
    "three numbers": (packed(genotype=npy(np.zeros(3))), "cannot play: The genotype has shape"),
    "name of numbers": (packed(name=npy(5.0)), "no name or experiment as text"),
    "letters that do not exist": (packed(name=with_name(0x7FFFFFFF)), "cannot play"),
    "experiment of brackets": (packed(experiment=npy("[" * 100_000)), "cannot be read"),
    "experiment of digits": (packed(experiment=npy('{"exp": ' + "1" * 5000 + "}")), "be read"),
    "another environment": (packed(experiment=npy(SYSTEM)), "has no discipline"),
    "a million neurons": (packed(experiment=npy(about(nhiddens=10**6))), "nhiddens above 1000"),
    "infinite neurons": (packed(experiment=npy(about(nhiddens=float("inf")))), "nhiddens above"),
    "minus neurons": (packed(experiment=npy(about(nhiddens=-5))), "cannot play"),
    "half a letter": (packed(experiment=npy(about(afunction="\ud800"))), "cannot play"),
    "unknown key": (packed(experiment=npy(about(**{"\ud800\n": 1}))), "cannot play"),
}
PLAYS = {
    "lone surrogate": packed(name=with_name(0xD800, 65)),
    "line breaks": packed(name=npy("A\nB\0<b>")),
    "long name": packed(name=npy("A" * 10_000)),
    "another member": packed([("../../x", b""), ("name.npy/x", b"")]),
    "2 GB that are not there": flagged(24, struct.pack("<I", 2**31)),
    "deflated": packed(method=zipfile.ZIP_DEFLATED),
    "large numbers": packed(genotype=npy(GENOTYPE * 1e300)),
}


@pytest.mark.parametrize("name", BAD)
def test_what_is_no_entry_is_refused_in_a_sentence(tmp_path, name):
    content, says = BAD[name]
    (tmp_path / f"x{SUFFIX}").write_bytes(content)
    with pytest.raises(Unusable, match=says) as refused:
        read_entry(tmp_path / f"x{SUFFIX}")
    assert len(str(refused.value)) < 400


@pytest.mark.slow
def test_each_damaged_entry_is_refused_alone(tmp_path):
    bad = {f"h {name}": packed(genotype=content) for name, content in HEADERS.items()}
    bad |= {f"z {name}": content for name, (content, _) in BAD.items()}
    good = {f"p {name}": content for name, content in PLAYS.items()}
    for name, content in (bad | good | {"zoe": packed()}).items():
        (tmp_path / f"{name}{SUFFIX}").write_bytes(content)
    (tmp_path / f"folder{SUFFIX}").mkdir()
    (tmp_path / f"link{SUFFIX}").symlink_to(HOPPER)
    os.mkfifo(tmp_path / f"pipe{SUFFIX}")
    (tmp_path / os.fsdecode(b"\xff" + SUFFIX.encode())).write_bytes(b"PK")
    found = compete(tmp_path)
    played = {each.entry.file for each in found.tables["hopper"]}
    assert played == {f"{name}{SUFFIX}" for name in [*good, "zoe"]}
    refused = [sentence.split(SUFFIX)[0] for sentence in found.refused]
    assert sorted(refused) == sorted([*bad, "folder", "link", "pipe", "\udcff"])


@pytest.mark.slow
def test_files_of_one_folder_push_nobody_out(command, tmp_path):
    for name, count in (("aaa", 1200), ("zoe", 1)):
        (tmp_path / name).mkdir()
        for number in range(count):
            (tmp_path / name / f"{number}{SUFFIX}").write_bytes(b"")
    (tmp_path / "zoe" / f"0{SUFFIX}").write_bytes(packed())
    assert in_turn(tmp_path)[1].parent.name == "zoe"
    code, out, _ = command("league", tmp_path, "-o", tmp_path / "league.html")
    assert code == 0 and "hopper: 1 robots" in out and "1150 more files" in out
