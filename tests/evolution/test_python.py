"""`import botschool`: what programs get is what the commands give, bit for bit."""

import ast
import copy
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import botschool
from botschool import config, problems
from botschool.interface.runs import HISTORY
from botschool.problems import Episodes
from botschool.terminal import readable
from running import call, environment_of_command, same, write_experiment

PROBLEM = botschool.problem("CartPole-v1", hidden=3)
POLE = {"environment": "CartPole-v1", "algo": "SSS", "nhiddens": 3, "maxmsteps": 0.02, "popsize": 6}


@pytest.mark.parametrize(
    ("code", "heavy"),
    [
        ("import botschool; dir(botschool)", "numpy gymnasium torch rich matplotlib"),
        ("import botschool; botschool.evolve; botschool.problem", "torch matplotlib IPython"),
        ("import botschool.config", "torch pybullet matplotlib rich"),
        pytest.param(
            "import botschool.cli, botschool.rl.folder, botschool.rl.training",
            "torch",
            marks=pytest.mark.slow,
        ),
    ],
)
def test_importing_is_light(code, heavy):
    code = f"import sys; {code}; print(*set({heavy.split()}) & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert done.stdout == "\n"


# --- the same bits as the command


@pytest.mark.parametrize("workers", [1, 2])
@pytest.mark.parametrize(
    ("environment", "algo"),
    [
        ("CartPole-v1", "SSS"),
        ("Pendulum-v1", "OpenAI-ES"),
        pytest.param("tiny_envs:Tiny-v0", "SSS", marks=pytest.mark.slow),
    ],
)
def test_files_are_those_of_the_command(environment, algo, workers, tmp_path):
    file = write_experiment(tmp_path, environment, algo, {"normalize": 1, "maxsteps": 50})
    code, _, errors = call("es", "-f", file, "-s", 3, "-n", 3, "-o", tmp_path / "command")
    assert code == 0, errors
    runs = botschool.evolve(file, seeds=[5, 3, 4], workers=workers, folder=tmp_path / "python")
    assert same(tmp_path / "command", tmp_path / "python")
    assert runs.seeds == [5, 3, 4]
    for run in runs:
        assert np.array_equal(run.best, np.load(tmp_path / f"command/bestgS{run.seed}.npy"))


def test_dicts_ids_and_keywords_mean_the_same_experiment(tmp_path):
    nested = {"EXP": {"environment": "CartPole-v1", "algo": "SSS"},
              "POLICY": {"nhiddens": 3}, "ALGO": {"maxmsteps": 0.02, "popsize": 6}}  # fmt: skip
    file = tmp_path / "pole.ini"
    file.write_text(
        "[EXP]\nenvironment = CartPole-v1\nalgo = OpenAI-ES\n[POLICY]\nnhiddens = 9\n"
        "[ALGO]\nmaxmsteps = 0.02\nstepsize = 0.1\n"
    )
    changed = {"algo": "sss", "hidden": np.int64(3), "popsize": 6.0}
    keywords = {key: value for key, value in POLE.items() if key != "environment"}
    made = [
        botschool.evolve(POLE),
        botschool.evolve(nested),
        botschool.evolve("CartPole-v1", **keywords),
        botschool.evolve(file, **changed),
        botschool.evolve(config.load(file), **changed),
    ]
    assert len({config.to_dict(run.experiment).__repr__() for run in made}) == 1
    assert len({run.best.tobytes() for run in made}) == 1
    both = botschool.problem(POLE, normalize=True, filters=[16, 32])
    assert both.experiment.policy.normalize == 1


def test_a_run_of_python_is_continued_by_the_command_and_the_other_way_round(tmp_path):
    file = write_experiment(tmp_path)
    whole = botschool.evolve(file, folder=tmp_path / "whole")
    botschool.evolve(file, folder=tmp_path / "a", generations=4)
    assert call("es", "-f", file, "-o", tmp_path / "a", "--resume")[0] == 0
    assert call("es", "-f", file, "-o", tmp_path / "b", "--generations", 4)[0] == 0
    run = botschool.evolve(file, folder=tmp_path / "b", resume=True)
    assert same(tmp_path / "whole", tmp_path / "a") and same(tmp_path / "whole", tmp_path / "b")
    assert (run.history == whole.history).all()


# --- what a run offers


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("runs")
    return botschool.evolve(POLE, seeds=(1, 2, 7), folder=folder, normalize=1)


def test_history_best_and_fitness_are_those_of_the_files(runs):
    run = runs[1]
    rows = np.load(run.folder / "statS2.npy").reshape(-1, 6)
    assert run.history.dtype == HISTORY
    for column, name in zip(rows.T, HISTORY.names[1:], strict=True):
        assert (run.history[name] == column).all()
    assert run.history["generation"].tolist() == list(range(1, len(rows) + 1))
    assert np.array_equal(run.returns, np.loadtxt(run.folder / "freshS2.txt"))
    assert np.array_equal(run.play(20), run.returns)  # the same episodes, the same bits
    assert run.fitness == run.returns.mean() and run.play(3, seed=5).shape == (3,)
    assert runs.history["seed"].tolist() == [r.seed for r in runs for _ in r.history]


def test_summary_counts_and_bounds_the_runs(runs):
    found, values = runs.summary(), runs.fitness
    assert found["n"] == 3 and found["mean"] == pytest.approx(values.mean())
    half = 4.303 * values.std(ddof=1) / np.sqrt(3)  # Student's t with two degrees of freedom
    assert (found["low"], found["high"]) == pytest.approx(
        (values.mean() - half, values.mean() + half)
    )
    assert len(runs[:2]) == 2 and np.isnan(runs[:1].summary()["sd"])


def test_old_results_without_a_checkpoint_are_loaded(runs, tmp_path):
    for name in ("statS2.npy", "bestgS2.npy"):
        (tmp_path / name).write_bytes((runs[1].folder / name).read_bytes())
    [old] = botschool.load(tmp_path)
    assert (old.history == runs[1].history).all() and "seed 2" in repr(old)
    with pytest.raises(botschool.BotschoolError, match="name it, as in load"):
        old.play()
    [known] = botschool.load(tmp_path, runs[0].experiment)
    assert np.array_equal(known.returns, runs[1].returns)  # measured now


@pytest.mark.slow
def test_plots_pages_and_films_are_written(runs, tmp_path):
    pytest.importorskip("matplotlib")
    assert runs.plot(tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")
    assert runs[0].plot()._repr_png_().startswith(b"\x89PNG")
    labels = runs.plot().axes[0].get_legend_handles_labels()[1]
    assert any(f"3 runs: {readable(runs.summary()['mean'])}" in label for label in labels)
    assert "bestgS1.npy" in runs[0].page(tmp_path / "p.html").read_text(encoding="utf-8")
    film = runs[0].film(tmp_path / "f.gif")
    assert film.read_bytes().startswith(b"GIF")


# --- stopping


SCRIPT = """
import sys, botschool
print("ready", flush=True)
botschool.evolve("CartPole-v1", seeds=[1, 2], workers=2, folder=sys.argv[1], nhiddens=5,
                 resume=len(sys.argv) > 2, maxmsteps=3)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="Windows has no such signals")
def test_ctrl_c_leaves_runs_that_resume_to_the_same_bits(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(SCRIPT)
    command = [sys.executable, script, tmp_path / "stopped"]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        process.stdout.readline()
        while not (tmp_path / "stopped/checkpointS2.npz").exists():
            time.sleep(0.01)
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=60)
    finally:
        process.kill()
    assert "KeyboardInterrupt: The evolution was stopped and is saved" in errors
    assert "resume=True goes on" in errors and errors.count("Traceback") == 1
    stat = np.load(tmp_path / "stopped/statS1.npy")
    assert not stat.size or stat.reshape(-1, 6)[-1, 0] < 3e6
    subprocess.run([*command, "again"], check=True)
    subprocess.run([sys.executable, script, tmp_path / "whole"], check=True)
    assert same(tmp_path / "stopped", tmp_path / "whole")


# --- a strategy of one's own


class Climber:
    """Keeps the best candidate so far."""

    def __init__(self, start, seed, noise=0.1):
        self.best, self.top, self.noise = start, -np.inf, noise
        self.rng = np.random.default_rng(seed)

    def ask(self):
        self.tried = self.best + self.noise * self.rng.standard_normal((6, len(self.best)))
        return self.tried

    def tell(self, fitness):
        if fitness.max() > self.top:
            self.best, self.top = self.tried[fitness.argmax()], fitness.max()


def climbing(evaluate, centre, generations, seed, noise=0.1):
    """The same as a function."""
    strategy = Climber(centre, seed, noise)
    for _ in range(generations):
        strategy.tell(evaluate(strategy.ask()))


@pytest.mark.slow
@pytest.mark.parametrize("algorithm", [Climber, climbing])
def test_a_strategy_of_ones_own_resumes_and_is_the_commands(algorithm, tmp_path):
    given = {"algorithm": algorithm, "noise": np.float64(0.3), "hidden": 3, "maxmsteps": 0.02}
    whole = botschool.evolve("CartPole-v1", **given, folder=tmp_path / "whole")
    botschool.evolve("CartPole-v1", **given, folder=tmp_path / "parts", generations=3)
    botschool.evolve("CartPole-v1", **given, folder=tmp_path / "parts", resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts") and len(whole.history) > 6
    file = tmp_path / "own.ini"
    shutil.copy(__file__, tmp_path)
    file.write_text(
        f"[EXP]\nenvironment = CartPole-v1\nalgo = test_python:{algorithm.__name__}\n[POLICY]\n"
        "nhiddens = 3\n[ALGO]\nmaxmsteps = 0.02\noptions = noise=0.3\n"
    )
    assert call("es", "-f", file, "-o", tmp_path / "command", cwd=tmp_path)[0] == 0
    assert same(tmp_path / "whole", tmp_path / "command")


# --- problems


@pytest.mark.parametrize("environment", ["Acrobot-v1", "PlanarHopper-v5", "tiny_envs:Tiny-v0"])
def test_evaluate_is_the_engines_own_call(environment):
    problem = botschool.problem(environment, hidden=4, bias=1, maxsteps=60)
    genotypes = np.stack([problem.initial(2, i) for i in range(7)])
    seeds = np.arange(7) * 3
    returns, steps = problem.evaluate(genotypes, seeds, episodes=2)
    own = problems.make(environment)
    policy = own.policy(problem.experiment.policy)
    outcome = own.evaluate(policy, genotypes, None, Episodes.of(seeds, 2), 60)
    assert returns.tolist() == outcome.fitness.reshape(7, 2).mean(axis=1).tolist()
    assert steps.tolist() == outcome.steps.reshape(7, 2).sum(axis=1).tolist()
    assert (returns.dtype, steps.dtype) == (np.float64, np.int64)
    alone = [problem.evaluate(g, int(s), 2)[0][0] for g, s in zip(genotypes, seeds, strict=True)]
    assert alone == returns.tolist()
    assert (
        problem.evaluate(genotypes, 5)[0].tolist()
        == problem.evaluate(genotypes, [5] * 7)[0].tolist()
    )


def test_evaluate_takes_saved_robots_with_their_scaling(runs):
    run = runs[0]
    assert len(run.best) > run.problem.parameters
    both, _ = run.problem.evaluate([run.best, runs[1].best], seeds=9, episodes=3)
    assert both[0] == run.play(3, seed=9).mean() != both[1]


def test_numbers_of_numpy_count_as_numbers():
    genotypes = [PROBLEM.initial(np.int64(1), np.uint8(i)) for i in range(2)]
    given = PROBLEM.evaluate(genotypes, np.int64(3), np.int64(2), np.int64(1))
    assert given[0].tolist() == PROBLEM.evaluate(genotypes, 3, 2)[0].tolist()


@pytest.mark.parametrize("source", ["CartPole-v1", "tiny_envs:Tiny-v0"])
@pytest.mark.parametrize("copied", [copy.deepcopy, lambda p: pickle.loads(pickle.dumps(p))])
def test_a_problem_is_copied_and_sent_as_its_experiment(source, copied):
    problem = botschool.problem(source, hidden=3, normalize=1, maxsteps=40)
    again, genotype = copied(problem), problem.initial(5)
    assert again.experiment == problem.experiment
    assert again.evaluate(genotype) == problem.evaluate(genotype)


@pytest.mark.parametrize("source", ["PlanarHopper-v5", "tiny_envs:Tiny-v0"])
def test_robots_with_scaling_of_their_own_are_evaluated_together(source):
    problem = botschool.problem(source, hidden=3, normalize=1, maxsteps=40)
    inputs = problems.make(source).interface.observations
    vectors = np.random.default_rng(1).uniform(0.5, 2, (9, 2 * inputs))
    robots = [np.append(problem.initial(1, i), own) for i, own in enumerate(vectors)]
    returns, steps = problem.evaluate(robots, np.arange(9), episodes=2)
    alone = [problem.returns(g, seed, 2).mean() for seed, g in enumerate(robots)]
    assert returns.tolist() == alone and len(set(alone)) > 1 and len(steps) == 9


# --- errors


@pytest.mark.parametrize(
    ("asked", "says"),
    [
        (lambda: botschool.evolve("CartPole-v1", nhidens=3), "did you mean nhiddens"),
        (lambda: botschool.evolve("CartPoll-v1"), "did you mean CartPole-v1"),
        (lambda: botschool.evolve("no_such.ini"), "no_such.ini"),
        (lambda: botschool.evolve(7), "not a int"),
        (lambda: botschool.evolve(POLE, seed=-1), "seed is -1"),
        (lambda: botschool.evolve(POLE, seed="one"), "seed is 'one'"),
        (lambda: botschool.evolve(POLE, seeds=[1, 1]), "different"),
        (lambda: botschool.evolve(POLE, workers=0), "workers is 0"),
        (lambda: botschool.evolve(POLE, seeds=3), "write seeds=range(10)"),
        (lambda: botschool.evolve(POLE, steps=10**6), "set maxmsteps instead"),
        (lambda: botschool.evolve(POLE, total_timesteps=9), "total_timesteps means steps"),
        (lambda: botschool.train("CartPole-v1", total_timesteps=9), "total_timesteps means steps"),
        (lambda: botschool.evolve(POLE, resume=True), "name the folder"),
        (lambda: botschool.evolve(POLE, algorithm=3), "no strategy"),
        (lambda: botschool.evolve(POLE, algorithm=Climber, algo="SSS"), "mean the same"),
        (lambda: botschool.evolve("CartPole-v1", algorithm=Climber, nois=1), "did you mean noise"),
        (lambda: botschool.evolve("CartPole-v1", popsize=4), "set algo = CMA-ES"),
        (lambda: botschool.problem("CartPole-v1").evaluate(np.zeros((2, 3))), "(n, "),
        (lambda: botschool.problem("CartPole-v1").evaluate([]), "shape"),
        (lambda: botschool.problem(POLE).evaluate(np.full((2, 18), np.nan)), "row 0"),
        (lambda: botschool.problem(POLE).evaluate(np.zeros((2, 18)), [1, 2, 3]), "2 of them"),
        (lambda: botschool.problem(POLE).evaluate(np.zeros((2, 18)), -4), "seeds"),
        (lambda: botschool.problem(POLE).evaluate(np.zeros((2, 18)), episodes=0), "episodes is 0"),
        (lambda: PROBLEM.evaluate(np.full(18, -np.inf)), "row 0"),
        (lambda: PROBLEM.evaluate([["a"] * 18]), "an array of numbers"),
        (lambda: PROBLEM.evaluate([[1, 2], [3]]), "an array of numbers"),
        (lambda: PROBLEM.evaluate(np.zeros(18), seeds=2**64), "from 0 to 2^64 - 1"),
        (lambda: PROBLEM.evaluate(np.zeros(18), seeds="1"), "seeds is '1'"),
        (lambda: PROBLEM.evaluate(np.zeros(18), seeds=[[1, 2], [3]]), "seeds is [["),
        (lambda: PROBLEM.evaluate(np.zeros(18), episodes=True), "episodes is True"),
        (lambda: PROBLEM.initial(seed=-1), "seed is -1"),
        (lambda: PROBLEM.initial(1, index=0.5), "index is 0.5"),
        (lambda: PROBLEM.returns(["a"], 1), "an array of numbers"),
        (lambda: PROBLEM.film(np.zeros(18), "x.gif", seed=-1), "seed is -1"),
        (lambda: botschool.evolve(POLE, generations="3"), "generations is '3'"),
        (lambda: botschool.train("CartPole-v1", seed=-1), "seed is -1"),
        (lambda: botschool.load("no/such/folder"), "there is no folder"),
        (lambda: botschool.train("CartPole-v1", algo="pppo"), "did you mean ppo"),
        (lambda: botschool.train("CartPole-v1", steps=100, learnin_rate=1), "learning_rate"),
    ],
)  # fmt: skip
def test_errors_are_one_sentence(asked, says, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(botschool.BotschoolError) as raised:
        asked()
    assert says in str(raised.value) and "\n" not in str(raised.value), str(raised.value)
    assert raised.value.__suppress_context__ or raised.value.__context__ is None
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_a_script_without_a_guard_evolves_on_one_core(tmp_path):
    script = tmp_path / "script.py"
    script.write_text(
        "import botschool\nrun = botschool.evolve('tiny_envs:Tiny-v0', workers=2, maxmsteps=0.001,"
        " algo='SSS', popsize=4)\nprint(run.best.sum())\n"
    )
    done = subprocess.run(
        [sys.executable, script], capture_output=True, text=True, env=environment_of_command()
    )
    assert done.returncode == 0 and "note: workers = 1" in done.stderr, done.stderr
    assert "__main__" in done.stderr and "Traceback" not in done.stderr


@pytest.mark.parametrize("kind", ["a file", "below a file", "forbidden"])
def test_a_folder_that_cannot_be_is_not_blamed_on_space(kind, tmp_path):
    place = tmp_path / "taken"
    place.write_text("")
    if kind == "below a file":
        place = place / "deep"
    if kind == "forbidden":
        if os.geteuid() == 0:
            pytest.skip("root may write everywhere")
        place = tmp_path / "locked"
        place.mkdir(mode=0o500)
    with pytest.raises(botschool.BotschoolError) as raised:
        botschool.evolve(POLE, folder=place)
    assert str(place) in str(raised.value) and "space" not in str(raised.value)
    assert "choose another folder" in str(raised.value)


# --- trainings


@pytest.mark.slow
def test_a_training_is_that_of_the_command(tmp_path):
    agent = botschool.train(
        "CartPole-v1", seed=2, steps=3000, folder=tmp_path / "python", gamma=0.9
    )
    given = ["--algo", "ppo", "--env", "CartPole-v1", "-s", 2, "-n", 3000, "--params", "gamma=0.9"]
    assert call("rl", "train", *given, "-o", tmp_path / "command")[0] == 0
    names = ("best_model.npz", "last_model.npz", "evaluations.npz")
    mine, theirs = (tmp_path / side / "ppo/CartPole-v1_1" for side in ("python", "command"))
    for name in names:
        with np.load(mine / name) as one, np.load(theirs / name) as other:
            assert all(np.array_equal(one[key], other[key]) for key in other)
    assert agent.history["steps"][-1] >= 3000 and agent.returns.shape == (20,)
    assert np.array_equal(agent.play(3), agent.returns[:3]) and agent.act([[0, 0, 0, 0]]).shape == (
        1,
    )
    loaded = botschool.load(mine)
    assert repr(loaded) == repr(agent) and np.array_equal(loaded.returns, agent.returns)


FLAG = re.compile(r"--[a-z]|\(-[a-z]\)|(^|[ `])-[a-z] ")
ROOMS = ("lock.py", "config.py", "wrappers.py", "output.py", "problems", "policies", "evolution")


def test_a_remedy_of_the_command_is_a_part_of_its_own(tmp_path):
    """Programs get another one; replicate.py is of the command only."""
    library = Path(botschool.__file__).parent
    files = [library / room for room in ROOMS if room.endswith(".py")]
    files += [path for room in ROOMS for path in (library / room).rglob("*.py")]
    for path in [path for path in files if path.name != "replicate.py"]:
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.Call) and ast.unparse(node.func) in (
                "BotschoolError",
                "self._wrong",
            ):
                texts = [a for a in node.args if isinstance(a, (ast.Constant, ast.JoinedStr))]
                found = [text for text in map(ast.unparse, texts) if FLAG.search(text)]
                assert not found, f"{path.name}: write {found} with errors.Option"
    botschool.evolve(POLE, folder=tmp_path)
    with pytest.raises(botschool.BotschoolError) as raised:
        botschool.evolve(POLE, folder=tmp_path)
    assert "resume=True" in str(raised.value) and "force=True" in str(raised.value)
    assert not FLAG.search(str(raised.value))
