"""PettingZoo environments of two agents co-evolve (docs/specification.md, "Two sides")."""

import importlib
import re
import sys
from functools import partial

import numpy as np
import pytest

pytest.importorskip("pettingzoo")

import tiny_game
from botschool import _core, config, problems
from botschool.analysis.tournament import Contest, play, summarised
from botschool.errors import BotschoolError
from botschool.evolution.algorithm import ALGORITHMS as ALGORITHMS_BY_NAME
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import evolve
from botschool.hyperparameters import PolicyConfig
from botschool.problems import Episodes
from running import TESTS, contents, same

FACE = "botschool.envs.predprey"
ALGORITHMS = {
    "coevo2": {"ngenerations": 3, "popsize": 4, "selsize": 2, "samplesize": 2, "saveeach": 1},
    "archive": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "ncompetitors": 3},
    "archivestar": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "popsize": 2}
    | {"ncompetitors": 4, "seldifferentiated": 0, "preferential": 2},
    "maxsolvestar": {"ngenerations": 6, "samplesize": 2, "archivelen": 4, "ncompetitors": 3},
}


@pytest.fixture(autouse=True)
def own_environments(monkeypatch):
    monkeypatch.syspath_prepend(TESTS)


def write(folder, environment="tiny_duels:Duel", algo="coevo2", options="", policy=None):
    """Writes FOLDER/own.ini, a very small experiment. Gives its path."""
    policy = {"nrobots": 2, "heterogeneous": 1, "maxsteps": 20, "nhiddens": 3} | (policy or {})
    algorithm = {"noiseStdDev": 0.5, "stepsize": 0.3, **ALGORITHMS.get(algo, {})}
    lines = ["[EXP]", f"environment = {environment}", f"algo = {algo}", f"options = {options}"]
    lines += ["[POLICY]", *(f"{key} = {value}" for key, value in policy.items())]
    lines += ["[ALGO]", *(f"{key} = {value}" for key, value in algorithm.items())]
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "own.ini").write_text("\n".join(lines) + "\n")
    return folder / "own.ini"


def run(path, folder, workers=1, resume=False, **limits):
    folder.mkdir(exist_ok=True)
    return evolve(Coevolution(config.load(path), 3, workers), folder, resume=resume, **limits)


def duel(options="", **policy):
    problem = problems.make("tiny_duels:Duel", options=options, competitive=True)
    return problem, problem.policy(PolicyConfig(nrobots=2, heterogeneous=1, **policy))


# networks of two sizes


def test_each_side_has_a_network_for_what_it_sees_and_does():
    problem, policy = duel(nhiddens=4, bias=1)
    assert problem.sides == ("cat", "mouse")
    assert policy.sizes == [4 * 3 + 4 + 4 + 1, 4 * 3 + 4 * 5 + 4 + 5]
    assert policy.nparameters == max(policy.sizes) and policy.neurons == ([3, 3], [1, 5])
    first = policy.initial(7, 2)
    assert first.shape == (2 * policy.nparameters,)
    assert (first[policy.sizes[0] : policy.nparameters] == 0).all()


def test_what_lies_beyond_a_network_means_nothing():
    problem, policy = duel(nhiddens=4)
    rows = np.array([policy.initial(1, i) for i in range(3)])
    changed = rows.copy()
    changed[:, policy.sizes[0] : policy.nparameters] = 99
    assert (changed != rows).any()
    episodes = Episodes.of(np.array([5, 6, 7]), 2)
    before = problem.evaluate(policy, rows, None, episodes, 20)
    after = problem.evaluate(policy, changed, None, episodes, 20)
    assert np.array_equal(before.fitness, after.fitness)
    changed[:, policy.nparameters] += 1  # the other one's first weight
    other = problem.evaluate(policy, changed, None, episodes, 20)
    assert not np.array_equal(before.fitness, other.fitness)


# episodes


def test_an_episode_is_what_stepping_the_environment_gives():
    """... with an agent that leaves before the other."""
    from botschool.problems.spaces import fitted
    from tiny_duels import Duel

    problem, policy = duel(nhiddens=4, bias=1, action_noise=1, action_noise_range=0.3)
    rows = np.array([policy.initial(3, i) for i in range(12)])
    outcome = problem.evaluate(policy, rows, None, Episodes.of(np.full(12, 5), 1), 20)
    left_early = 0
    for i, row in enumerate(rows):
        env = Duel()
        seen, _ = env.reset(seed=5)
        totals, steps = dict.fromkeys(env.possible_agents, 0.0), 0
        for k, (side, genotype) in enumerate(zip(policy.sides, np.split(row, 2), strict=True)):
            side.network.parameters[:] = genotype[: policy.sizes[k]]
            side.network.seed(5 + k * 2**48, 0)
            side.network.reset()
        cat, mouse = policy.sides
        while env.agents:
            actions = {"cat": fitted(cat.act(seen["cat"].astype(float)), env.action_space("cat"))}
            if "mouse" in env.agents:
                flat = np.append(seen["mouse"]["cat"], np.eye(2)[seen["mouse"]["side"]])
                actions["mouse"] = fitted(mouse.act(flat), env.action_space("mouse"))
            seen, paid, *_ = env.step(actions)
            steps += 1
            for agent, reward in paid.items():
                totals[agent] += reward
            left_early += env.agents == ["cat"]
        assert outcome.steps[i] == steps == 8
        assert outcome.fitness[:, i].tolist() == list(totals.values())
    assert left_early > 0


def test_episodes_depend_on_seed_and_number_alone():
    problem, policy = duel(nhiddens=2)
    rows = np.array([policy.initial(3, i) for i in range(4)])
    pairs = np.array([[0, 0, 1, 2], [0, 3, 2, 1]], dtype=np.int32)
    genotypes = rows.reshape(8, -1)
    seeds, numbers = np.array([1, 2, 3, 4], np.uint64), np.array([1, 0, 0, 2], np.uint32)
    whole = problem.evaluate(policy, genotypes, None, Episodes(pairs, seeds, numbers), 20)
    assert whole.fitness.shape == (2, 4) and len(set(whole.fitness.ravel())) > 4
    back = slice(None, None, -1)
    again = problem.evaluate(
        policy, genotypes, None, Episodes(pairs[:, back], seeds[back], numbers[back]), 20
    )
    assert np.array_equal(whole.fitness, again.fitness[:, back])


def test_maxsteps_cuts_an_episode():
    problem, policy = duel(nhiddens=2)
    outcome = problem.evaluate(policy, policy.initial(1)[None], None, Episodes.of([5], 1), 3)
    assert outcome.steps.tolist() == [3]


# our predators and prey, by both ways


def test_an_episode_of_our_face_is_that_of_the_native_problem_in_double_precision():
    """Networks and world, step by step, without either of the ways to play an episode."""
    wild = {"nhiddens": 5, "architecture": 3, "winit": 2, "wrange": 2}
    options = PolicyConfig(nrobots=2, heterogeneous=1, bias=1, **wild)
    problem = problems.make(FACE, options="max_steps=300", competitive=True)
    policy = problem.policy(options)
    native = problems.make("ErPredprey").policy(options)
    rows = np.array([policy.initial(1, i) for i in range(6)])
    assert all(np.array_equal(row, native.initial(1, i)) for i, row in enumerate(rows))
    outcome = problem.evaluate(policy, rows, None, Episodes.of(np.full(6, 5), 1), 300)
    stepper = _core.make_stepper("ErPredprey")
    stepper.set(300, None)
    for i, row in enumerate(rows):
        stepper.start(1, 0)
        for side, genotype in zip(policy.sides, np.split(row, 2), strict=True):
            side.network.parameters[:] = genotype
            side.network.reset()
        paid, steps, ended = 0.0, 0, False
        while not ended and steps < 300:
            views = np.split(stepper.observation.astype(np.float32).astype(float), 2)
            acts = [side.act(view) for side, view in zip(policy.sides, views, strict=True)]
            reward, ended = stepper.step(np.concatenate(acts).astype(float))
            paid, steps = paid + reward, steps + 1
        assert (outcome.fitness[:, i].tolist(), outcome.steps[i]) == ([paid, 1 - paid], steps)
    assert len(set(outcome.steps.tolist())) > 2


BOLD = {"maxsteps": 60, "nhiddens": 0, "winit": 2, "bias": 1}


def test_meetings_of_our_face_end_as_those_of_the_native_problem():
    """In short episodes, as single precision drifts from double; there to the bit."""
    face = problems.make(FACE, options="max_steps=60", competitive=True)
    native = problems.make("ErPredprey")
    policy = face.policy(PolicyConfig(nrobots=2, heterogeneous=1, **BOLD))
    rows = np.array([policy.initial(3, i) for i in range(14)]).reshape(28, -1)
    pairs = np.array([2, 2])[:, None] * np.indices((14, 14)).reshape(2, -1) + [[0], [1]]
    meetings = Episodes(
        pairs.astype(np.int32), np.full(196, 3, np.uint64), np.zeros(196, np.uint32)
    )
    one = face.evaluate(policy, rows, None, meetings, 60)
    other = native.evaluate(native.policy(policy.config), rows, None, meetings, 60)
    assert np.array_equal(one.steps, other.steps)
    assert np.array_equal(one.fitness, [other.fitness, 1 - other.fitness])
    assert len(set(one.steps.tolist())) > 5


def test_a_run_of_our_face_leaves_what_the_native_problem_leaves(tmp_path):
    native = write(tmp_path / "native", "ErPredprey", "archive", "", BOLD)
    face = write(tmp_path / "face", FACE, "archive", "max_steps=60", BOLD)
    assert run(native, tmp_path / "a", generations=2) and run(face, tmp_path / "b", generations=2)
    one, two = contents(tmp_path / "a"), contents(tmp_path / "b")
    fitness = np.load(tmp_path / "a" / "S3FitG2.npy")
    assert len(set(fitness.ravel().tolist())) > 4
    for name in one.keys() | two.keys():
        if name != "checkpointS3.npz:botschool":
            assert one[name] == two[name], name


# runs


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_they_evolve_alike_with_workers_and_resumed(algo, tmp_path):
    own = write(tmp_path, algo=algo, policy={"episodes": 2})
    assert run(own, tmp_path / "whole")
    assert run(own, tmp_path / "parts", generations=2)
    assert run(own, tmp_path / "parts", workers=2 if algo == "coevo2" else 1, resume=True)
    for path in (tmp_path / "parts").glob("S3*G2.npy"):
        if not (tmp_path / "whole" / path.name).exists():
            path.unlink()
    assert same(tmp_path / "whole", tmp_path / "parts")


def test_a_worker_that_dies_does_not_show(tmp_path, monkeypatch):
    own = write(tmp_path)
    assert run(own, tmp_path / "whole", generations=1)
    (tmp_path / "life").touch()
    monkeypatch.setenv("TINY_DIE_ONCE", str(tmp_path / "life"))
    assert run(own, tmp_path / "died", workers=2, generations=1)
    assert not (tmp_path / "life").exists()
    assert same(tmp_path / "whole", tmp_path / "died")


def test_each_side_is_ranked_by_its_own_returns(tmp_path):
    own = config.load(write(tmp_path, policy={"episodes": 2}))
    assert run(tmp_path / "own.ini", tmp_path / "run")
    genotypes, fitness = (np.load(tmp_path / "run" / f"S3{f}G3.npy") for f in ("", "Fit"))
    coevolution = Coevolution(own, 3)
    assert genotypes.shape == (8, coevolution.policy.nparameters) and fitness.shape == (8, 4)
    for rows in np.split(fitness, 2):
        assert (np.diff(rows.mean(axis=1)) <= 1e-12).all()
    for i in range(4):
        for k in range(4):
            pairs = np.array([[i, i], [4 + k, 4 + k]], dtype=np.int32)
            episodes = Episodes(pairs, np.full(2, 3, np.uint64), np.arange(2, dtype=np.uint32))
            outcome = coevolution.problem.evaluate(
                coevolution.policy, genotypes, None, episodes, 20
            )
            cat, mouse = outcome.fitness.mean(axis=1)
            assert (fitness[i, k], fitness[4 + k, i]) == pytest.approx((cat, mouse))
            assert abs(cat + mouse - 1) > 1e-9


def test_mice_and_cats_get_better(tmp_path):
    """Later cats against the mice of the beginning, and later mice against the first cats."""
    own = write(tmp_path, algo="archive", policy={"episodes": 2, "nhiddens": 0})
    text = own.read_text().replace("ngenerations = 6", "ngenerations = 40")
    own.write_text(text.replace("samplesize = 2", "samplesize = 6"))
    assert run(own, tmp_path / "run")
    contest = Contest(config.load(own), 3)
    parts = [np.split(np.load(tmp_path / "run" / f"S3G{g}.npy"), 2) for g in (0, 40)]
    tables = summarised(play(contest, *zip(*parts, strict=True)), 3)
    for table in tables:
        assert table.mean[1, 0] > table.mean[0, 0] + 0.5, table.role


# algorithms


@pytest.mark.parametrize("algo", ALGORITHMS)
def test_two_returns_that_add_up_to_1_evolve_as_one(algo):
    """... and what counts is the order of returns, not their scale."""
    entry = ALGORITHMS_BY_NAME[algo]
    options = ALGORITHMS[algo] | {"samplesize": 3, "noiseStdDev": 0.1, "stepsize": 0.03}
    settings = entry.config(**options | ({"preferential": 1} if algo == "archivestar" else {}))

    def scaled(*meeting, scale=1.0):
        fitness = tiny_game.play(*meeting)
        return np.stack([scale * fitness, 1 - fitness])

    one = entry.make(settings, tiny_game.initial, 9)
    two = entry.make(settings, tiny_game.initial, 9, constant_sum=False)
    four = entry.make(settings, tiny_game.initial, 9, constant_sum=False)
    for _ in range(4):
        one.advance(tiny_game.play)
        two.advance(scaled)
        four.advance(partial(scaled, scale=4.0))
        for name in ("parameters",) if algo == "coevo2" else ("centres", "champions"):
            assert np.array_equal(getattr(one, name), getattr(two, name))
            assert np.array_equal(getattr(one, name), getattr(four, name))
        if algo == "coevo2" or one.generation > 1:
            both = one.summary(), four.summary()
            assert both[1]["predators"] == pytest.approx(4 * both[0]["predators"])
            assert both[1]["prey"] == pytest.approx(both[0]["prey"])


def test_strength_on_any_scale():
    """Minus the fitness of those who met it; unknown ones are as strong as the mean of others."""
    entry = ALGORITHMS_BY_NAME["archivestar"]
    settings = entry.config(popsize=1, samplesize=1, ncompetitors=3, addtoarchiveevery=1)
    star = entry.make(settings, tiny_game.initial, 9, constant_sum=False)
    assert np.isnan(star.strengths[1]).all()
    star.ask()
    star.opponents = np.array([[[0, 2, 0]]])
    star.tell(np.array([[[10.0, 70.0, 20.0], [30.0, 50.0, 40.0]]]))
    assert star.strengths[1][0] == pytest.approx(-25) and np.isnan(star.strengths[1][1])
    assert star.strengths[1][2] == pytest.approx(-60)
    star.generation = 2
    star.ask()
    star.opponents = np.array([[[0, 0, 0]]])
    star.tell(np.zeros((1, 2, 3)))
    assert star.strengths[1][0] == pytest.approx(-22.5)


# the command


@pytest.fixture
def es(tmp_path, command):
    own = write(tmp_path)
    assert run(own, tmp_path / "run")
    return lambda *more: command("es", "-f", own, "-s", 3, "-o", tmp_path / "run", "-p", *more)


def test_it_says_who_is_who(tmp_path, command):
    code, out, errors = command("es", "-f", write(tmp_path), "-o", tmp_path / "run")
    assert (code, errors) == (0, "")
    assert out.endswith("bestgS1.npy (predators are cat, prey are mouse)\n")


def test_pairs_are_measured_and_watched(es, tmp_path):
    code, measured, errors = es("-g", "p-3-2")
    assert (code, errors) == (0, "")
    assert "predators are cat, prey are mouse" in measured and "fitness of these prey" in measured
    code, out, _ = es("-g", "P-3-2", "--replay", tmp_path / "duels.html")
    assert code == 0 and (tmp_path / "duels.html").stat().st_size > 1000
    shown = re.findall(r"(cat \d, mouse \d)  fitness (-?[\d.]+) of cat, (-?[\d.]+) of mouse", out)
    assert [pair for pair, _, _ in shown] == [f"cat {i}, mouse {k}" for i in (1, 2) for k in (1, 2)]
    assert f"mean fitness of the prey: {np.mean([float(m) for *_, m in shown]):.2f}" in out


def test_the_best_of_both_are_filmed_with_their_neurons(es, tmp_path):
    best = tmp_path / "run" / "bestgS3.npy"
    code, out, errors = es("-g", best, "-d", "--video", tmp_path / "duel.mp4")
    assert (code, errors) == (0, "") and "cat: mean" in out and "mouse: mean" in out
    assert (tmp_path / "duel.mp4").stat().st_size > 1000


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
        ("tiny_duels:Crowd", "", ["has 3 agents (cat, mouse, dog), but two evolve", "options ="]),
        ("tiny_duels:Hermit", "", "has 1 agent (cat), but two evolve"),
        ("tiny_duels:Turns", "", "take turns"),
        ("tiny_duels:nothing", "", ["no ParallelEnv", "type NoneType"]),
        ("tiny_duels:board", "", ["type dict", "module:function"]),
        ("tiny_duels:broken", "", ["tiny_duels:broken cannot be made: no floor"]),
        ("tiny_duels:packaged", "", ["a_package_that_is_not_there", "pip install"]),
        ("tiny_duels:Duell", "", "no 'Duell' in tiny_duels; did you mean Duel?"),
        ("tiny_duels", "", "has no function parallel_env"),
        ("not_there:Duel", "", "no module not_there"),
        ("nothing/duel-v1", "", "no environment 'nothing/duel-v1' in PettingZoo"),
        ("tiny_envs:Tiny-v0", "", ["of one robot", "PettingZoo"]),
        ("tiny_duels:Duel", "pace=3", ["cannot be made with these options", "pace"]),
        ("tiny_duels:Duel", "fault", ["line 4: 'fault' cannot be read as options"]),
        ("tiny_duels:Duel", "fault='words'", ["of cat, observations are a Text space"]),
        ("tiny_duels:Duel", "fault='sequence'", ["of cat, actions are a Sequence space"]),
        ("tiny_duels:Duel", "fault='old'", ["reset", "no pair of observations"]),
        ("tiny_duels:Duel", "fault='nobody'", "no agent takes part"),
        ("tiny_duels:Duel", "fault='raises'", "step 1 of episode 0 of seed 3 (the floor is wet)"),
        ("tiny_duels:Duel", "fault='nan'", "a reward of nan at step 1 in episode 0 of seed 3"),
        ("tiny_duels:Duel", "fault='unpaid'", "a reward of None at step 1"),
        ("tiny_duels:Duel", "fault='blind'", "no observation of cat"),
        ("tiny_duels:Seedless", "", ["reset", "unexpected keyword argument 'seed'"]),
        ("ErPredprey", "max_steps=5", "ErPredprey takes no options"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(environment, options, says, refused, tmp_path):
    path = write(tmp_path, environment, options=options)
    refused("es", "-f", path, "-s", 3, "-o", tmp_path / "run", says=says)


def test_other_settings_that_do_not_fit(refused, tmp_path):
    for policy, says in (({"nrobots": 1}, "nrobots = 2"), ({"normalize": 1}, "normalize = 0")):
        path = write(tmp_path, policy=policy)
        refused("es", "-f", path, "-o", tmp_path / "run", says=says)
    path = write(tmp_path)
    path.write_text(path.read_text().replace("options =", "wrappers = ClipReward\noptions ="))
    refused("es", "-f", path, "-o", tmp_path / "run", says=["wrappers do not fit", "module:func"])


@pytest.mark.parametrize("name", ["tiny_duels:Duel", FACE, "classic/rps-v2"])
def test_one_population_does_not_evolve_in_a_game_of_two(name, refused, tmp_path):
    path = write(tmp_path, name, "SSS", policy={"nrobots": 1, "heterogeneous": 0})
    path.write_text(re.sub(r"(?s)\[ALGO\].*", "[ALGO]\npopsize = 2\n", path.read_text()))
    says = [f"{name} is an environment of PettingZoo", "algo = coevo2"]
    refused("es", "-f", path, "-o", tmp_path / "run", says=says)


def test_without_pictures(refused, tmp_path):
    film = ("--video", tmp_path / "duel.mp4")
    refused("es", "-f", write(tmp_path, "tiny_duels:Blind"), "-p", *film, says="draws no pictures")
    own = write(tmp_path, options="fault='words drawn'")
    refused("es", "-f", own, "-p", *film, says="draws no pictures")


def test_without_seeds_it_says_so(command, tmp_path):
    own = write(tmp_path, options="fault='unseeded'")
    code, _, errors = command("es", "-f", own, "-o", tmp_path / "run", "--generations", 1)
    assert code == 0 and "starts differently from the same seed" in errors


def test_without_the_package_it_says_what_to_install(monkeypatch):
    def missing(module):
        raise ModuleNotFoundError("No module named 'mpe2'", name="mpe2")

    monkeypatch.setattr(importlib, "import_module", missing)
    for name in ("mpe2.simple_push_v3", "mpe2.simple_push_v3:parallel_env"):
        with pytest.raises(BotschoolError, match=r"comes with the package mpe2: install it with"):
            problems.make(name, competitive=True)
    monkeypatch.setitem(sys.modules, "pettingzoo", None)
    with pytest.raises(BotschoolError, match=r"not installed: install.*botschool\[pettingzoo\]"):
        problems.make("tiny_duels:Duel", competitive=True)


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
