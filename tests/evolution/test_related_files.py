"""Experiment files of evorobotpy3 and competitive-evolution: they run, or a sentence says what to
write instead (docs/specification.md, "Files of related projects").
"""

from dataclasses import fields

import numpy as np
import pytest

from botschool import config, sisters
from botschool.evolution.algorithm import ALGORITHMS
from botschool.wrappers import keywords

SIDES = "nrobots = 2\nheterogeneous = 1\nnhiddens = 3\nmaxsteps = 20\n"


def text(algo="", policy="", environment="CartPole-v1", more=""):
    """An experiment file whose [ALGO] begins in line 3."""
    exp = f"[EXP]\nenvironment = {environment}\n"
    return f"{exp}[ALGO]\n{algo}\n[POLICY]\n{policy}\n{more}"


def load(folder, content, algo=None):
    path = folder / "theirs.ini"
    if algo:
        content = content.replace("[EXP]", f"[EXP]\nalgo = {algo}")
    path.write_text(content)
    return config.load(path)


@pytest.mark.slow
@pytest.mark.parametrize("differentiated", ["", "seldifferentiated = 1", "seldifferentiated = 0"])
def test_archive_may_name_what_only_archivestar_uses(differentiated, tmp_path, command):
    """The two keys of the published file change nothing where one centre evolves."""
    keys = {"plain": "", "more": f"preferential = 1\n{differentiated}\n"}
    fast = "samplesize = 2\nncompetitors = 2\nwdecay = 1\npopsize = 1\ncheckoverfiteveryn = 0\n"
    for name, more in keys.items():
        load(tmp_path, text(fast + more, SIDES, "ErPredprey"), "archive")
        arguments = ("-o", tmp_path / name, "--generations", 3)
        assert command("es", "-f", tmp_path / "theirs.ini", *arguments)[0] == 0
    first, second = (np.load(tmp_path / name / "bestgS1.npy") for name in keys)
    np.testing.assert_array_equal(first, second)


@pytest.mark.parametrize("algo", ["CMA-ES", "xNES", "sNES"])
def test_batchsize_is_popsize(algo, tmp_path):
    assert load(tmp_path, text("batchSize = 12"), algo).algo.popsize == 12


@pytest.mark.parametrize(("theirs", "ours"), sisters.SAME.items())
def test_algorithms_with_another_name(theirs, ours, tmp_path):
    experiment = load(tmp_path, text("popsize = 20\nselsize = 5", SIDES, "ErPredprey"), theirs)
    assert experiment.exp.algo == ours


def test_the_section_of_the_environment_gives_its_options(tmp_path):
    lines = "[ENV]\nmap_name = 8x8\nis_slippery = False\nn = 0.5\nsizes = [1, 2]\nverbose = 1\n"
    experiment = load(tmp_path, text(environment="FrozenLake-v1", more=lines))
    options = {"map_name": "8x8", "is_slippery": False, "n": 0.5, "sizes": [1, 2], "verbose": 1}
    assert keywords(experiment.exp.options) == options
    assert config.from_dict(config.to_dict(experiment)) == experiment


@pytest.mark.parametrize("key", sisters.NEEDLESS)
def test_keys_that_are_not_needed_are_left_out_and_said(key, tmp_path):
    experiment = load(tmp_path, text(f"popsize = 20\n{key} = 1"), "GA")
    assert experiment == load(tmp_path, text("popsize = 20"), "GA")
    experiment = load(tmp_path, text(f"popsize = 20\n{key} = 1"), "GA")
    assert len(experiment.notes) == 1 and f"line 6: {key} is left out" in experiment.notes[0]


def test_no_name_of_ours_is_among_theirs():
    ours = {f.name for entry in ALGORITHMS.values() for f in fields(entry.config)}
    ours |= {f.name for f in (*fields(config.Exp), *fields(config.PolicyConfig))}
    assert not [key for key in ours if key in sisters.NEEDLESS or sisters.instead("key", key)]
    assert not [
        algo for algo in ALGORITHMS if algo in sisters.SAME or sisters.instead("algo", algo)
    ]


@pytest.mark.parametrize("algo", sisters.INSTEAD["algo"])
@pytest.mark.parametrize("written", [str.lower, str])
def test_every_other_algorithm_has_a_remedy(algo, written, tmp_path, refused):
    path = tmp_path / "theirs.ini"
    path.write_text(text().replace("[EXP]", f"[EXP]\nalgo = {written(algo)}"))
    sentence = refused("es", "-f", path, says=["line 2", f"algo = {written(algo)}"])
    named = [name for name in ALGORITHMS if f"algo = {name}" in sentence]
    assert named or f"botschool rl train --algo {algo.lower()} --env" in sentence


@pytest.mark.parametrize("key", sisters.INSTEAD["key"])
@pytest.mark.parametrize("algo", ["GA", "SSS"])
def test_every_other_key_has_a_remedy(key, algo, tmp_path, refused):
    path = tmp_path / "theirs.ini"
    path.write_text(text(f"{key} = 1").replace("[EXP]", f"[EXP]\nalgo = {algo}"))
    refused("es", "-f", path, says=["line 5", f"{key} is no hyperparameter here: "])


@pytest.mark.parametrize("environment", [*sisters.NEAREST, "evorobotpy_envs/DoublePole-v0"])
@pytest.mark.parametrize("algo", ["OpenAI-ES", "coevo2"])
def test_every_missing_environment_names_the_nearest(environment, algo, tmp_path, refused):
    path = tmp_path / "theirs.ini"
    path.write_text(text("", SIDES, environment).replace("[EXP]", f"[EXP]\nalgo = {algo}"))
    none = sisters.NEAREST.get(environment) == ""
    says = [environment, "evorobotpy3", "nothing near" if none else "the nearest is"]
    refused("es", "-f", path, "-o", tmp_path / "no", says=says)


@pytest.mark.parametrize("architecture", [1, 2, 3])
@pytest.mark.parametrize("layers", ["nlayers = 3", "nlayers = 2\nnhiddens2 = 4"])
def test_a_recurrent_network_keeps_all_neurons(architecture, layers, tmp_path, command):
    policy = f"architecture = {architecture}\nnhiddens = 5\nmaxsteps = 20\n{layers}\n"
    path = tmp_path / "own.ini"
    path.write_text(text("samplesize = 2", policy, "ErDpole"))
    neurons = 5 * (3 if "3" in layers else 2)
    arguments = ("es", "-f", path, "--generations", 2)
    code, _, errors = command(*arguments, "-o", tmp_path / "theirs")
    assert code == 0 and f"nhiddens x nlayers = {neurons} neurons" in errors
    code = command(*arguments[:3], "--generations", 3, "-o", tmp_path / "theirs", "--resume")[0]
    assert code == 0
    own = f"architecture = {architecture}\nnhiddens = {neurons}\nmaxsteps = 20\n"
    path.write_text(text("samplesize = 2", own, "ErDpole"))
    code, _, errors = command("es", "-f", path, "--generations", 3, "-o", tmp_path / "ours")
    assert (code, errors) == (0, "")
    first, second = (np.load(tmp_path / name / "bestgS1.npy") for name in ("theirs", "ours"))
    np.testing.assert_array_equal(first, second)
