"""PettingZoo environments for the tests: a quick one that works, and one for every way to fail.

`duels:Duel`, with an option fault=... for faults that show while it is played.
"""

import numpy as np
from gymnasium import spaces
from pettingzoo import AECEnv, ParallelEnv

from botschool import config, problems
from botschool.evolution.coevolution import Coevolution
from botschool.evolution.run import evolve
from botschool.policies.policy import Policy
from tiny_envs import die_once


class Duel(ParallelEnv):
    """A cat on a line follows a mouse, which should stay away but gets tired when it moves.

    They observe and do different things. The cat's reward is 1 - distance, the mouse's is the
    distance minus its effort. The mouse leaves when it is caught; the cat stays until the end.
    """

    metadata = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012
    names = ("cat", "mouse")
    length = 8

    def __init__(self, fault=None, render_mode=None):
        self.fault = fault
        self.render_mode = render_mode
        self.possible_agents = list(self.names)
        self.agents = []

    def observation_space(self, agent):
        if self.fault == "words":
            return spaces.Text(5)
        if agent == "mouse":
            return spaces.Dict(cat=spaces.Box(-9, 9, (1,), np.float32), side=spaces.Discrete(2))
        return spaces.Box(-9, 9, (3,), np.float32)

    def action_space(self, agent):
        if self.fault == "sequence":
            return spaces.Sequence(spaces.Discrete(2))
        if agent == "mouse":
            return spaces.MultiDiscrete([3, 2], start=[-1, 0])
        return spaces.Box(-0.4, 0.4, (1,), np.float32)

    def reset(self, seed=None, options=None):
        self.random = np.random.default_rng(None if self.fault == "unseeded" else seed)
        self.cat, self.mouse = self.random.uniform(-1, 1, 2)
        self.t = 0
        self.agents = [] if self.fault == "nobody" else list(self.names)
        seen = self._seen()
        return seen if self.fault == "old" else (seen, {agent: {} for agent in self.names})

    def step(self, actions):
        die_once()
        assert set(actions) == set(self.agents), actions
        assert all(self.action_space(agent).contains(act) for agent, act in actions.items())
        self.t += 1
        if self.fault == "raises":
            raise RuntimeError("the floor\n  is wet")
        effort = 0.0
        if "mouse" in actions:
            push, strong = actions["mouse"]
            effort = 0.1 * abs(push) * (1 + strong)
            self.mouse = np.clip(self.mouse + 0.15 * push * (1 + strong), -4, 4)
        self.cat = np.clip(self.cat + float(actions["cat"][0]), -4, 4)
        apart = abs(self.cat - self.mouse)
        paid = {"cat": 1 - apart, "mouse": apart - effort}
        ended = {"cat": False, "mouse": bool(apart < 0.1)}
        cut = dict.fromkeys(self.names, self.t >= self.length)
        wrong = {"nan": {"cat": np.nan}, "unpaid": {"mouse": 1.0}}
        here = list(self.agents)
        self.agents = [a for a in here if not (ended[a] or cut[a])]
        paid = {a: r for a, r in (wrong.get(self.fault) or paid).items() if a in here}
        seen = {} if self.fault == "blind" else {a: self._seen()[a] for a in here}
        return seen, paid, ended, cut, {}

    def render(self):
        if self.fault == "words drawn":
            return "a cat"
        return np.full((32, 48, 3), 200, dtype=np.uint8)

    def _seen(self):
        apart = self.mouse - self.cat
        cat = np.array([self.cat, self.mouse, apart], dtype=np.float32)
        mouse = {"cat": np.array([-apart], dtype=np.float32), "side": int(self.mouse > 0)}
        return {"cat": cat, "mouse": mouse}


class Blind(Duel):
    """Draws nothing."""

    metadata = {"render_modes": []}  # noqa: RUF012


class Crowd(Duel):
    names = ("cat", "mouse", "dog")


class Hermit(Duel):
    names = ("cat",)


class Seedless(Duel):
    def reset(self, options=None):
        return super().reset()


class Turns(AECEnv):
    """Agents act one after the other."""

    metadata = {"is_parallelizable": False}  # noqa: RUF012
    possible_agents = ("white", "black")


def nothing():
    return None


def broken():
    raise RuntimeError("no floor")


def packaged():
    import a_package_that_is_not_there  # noqa: F401


board = {"no": "environment"}


# --- For tests of PettingZoo environments: very small experiments, and their runs.


FACE = "botschool.envs.predprey"
ALGORITHMS = {
    "coevo2": {"ngenerations": 3, "popsize": 4, "selsize": 2, "samplesize": 2, "saveeach": 1},
    "archive": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "ncompetitors": 3},
    "archivestar": {"ngenerations": 6, "samplesize": 2, "addtoarchiveevery": 1, "popsize": 2}
    | {"ncompetitors": 4, "seldifferentiated": 0, "preferential": 2},
    "maxsolvestar": {"ngenerations": 6, "samplesize": 2, "archivelen": 4, "ncompetitors": 3},
}


def write(folder, environment="duels:Duel", algo="coevo2", options="", policy=None):
    """Write FOLDER/own.ini, a very small experiment; return its path."""
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


# --- For tests of co-evolved populations: small ones, random or made by hand.


EXPERIMENT = """[EXP]
environment = ErPredprey
algo = coevo2
[POLICY]
nrobots = 2
heterogeneous = 1
maxsteps = 60
nhiddens = {nhiddens}
bias = 1
pepisodes = {pepisodes}
[ALGO]
popsize = 3
selsize = 2
"""
GENERATIONS = (0, 10, 20, 40)


def experiment(folder, nhiddens=0, pepisodes=1):
    """Write FOLDER/own.ini, ErPredprey in 60 steps; return its path."""
    folder.mkdir(exist_ok=True)
    path = folder / "own.ini"
    path.write_text(EXPERIMENT.format(nhiddens=nhiddens, pepisodes=pepisodes))
    return path


def policy_of(path):
    """Return the policy of an experiment file."""
    problem = problems.make("ErPredprey")
    return Policy(problem.name, problem.interface, config.load(path).policy)


def random_populations(policy, generation, size=3):
    """Return random populations as coevo2 saves them: first all predators, then all prey."""
    pairs = [np.split(policy.initial(generation, i), 2) for i in range(size)]
    return np.concatenate(list(zip(*pairs, strict=True)))


def write_run(folder):
    """Write a run of seed 12 into the folder, with its own.ini and without Fit files."""
    path = experiment(folder)
    for generation in GENERATIONS:
        populations = random_populations(policy_of(path), generation)
        np.save(path.parent / f"S12G{generation}.npy", populations)
    return folder


def driver(left, right):
    """Return a network without hidden neurons that drives its wheels like this,
    whatever it senses.
    """
    network = np.zeros(50)
    network[:2] = left, right
    return network


STILL, STRAIGHT = driver(0, 0), driver(5, 5)
