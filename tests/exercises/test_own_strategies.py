"""`algo = module:name`: a strategy of one's own evolves as the tool's do."""

import shutil
from pathlib import Path

import numpy as np
import pytest

from botschool.config import from_dict, load, to_dict
from botschool.errors import BotschoolError
from botschool.evolution.algorithms.own import Own, OwnConfig
from running import call

SOLUTIONS = Path(__file__).parents[2] / "solutions"
FILES = ("ex03_evolution_strategy/evolution_strategy.py", "ex08_openai_es/openai_es.py")
INI = """[EXP]
environment = CartPole-v1
algo = {}
[POLICY]
nhiddens = 5
episodes = 2
[ALGO]
maxmsteps = 0.02
options = {}
"""
CLASS = """
import numpy as np
class Climber:
    def __init__(self, start, seed, noise=0.1):
        self.best, self.top, self.noise = start, -1, noise
        self.rng = np.random.default_rng(seed)
    def ask(self):
        self.tried = self.best + self.noise * self.rng.standard_normal((4, len(self.best)))
        return self.tried
    def tell(self, fitness):
        if fitness.max() >= self.top:
            self.best, self.top = self.tried[fitness.argmax()], fitness.max()
"""
STRATEGIES = [
    ("mine:Climber", "noise=0.2"),
    ("openai_es:evolve", "samplesize=4, noiseStdDev=0.2, stepsize=0.05"),
    ("evolution_strategy:evolve", "popsize=6, mutrate=0.2"),
]


@pytest.fixture
def folder(tmp_path):
    """A folder with strategies of three kinds."""
    (tmp_path / "mine.py").write_text(CLASS)
    for file in FILES:
        shutil.copy(SOLUTIONS / file, tmp_path)
    return tmp_path


def files(folder):
    return {path.name: path.read_bytes() for path in folder.glob("*.npy")}


@pytest.mark.slow
@pytest.mark.parametrize(("algo", "options"), STRATEGIES)
def test_it_evolves_and_resumes_and_runs_side_by_side(folder, algo, options):
    (folder / "a.ini").write_text(INI.format(algo, options))
    es = ("es", "-f", "a.ini", "-s", "3", "-n", "2")
    code, _, error = call(*es, "-o", "one", cwd=folder)
    assert code == 0, error
    stat = np.load(folder / "one" / "statS3.npy").reshape(-1, 6)
    assert stat[-1, 0] >= 20_000 and stat[-1, 1] > 2 * stat[0, 4]
    assert call(*es, "-o", "two", "--generations", "3", cwd=folder)[0] == 0
    assert call(*es, "-o", "two", "--resume", cwd=folder)[0] == 0
    assert call(*es, "-o", "three", "-w", "2", cwd=folder)[0] == 0
    assert files(folder / "one") == files(folder / "two") == files(folder / "three")


@pytest.mark.slow
def test_a_strategy_that_changed_is_not_resumed(folder):
    (folder / "a.ini").write_text(INI.format("mine:Climber", ""))
    es = ("es", "-f", "a.ini", "-s", "3")
    assert call(*es, "--generations", "3", cwd=folder)[0] == 0
    (folder / "mine.py").write_text(CLASS.replace("noise=0.1", "noise=0.55"))
    code, _, error = call(*es, "--resume", cwd=folder)
    assert code == 2 and "gives other candidates than before" in error


def test_its_experiment_is_read_and_written(folder):
    (folder / "a.ini").write_text(INI.format("mine:Climber", "noise=0.2"))
    read = load(folder / "a.ini")
    assert from_dict(to_dict(read)) == read and read.algo.options == "noise=0.2"
    (folder / "a.ini").write_text(INI.format("mine:Climber", "noise=0.1") + "length = 0.2")
    with pytest.raises(BotschoolError, match=r"write options = length=VALUE"):
        load(folder / "a.ini")


@pytest.mark.parametrize("algo", ["nowhere:evolve", "mine:climb", "numpy:pi"])
def test_what_is_not_there_is_said(folder, algo):
    (folder / "a.ini").write_text(INI.format(algo, ""))
    code, _, error = call("es", "-f", "a.ini", cwd=folder)
    assert code == 2 and ("There is no module" in error or "has no function or class" in error)


def own(found, options="", size=3):
    config = OwnConfig(options=options)
    return Own("mine:evolve", config, lambda i: np.full(size, float(i)), 7, found)


def rounds(algorithm, count=3):
    for _ in range(count):
        candidates, _ = algorithm.ask()
        algorithm.tell(-(candidates**2).sum(axis=1))


def shaped(evaluate, centre):
    evaluate(np.zeros((4, len(centre) + 1)), 1)


def empty(evaluate, centre):
    evaluate(np.zeros((0, len(centre))), 1)


def words(evaluate, centre):
    evaluate("candidates", 1)


def exploding(evaluate, centre):
    evaluate(np.full((2, len(centre)), np.nan), 1)


def seedless(evaluate, centre):
    evaluate(np.zeros((2, len(centre))), 1.5)


def dividing(evaluate, centre):
    evaluate(np.zeros((2, len(centre))), 1)
    return 1 / 0


def leaving(evaluate, centre):
    raise SystemExit(0)


def short(evaluate, centre):
    evaluate(np.zeros((2, len(centre))), 1)


def plain(centre, seed):
    pass


def needing(evaluate, centre, generations, seed, sigma):
    pass


class Silent:
    def __init__(self, start):
        pass

    def ask(self):
        return np.zeros((2, 3))


@pytest.mark.parametrize(
    ("found", "options", "says"),
    [
        (shaped, "", r"shape \(4, 4\): it must be \(candidates, 3\)"),
        (empty, "", r"shape \(0, 3\)"),
        (words, "", "not an array of numbers"),
        (exploding, "", "candidate 0 of generation 0 a parameter that is not finite"),
        (seedless, "", "the seed 1.5: it must be a whole number"),
        (dividing, "", r"fails in generation 1, line \d+ \(dividing\) with ZeroDivisionError: div"),
        (leaving, "", "calls sys.exit"),
        (short, "", "has returned after 1 generations"),
        (plain, "", "has no argument evaluate"),
        (needing, "", "needs sigma: write options = sigma=VALUE"),
        (needing, "sigm=1", "takes no argument sigm: did you mean sigma"),
        (needing, "sigma=1, seed=2", "gets seed from the tool"),
        (Silent, "", "has no method tell"),
    ],
)
def test_each_way_to_fail_is_a_sentence(found, options, says):
    with pytest.raises(BotschoolError, match=says) as raised:
        rounds(own(found, options))
    assert str(raised.value).startswith("Your strategy mine:evolve ")


def test_what_it_is_given_and_what_it_gives_are_copies():
    kept = []

    def evolve(evaluate, centre, seed):
        while True:
            mine = np.tile(centre, (2, 1))
            fitness = evaluate(mine, seed)
            mine[:] = 9
            fitness[:] = 5
            kept.append(fitness)

    algorithm = own(evolve)
    candidates, seeds = algorithm.ask()
    fitness = np.array([1.0, 2.0])
    algorithm.tell(fitness)
    algorithm.ask()
    assert (candidates == 0).all() and (fitness == [1, 2]).all() and (seeds == 7).all()
    assert (algorithm.told == [1, 2]).all()


def test_an_earlier_state_is_restored():
    def evolve(evaluate, centre, generations, seed):
        rng = np.random.default_rng(seed)
        for generation in range(generations):
            candidates = centre + rng.standard_normal((600, len(centre)))
            centre = candidates[evaluate(candidates, seed + generation).argmax()]

    algorithm = own(evolve)
    rounds(algorithm, 2)
    state, following = algorithm.state(), algorithm.ask()[0]
    rounds(algorithm, 3)
    later = algorithm.ask()[0]
    algorithm.restore(state)
    assert algorithm.generation == 2 and (algorithm.ask()[0] == following).all()
    rounds(algorithm, 3)
    assert (algorithm.ask()[0] == later).all()
