"""A game of two sides that needs no robots, and plain Python of what algorithms do in it."""

import math

import numpy as np

SIZE = 5


def initial(index):
    """Two networks in a row."""
    return np.random.default_rng(index).normal(size=2 * SIZE)


def meetings(predators, prey):
    """Some game in which it depends on the opponent what is good; all against all."""
    near = np.abs(predators[:, None] - np.roll(prey, 1, axis=1)[None]).sum(axis=2)
    return np.round(1 / (1 + near), 3)


def play(predators, prey, pairs):
    """The same, pair by pair."""
    return meetings(predators, prey)[tuple(pairs)]


class Individual:
    """Of the plain implementation."""

    def __init__(self, x, m, v):
        self.x, self.m, self.v = list(x), list(m), list(v)


def meeting(side, ours, theirs):
    """Own fitness of an individual of one side."""
    predator, prey = (ours, theirs) if side == 0 else (theirs, ours)
    near = sum(abs(predator[j] - prey[j - 1]) for j in range(SIZE))
    fitness = round(1 / (1 + near), 3)
    return fitness if side == 0 else 1 - fitness


def average(values):
    return math.fsum(values) / len(values)


def climb(config, one, directions, fitness):
    """A step of OpenAI-ES, number by number, of an Individual, in place.

    directions: samplesize lists; fitness(candidate number, x). Returns the fitness of all.
    """
    scores = []
    for e in directions:
        for sign in (1, -1):
            step = sign * config.noiseStdDev
            x = [x + step * d for x, d in zip(one.x, e, strict=True)]
            scores.append(fitness(len(scores), x))
    n = len(scores)
    utility = [0.0] * n
    for rank, i in enumerate(sorted(range(n), key=lambda i: scores[i])):
        utility[i] = rank / (n - 1) - 0.5
    for j in range(SIZE):
        pairs = [utility[2 * b] - utility[2 * b + 1] for b in range(n // 2)]
        g = -sum(w * e[j] for w, e in zip(pairs, directions, strict=True)) / n
        if config.wdecay == 1:
            g += 0.005 * one.x[j]
        if config.wdecay == 2:
            g += 0.005 * math.copysign(1, one.x[j])
        one.m[j] = 0.9 * one.m[j] + 0.1 * g
        one.v[j] = 0.999 * one.v[j] + 0.001 * g * g
        one.x[j] -= config.stepsize * one.m[j] / (math.sqrt(one.v[j]) + 1e-8)
    return scores
