"""PettingZoo environments at the command: runs, tournaments, films, and what is refused."""

import re

import numpy as np
import pytest

pytest.importorskip("pettingzoo")

from botschool import problems
from botschool.errors import BotschoolError
from botschool.policies.hyperparameters import PolicyConfig
from botschool.problems import Episodes
from duels import run, write


@pytest.fixture
def es(tmp_path, command):
    own = write(tmp_path)
    assert run(own, tmp_path / "run")
    return lambda *more: command("es", "-f", own, "-s", 3, "-o", tmp_path / "run", "-p", *more)


@pytest.mark.slow
def test_it_says_who_is_who(tmp_path, command):
    code, out, errors = command("es", "-f", write(tmp_path), "-o", tmp_path / "run")
    assert (code, errors) == (0, "")
    assert out.endswith("bestgS1.npy (predators are cat, prey are mouse)\n")


@pytest.mark.slow
def test_pairs_are_measured_and_watched(es, tmp_path):
    code, measured, errors = es("-g", "p-3-2")
    assert (code, errors) == (0, "")
    assert "predators are cat, prey are mouse" in measured and "fitness of these prey" in measured
    code, out, _ = es("-g", "P-3-2", "--replay", tmp_path / "duels.html")
    assert code == 0 and (tmp_path / "duels.html").stat().st_size > 1000
    shown = re.findall(r"(cat \d, mouse \d)  fitness (-?[\d.]+) of cat, (-?[\d.]+) of mouse", out)
    assert [pair for pair, _, _ in shown] == [f"cat {i}, mouse {k}" for i in (1, 2) for k in (1, 2)]
    assert f"mean fitness of the prey: {np.mean([float(m) for *_, m in shown]):.2f}" in out


@pytest.mark.slow
def test_the_best_of_both_are_filmed_with_their_neurons(es, tmp_path):
    best = tmp_path / "run" / "bestgS3.npy"
    code, out, errors = es("-g", best, "-d", "--video", tmp_path / "duel.mp4")
    assert (code, errors) == (0, "") and "cat: mean" in out and "mouse: mean" in out
    assert (tmp_path / "duel.mp4").stat().st_size > 1000


@pytest.mark.slow
def test_generations_meet(es, command, tmp_path):
    code, out, _ = es("-g", "m-3-1")
    assert code == 0 and "its prey" in out
    picture = tmp_path / "table.png"
    arguments = ("tournament", tmp_path / "run", "-f", tmp_path / "own.ini", "-o", picture)
    code, out, errors = command(*arguments, "-w", 2)
    assert (code, errors) == (0, "") and "Later prey" in out and picture.stat().st_size > 1000
    assert command(*arguments)[1] == out
    code, out, _ = es("-g", "c-S3G0.npy-S3G3.npy")
    assert code == 0 and "prey of B minus those of A" in out


@pytest.mark.parametrize(
    ("environment", "options", "says"),
    [
        ("duels:Crowd", "", ["has 3 agents (cat, mouse, dog), but two evolve", "options ="]),
        ("duels:Hermit", "", "has 1 agent (cat), but two evolve"),
        ("duels:Turns", "", "take turns"),
        ("duels:nothing", "", ["no ParallelEnv", "type NoneType"]),
        ("duels:board", "", ["type dict", "module:function"]),
        ("duels:broken", "", ["duels:broken cannot be made: no floor"]),
        ("duels:packaged", "", ["a_package_that_is_not_there", "pip install"]),
        ("duels:Duell", "", "no 'Duell' in duels; did you mean Duel?"),
        ("duels", "", "has no function parallel_env"),
        ("not_there:Duel", "", "no module not_there"),
        ("nothing/duel-v1", "", "no environment 'nothing/duel-v1' in PettingZoo"),
        ("tiny_envs:Tiny-v0", "", ["of one robot", "PettingZoo"]),
        ("duels:Duel", "pace=3", ["cannot be made with these options", "pace"]),
        ("duels:Duel", "fault", ["line 4: 'fault' cannot be read as options"]),
        ("duels:Duel", "fault='words'", ["of cat, observations are a Text space"]),
        ("duels:Duel", "fault='sequence'", ["of cat, actions are a Sequence space"]),
        ("duels:Duel", "fault='old'", ["reset", "no pair of observations"]),
        ("duels:Duel", "fault='nobody'", "no agent takes part"),
        ("duels:Duel", "fault='raises'", "step 1 of episode 0 of seed 3 (the floor is wet)"),
        ("duels:Duel", "fault='nan'", "a reward of nan at step 1 in episode 0 of seed 3"),
        ("duels:Duel", "fault='unpaid'", "a reward of None (NoneType"),
        ("duels:Duel", "fault='blind'", "no observation of cat"),
        ("duels:Seedless", "", ["reset", "unexpected keyword argument 'seed'"]),
        ("ErPredprey", "max_steps=5", "ErPredprey takes no options"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(environment, options, says, refused, tmp_path):
    path = write(tmp_path, environment, options=options)
    refused("es", "-f", path, "-s", 3, "-o", tmp_path / "run", says=says)


def test_games_of_others(tmp_path):
    """A module, an id, one whose agents act by turns but at the same time, two of three agents."""
    pytest.importorskip("mpe2")
    push = problems.make("mpe2.simple_push_v3", competitive=True)
    assert push.sides == ("adversary_0", "agent_0")
    assert [one.observations for one in push.interfaces] == [8, 19]
    with pytest.raises(BotschoolError, match=r"simple_adversary_v3 has 3 agents"):
        problems.make("mpe2.simple_adversary_v3", competitive=True)
    two = problems.make("mpe2.simple_adversary_v3", options="N=1", competitive=True)
    assert two.sides == ("adversary_0", "agent_0")
    for name in ("classic/rps-v2", "pettingzoo.classic.rps_v2"):
        game = problems.make(name, options="max_cycles=4", competitive=True)
        policy = game.policy(PolicyConfig(nrobots=2, heterogeneous=1, nhiddens=0, bias=1))
        rows = np.array([policy.initial(1, i) for i in range(5)])
        outcome = game.evaluate(policy, rows, None, Episodes.of(np.full(5, 1), 1), 20)
        assert (outcome.steps == 4).all() and (outcome.fitness.sum(axis=0) == 0).all()
        assert outcome.fitness.any()


def test_options_of_a_gymnasium_environment(tmp_path, refused):
    plain = problems.make("FrozenLake-v1", options="map_name='8x8', is_slippery=False")
    assert plain.interface.observations == 64
    path = write(tmp_path, "FrozenLake-v1", "SSS", "speed=3", {"nrobots": 1, "heterogeneous": 0})
    path.write_text(re.sub(r"(?s)\[ALGO\].*", "[ALGO]\npopsize = 2\n", path.read_text()))
    refused(
        "es", "-f", path, "-o", tmp_path / "run", says=["FrozenLake-v1 cannot be made", "speed"]
    )
