"""For tests of co-evolved populations: small ones, random or made by hand."""

import numpy as np

from botschool import config, problems
from botschool.policies.policy import Policy

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
    """Writes FOLDER/own.ini: ErPredprey in 60 steps. Gives its path."""
    folder.mkdir(exist_ok=True)
    path = folder / "own.ini"
    path.write_text(EXPERIMENT.format(nhiddens=nhiddens, pepisodes=pepisodes))
    return path


def policy_of(path):
    """The policy of an experiment file."""
    problem = problems.make("ErPredprey")
    return Policy(problem.name, problem.interface, config.load(path).policy)


def random_populations(policy, generation, size=3):
    """As coevo2 saves them: first all predators, then all prey."""
    pairs = [np.split(policy.initial(generation, i), 2) for i in range(size)]
    return np.concatenate(list(zip(*pairs, strict=True)))


def write_run(folder):
    """A run of seed 12 in the folder, with its experiment file own.ini; no Fit files."""
    path = experiment(folder)
    for generation in GENERATIONS:
        populations = random_populations(policy_of(path), generation)
        np.save(path.parent / f"S12G{generation}.npy", populations)
    return folder


def driver(left, right):
    """A network without hidden neurons whose wheels turn like this, whatever it senses."""
    network = np.zeros(50)
    network[:2] = left, right
    return network


STILL, STRAIGHT = driver(0, 0), driver(5, 5)
