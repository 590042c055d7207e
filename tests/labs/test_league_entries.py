"""A league plays whatever else lies in its folder: damaged entries are refused one by one."""

import io
import json
import os
import struct
import zipfile

import numpy as np
import pytest

from botschool import problems
from botschool.config import load, to_dict
from botschool.labs import league
from botschool.labs.entries import SUFFIX
from botschool.labs.league import compete, in_turn
from botschool.paths import course_root
from odd_arrays import GENOTYPE, HEADERS, HOPPER, npy, shaped
from running import call, one_sentence

EXPERIMENTS = course_root() / "data" / "experiments"


def about(ini="planarhopper", **policy):
    told = to_dict(load(EXPERIMENTS / f"{ini}.ini"))
    return json.dumps({"exp": told["exp"], "policy": told["policy"] | policy})


def packed(members=(), method=zipfile.ZIP_STORED, **changed):
    """Return an entry whose members are changed; members: more of them."""
    parts = {"name": npy("Ada"), "experiment": npy(about()), "genotype": npy(GENOTYPE)} | changed
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", method) as archive:
        for name, content in [*((f"{k}.npy", v) for k, v in parts.items()), *members]:
            archive.writestr(name, content)
    return stream.getvalue()


def flagged(at, value, content=None):
    """Return an entry with other bytes in each header: `at` of a central one, less 2 of a local."""
    content = bytearray(content or packed())
    for sign, less in ((b"PK\1\2", 0), (b"PK\3\4", 2)):
        found = content.find(sign)
        while found >= 0:
            content[found + at - less : found + at - less + len(value)] = value
            found = content.find(sign, found + 4)
    return bytes(content)


def with_name(*letters):
    code = np.array(letters, dtype="<u4").tobytes()
    return shaped("()", f"'<U{len(letters)}'")[:-8] + code


ZIPS = {
    "empty": b"",
    "no zip": b"PK",
    "cut": packed()[:-30],
    "encrypted": flagged(8, b"\1\0"),
    "other method": flagged(10, struct.pack("<H", 99)),
    "another CRC": flagged(16, b"\1\2\3\4"),
    "damaged deflate": flagged(10, struct.pack("<H", 8)),
    "lzma": packed(method=zipfile.ZIP_LZMA),
    "unpacks to 100 MB": packed(method=zipfile.ZIP_DEFLATED, genotype=b"\0" * 10**8),
    "too many": packed([(f"{i}", b"") for i in range(2000)]),
    "an empty name": packed(name=b""),
    "name of numbers": packed(name=npy(5.0)),
    "letters that do not exist": packed(name=with_name(0x7FFFFFFF)),
    "experiment of brackets": packed(experiment=npy("[" * 100_000)),
    "experiment of digits": packed(experiment=npy('{"exp": ' + "1" * 5000 + "}")),
    "no experiment": packed(experiment=npy("null")),
    "infinite neurons": packed(experiment=npy(about(nhiddens=float("inf")))),
    "a list of neurons": packed(experiment=npy(about(nhiddens=[5]))),
    "minus neurons": packed(experiment=npy(about(nhiddens=-5))),
    "half a letter": packed(experiment=npy(about(afunction="\ud800"))),
    "unknown key": packed(experiment=npy(about(**{"\ud800\n": 1}))),
}
PLAYS = {
    "lone surrogate": packed(name=with_name(0xD800, 65)),
    "line breaks": packed(name=npy("A\nB\0<b>")),
    "long name": packed(name=npy("A" * 10_000)),
    "another member": packed([("../../x", b""), ("name.npy/x", b"")]),
    "2 GB that are not there": flagged(24, struct.pack("<I", 2**31)),
    "twice": packed([("name.npy", npy("Bo"))]),
    "deflated": packed(method=zipfile.ZIP_DEFLATED),
    "large numbers": packed(genotype=npy(GENOTYPE * 1e300)),
}


def test_each_damaged_entry_is_refused_alone(tmp_path):
    folder = tmp_path / "entries"
    folder.mkdir()
    bad = {f"h {name}": packed(genotype=content) for name, content in HEADERS.items()}
    bad |= {f"z {name}": content for name, content in ZIPS.items()}
    good = {f"p {name}": content for name, content in PLAYS.items()}
    for name, content in (bad | good | {"zoe": packed()}).items():
        (folder / f"{name}{SUFFIX}").write_bytes(content)
    (folder / f"folder{SUFFIX}").mkdir()
    (folder / f"link{SUFFIX}").symlink_to(HOPPER)
    os.mkfifo(folder / f"pipe{SUFFIX}")
    (folder / os.fsdecode(b"\xff" + SUFFIX.encode())).write_bytes(b"PK")
    code, _, errors = call("league", str(folder), "-o", str(tmp_path / "league.html"))
    assert code == 0 and not errors, errors
    found = compete(folder)
    played = {each.entry.file for each in found.tables["hopper"]}
    assert played == {f"{name}{SUFFIX}" for name in [*good, "zoe"]}
    refused = [sentence.split(SUFFIX)[0] for sentence in found.refused]
    assert sorted(refused) == sorted([*bad, "folder", "link", "pipe", "\udcff"])
    assert all(len(sentence) < 400 for sentence in found.refused)


def test_files_of_one_folder_push_nobody_out(tmp_path):
    for name, count in (("aaa", 1200), ("zoe", 1)):
        (tmp_path / name).mkdir()
        for number in range(count):
            (tmp_path / name / f"{number}{SUFFIX}").write_bytes(b"")
    (tmp_path / "zoe" / f"0{SUFFIX}").write_bytes(packed())
    assert in_turn(tmp_path)[1].parent.name == "zoe"
    code, out, _ = call("league", str(tmp_path), "-o", str(tmp_path / "league.html"))
    assert code == 0 and "hopper: 1 robots" in out and "1150 more files" in out


def test_two_hunters_of_the_same_file_name_meet(tmp_path):
    """Entries are compared by identity, not number by number."""
    experiment = load(EXPERIMENTS / "predprey.ini")
    policy = problems.of(experiment).policy(experiment.policy)
    for seed in (1, 2):
        (tmp_path / str(seed)).mkdir()
        genotype = npy(policy.initial(seed))
        content = packed(name=npy(""), experiment=npy(about("predprey")), genotype=genotype)
        (tmp_path / str(seed) / f"bestgS1{SUFFIX}").write_bytes(content)
    code, out, errors = call("league", str(tmp_path), "-o", str(tmp_path / "league.html"))
    assert code == 0 and "chases: 2 pairs" in out, errors


@pytest.mark.parametrize("name", ["PK", "unary signs", "half a string", "huge shape", "npz"])
def test_what_is_no_genotype_is_not_entered(name, tmp_path):
    content = HEADERS | {"npz": packed()}
    (tmp_path / "bestgS1.npy").write_bytes(content[name])
    ini = str(EXPERIMENTS / "planarhopper.ini")
    code, _, errors = call("enter", "bestgS1.npy", "-f", ini, cwd=tmp_path)
    one_sentence(code, errors, "bestgS1.npy is not a genotype")


def test_a_robot_that_cannot_be_measured_is_told(tmp_path, monkeypatch):
    (tmp_path / f"x{SUFFIX}").write_bytes(packed())
    for measure in (lambda entry: float("nan"), lambda entry: [][0]):
        monkeypatch.setitem(league.MEASURES, "hopper", measure)
        found = compete(tmp_path)
        assert not found.tables and "cannot play" in found.refused[0]
