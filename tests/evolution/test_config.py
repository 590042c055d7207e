"""Experiment files: what loads, what is refused, and the sentence that a learner then reads."""

import json
import math
from dataclasses import asdict
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from botschool import config
from botschool.config import (
    Exp,
    Experiment,
    OpenAIESConfig,
    PolicyConfig,
    SSSConfig,
    describe,
    from_dict,
    load,
    to_dict,
)
from botschool.errors import BotschoolError

EXPERIMENTS = sorted((Path(__file__).parents[2] / "data" / "experiments").glob("*.ini"))


def text(policy="", algo="", exp="environment = CartPole-v1"):
    """An experiment file: [EXP] in line 1, [POLICY] from line 3, [ALGO] after it."""
    return f"[EXP]\n{exp}\n[POLICY]\n{policy}\n[ALGO]\n{algo}\n"


def write(folder, content, name="own.ini"):
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def refused(path):
    """The sentence with which `load` refuses, without the path that it must start with."""
    with pytest.raises(BotschoolError) as caught:
        load(path)
    sentence = str(caught.value)
    assert sentence.startswith(str(path))
    assert "\n" not in sentence and sentence[-1] in ".?" and sentence[-2] not in ".?"
    return sentence[len(str(path)) :]


def test_every_value_is_read_with_its_type(tmp_path):
    policy = "nrobots=2\nheterogeneous=1\nepisodes=3\npepisodes=7\nmaxsteps=1000.0\nnhiddens=1e2\n"
    policy += "nhiddens2=30\nnlayers=2\nbias=1\nout_type=4\nnbins=5\nafunction=3\nwinit=2\n"
    policy += "action_noise=2\naction_noise_range=5e-2\nnormalize=1\nclip=1\nwrange=.5"
    algo = "maxmsteps=0.25\nstepsize=1e-2\nsamplesize=250\nnoiseStdDev=2.E-2\nwdecay=2\n"
    algo += "symseed=0\nsaveeach=0.5"
    experiment = load(write(tmp_path, text(policy, algo)))
    assert experiment.policy == PolicyConfig(
        2, 1, 3, 7, 1000, 0, 100, 30, 2, 1, 4, 5, 0, 3, 2, 2, 0.05, 1, 1, 0.5
    )
    assert experiment.algo == OpenAIESConfig(
        maxmsteps=0.25,
        stepsize=0.01,
        samplesize=250,
        noiseStdDev=0.02,
        wdecay=2,
        symseed=0,
        saveeach=0.5,
    )
    assert experiment.path == tmp_path / "own.ini"
    for part in (experiment.policy, experiment.algo):
        for key, value in asdict(part).items():
            assert type(value) is type(getattr(type(part), key)), key


@pytest.mark.parametrize(
    "content",
    [
        "# head\n; head\n[exp]\nEnvironment=CartPole-v1\nALGO=sss\n[Policy]\n[algo]\nPopSize=8\n",
        text(algo="popsize = 8 # a comment", exp="environment = CartPole-v1 ; c\nalgo = Sss"),
        "[ALGO] # c\n\tpopsize\t=\t8\t; = c\n [ policy ]\n[EXP]\nalgo:SSS\nenvironment:CartPole-v1",
        "\ufeff[EXP]\nenvironment = CartPole-v1\nalgo = SSS\n[POLICY]\n[ALGO]\npopsize = 8",
        text(algo="popsize = 8", exp="environment = CartPole-v1\nalgo = SSS").replace("\n", "\r\n"),
        text(algo="popsize = 8", exp="environment = CartPole-v1\nalgo = SSS").replace("\n", "\r"),
        text(algo="popsize = 8 # \xe9", exp="environment = CartPole-v1\nalgo = SSS").encode(
            "latin-1"
        ),
        text(algo="popsize = 8 # \xe9", exp="environment = CartPole-v1\nalgo = SSS").encode(),
    ],
    ids=["capitals", "comments", "space", "bom", "crlf", "cr", "latin-1", "utf-8"],
)
def test_ways_to_write_a_file(tmp_path, content):
    experiment = load(write(tmp_path, content))
    assert experiment == Experiment(Exp("CartPole-v1", "SSS"), PolicyConfig(), SSSConfig(popsize=8))


@pytest.mark.parametrize(
    ("lines", "pepisodes"),
    [
        ("environment = CartPole-v1", 20),
        ("environment = botschool/SpatialAnt-v5\nalgo = sNES", 20),
        ("environment = CartPole-v1\nwrappers = TimeAwareObservation", 5),
        ("environment = LunarLander-v3", 5),
        ("environment = ErStaybehind\nalgo = coevo", 1),
    ],
)
def test_a_silent_file_post_evaluates_in_enough_episodes(lines, pepisodes, tmp_path):
    path = write(tmp_path, text(exp=lines))
    assert load(path).policy.pepisodes == pepisodes
    assert load(write(tmp_path, text("pepisodes = 1", exp=lines))).policy.pepisodes == 1


REFUSED = {
    "empty file": ("", "section [EXP] is missing", "add a line [EXP]", "environment = NAME"),
    "no environment": (text(exp=""), "environment is missing", "environment = NAME", "[EXP]"),
    "empty value": (text("bias ="), "line 4", "bias has no value", "0 (no) or 1 (yes)"),
    "quoted name": (text(exp="environment = 'X-v0'"), "line 2", "'X-v0'", "without quotes"),
    "unknown section": ("[EXP]\n[POLCY]\n", "line 2", "[POLCY] is unknown", "mean [POLICY]?"),
    "open bracket": ("[EXP\n", "line 1", "[EXP is no section", "brackets"),
    "section twice": (text("[exp]"), "line 4", "[EXP] starts a second time", "line 1", "under"),
    "before sections": ("\nbias = 1\n", "line 2", "bias = 1", "before the first section", "[EXP]"),
    "unknown key": (text("nhidens = 5"), "line 4", "nhidens is no hyper", "mean nhiddens?"),
    "wrong section": (text(algo="NHiddens = 5"), "line 6", "belongs in section [POLICY]", "move"),
    "other algorithm": (
        text(algo="popsize = 5"),
        "line 6",
        "popsize is a hyperparameter of CMA-ES, GA, SSS, archive, archivestar, coevo, "
        "coevo2, maxsolvestar, sNES and xNES, but",
        "remove the line, or set algo = CMA-ES",
    ),
    "key twice": (text("bias = 1\nBIAS = 0"), "line 5", "BIAS is given a second time", "line 4"),
    "no equals sign": (text("bias 1"), "line 4", "bias 1 lacks an = sign", "key = value"),
    "unknown algorithm": (text(exp="environment = X\nalgo = coev2"), "line 3", "mean coevo2?"),
    "word for a number": (
        text("nhiddens = ten"),
        "line 4",
        "nhiddens = ten is not a number",
        "a whole number from 0 to 10000",
    ),
    "fraction": (text("nhiddens = 1.5"), "line 4", "1.5 is not a whole number", "from 0 to 10000"),
    "comma": (text(algo="stepsize = 0,01"), "line 6", "0,01 is not a number", "point"),
    "foreign digits": (text("nhiddens = \u0663"), "not a number"),
    "nan": (text(algo="stepsize = nan"), "line 6", "nan is not a finite number", "above 0"),
    "long number": (text("maxsteps = " + "9" * 5000), "line 4", "999... is not a finite number"),
    "negative": (text("nhiddens = -3"), "nhiddens = -3 is out of range", "from 0 to 10000"),
    "choice": (
        text("architecture = 5"),
        "line 4: architecture = 5 is out of range",
        "0 (feed-forward), 1 (recurrent), 2 (fully recurrent), 3 (LSTM) or 4 (convolutional)",
    ),
    "odd population": (
        text(algo="popsize = 5", exp="environment = X\nalgo = SSS"),
        "line 7",
        "popsize = 5 is odd",
        "popsize = 6",
    ),
    "unknown choice": (
        text(algo="evolving = beste", exp="environment = X\nalgo = coevo2"),
        "line 7: evolving = beste is unknown: did you mean best?",
    ),
    "second layer of one": (text("nhiddens2 = 5"), "line 4", "needs nlayers = 2", "nlayers is 1"),
    "too many recurrent neurons": (
        text("nlayers = 2\narchitecture = 1\nnhiddens = 5001"),
        "line 6",
        "one hidden layer",
        "10002",
        "lower nhiddens",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refused_content(tmp_path, case):
    content, *parts = REFUSED[case]
    sentence = refused(write(tmp_path, content))
    for part in parts:
        assert part in sentence


@pytest.mark.parametrize(
    "data",
    [b"\x93NUMPY\x01\x00", "[EXP]".encode("utf-16"), b"[EXP]\n#" + b"c" * 1_000_000],
    ids=["array", "utf-16", "huge"],
)
def test_not_a_text_file(tmp_path, data):
    assert "no experiment file: give an .ini file" in refused(write(tmp_path, data))


def test_missing_file_names_those_in_its_folder(tmp_path):
    write(tmp_path, "", "acrobot.ini")
    write(tmp_path, "", "pendulum.INI")
    write(tmp_path, "", "notes.txt")
    sentence = refused(tmp_path / "zzz.ini")
    assert "no such file" in sentence and "holds acrobot.ini, pendulum.INI." in sentence
    assert "did you mean acrobot.ini (" in refused(tmp_path / "acrobt.ini")
    assert "acrobot.ini" in refused(tmp_path) and "is a folder" in refused(tmp_path)


@pytest.mark.parametrize("path", EXPERIMENTS, ids=lambda path: path.stem)
def test_experiments_of_the_repository(path):
    experiment = load(path)
    assert from_dict(json.loads(json.dumps(to_dict(experiment)))) == experiment


@pytest.mark.parametrize(
    "data, part",
    [
        ([], "nested dict"),
        ({"exp": 3}, "nested dict"),
        ({}, "[EXP] is missing"),
        ({"exp": {"environment": None}, "policy": {}, "algo": {}}, "not a name"),
        ({"exp": {"environment": "X", "algo": []}, "policy": {}, "algo": {}}, "unknown"),
        ({"exp": {"environment": "X"}, "policy": {"x": 1}, "algo": {}}, "no hyperparameter"),
        ({"exp": {"environment": "X"}, "policy": {"bias": True}, "algo": {}}, "not a number"),
        ({"exp": {"environment": "X"}, "policy": {"bias": 10**400}, "algo": {}}, "not a finite"),
        ({"exp": {"environment": "X"}, "policy": {"wrange": math.nan}, "algo": {}}, "not a finite"),
        ({"exp": {"environment": "X"}, "policy": {"nhiddens2": 1}, "algo": {}}, "nlayers = 2"),
    ],
)
def test_refused_dict(data, part):
    with pytest.raises(BotschoolError, match=r"^run11\.npz: .*") as caught:
        from_dict(data, "run11.npz")
    assert part in str(caught.value)


def test_every_default_satisfies_its_own_limits():
    for algo in config.ALGORITHMS:
        parts = {"exp": {"environment": "X", "algo": algo}, "policy": {}, "algo": {}}
        assert from_dict(to_dict(from_dict(parts))) == from_dict(parts)


KEYS = [name for _, name, _, _ in describe()] + ["mutation", "NHIDDENS", "nhidens", "", "x y"]
VALUES = ["0", "1", "2", "-1", "1e400", "nan", "1.5", "CartPole-v1", "SSS", "coevo2", "", "a b"]
LINES = st.one_of(
    st.sampled_from(["[EXP]", "[POLICY]", "[ALGO]", "[exp", "[X]", "# c", "; c", "", "="]),
    st.builds("{} {} {}".format, st.sampled_from(KEYS), st.sampled_from("=: "), st.text()),
    st.builds("{} = {}".format, st.sampled_from(KEYS), st.sampled_from(VALUES)),
    st.text(),
)
QUICK = settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)


def loads_or_refuses(path):
    try:
        experiment = load(path)
    except BotschoolError as error:
        assert str(error).startswith(str(path)) and "\n" not in str(error)
    else:
        assert from_dict(to_dict(experiment)) == experiment


@pytest.mark.slow
@QUICK
@given(st.lists(LINES, max_size=8), st.booleans())
def test_any_text_loads_or_is_refused(tmp_path, lines, headed):
    head = ["[EXP]", "environment = CartPole-v1", "[ALGO]", "[POLICY]"] if headed else []
    content = "\n".join(head + lines).encode("utf-8", "surrogatepass")
    loads_or_refuses(write(tmp_path, content))


def test_each_hyperparameter_is_described_with_its_choices():
    """Names and defaults are those of the specification: tests/house/test_documents.py."""
    helps = {name: help for _, name, _, help in describe()}
    assert all(len(help) > 10 and "\n" not in help for help in helps.values())
    assert helps["winit"].endswith("0 (Xavier), 1 (norm-incoming) or 2 (uniform)")
