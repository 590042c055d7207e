"""CMA-ES, xNES and sNES as in their papers, with numpy's linear algebra. The library's updates
after the same candidates and fitness must be the same.
"""

import math

import numpy as np


def sorted_by(fitness, candidates):
    """Return the candidates, the best first; the earlier wins ties."""
    return candidates[sorted(range(len(fitness)), key=lambda i: -fitness[i])]


class PlainCMAES:
    """Hansen (2016), figure 6 and table 1; sep-CMA-ES of Ros and Hansen (2008)."""

    def __init__(self, mean, sigma, popsize, diagonal=False, active=True):
        n = self.n = len(mean)
        self.m, self.sigma, self.diagonal, self.g = mean, sigma, diagonal, 0
        self.p_sigma, self.p_c, self.c = np.zeros(n), np.zeros(n), np.eye(n)
        raw = [math.log((popsize + 1) / 2) - math.log(i) for i in range(1, popsize + 1)]
        positive = [w for w in raw if w >= 0]
        negative = [w for w in raw if w < 0]
        mu_eff = sum(positive) ** 2 / sum(w * w for w in positive)
        mu_eff_minus = sum(negative) ** 2 / sum(w * w for w in negative)
        c1 = 2 / ((n + 1.3) ** 2 + mu_eff)
        c_mu = 2 * (1 / 4 + mu_eff + 1 / mu_eff - 2) / ((n + 2) ** 2 + 2 * mu_eff / 2)
        if diagonal:
            c1, c_mu = c1 * (n + 2) / 3, c_mu * (n + 2) / 3
        self.c1, self.c_mu = c1, min(1 - c1, c_mu)
        alpha = min(
            1 + self.c1 / self.c_mu,
            1 + 2 * mu_eff_minus / (mu_eff + 2),
            (1 - self.c1 - self.c_mu) / (n * self.c_mu),
        )
        scale_minus = alpha / -sum(negative) if active else 0
        self.w = [w / sum(positive) if w >= 0 else w * scale_minus for w in raw]
        self.mu, self.mu_eff = len(positive), mu_eff
        self.c_sigma = (mu_eff + 2) / (n + mu_eff + 5)
        self.d_sigma = 1 + 2 * max(0, math.sqrt((mu_eff - 1) / (n + 1)) - 1) + self.c_sigma
        self.c_c = (4 + mu_eff / n) / (n + 4 + 2 * mu_eff / n)
        self.chi = math.sqrt(n) * (1 - 1 / (4 * n) + 1 / (21 * n**2))
        self.gap = max(1, int(1 / (2 * n * (self.c1 + self.c_mu))))
        self.decompose()

    def decompose(self):
        d2, b = np.linalg.eigh(self.c)
        self.inverse_root = b @ np.diag(1 / np.sqrt(d2)) @ b.T

    def tell(self, candidates, fitness):
        y = (sorted_by(fitness, candidates) - self.m) / self.sigma
        step = sum(w * row for w, row in zip(self.w[: self.mu], y, strict=False))
        self.m = self.m + self.sigma * step
        c = self.c_sigma
        self.p_sigma = (1 - c) * self.p_sigma + math.sqrt(c * (2 - c) * self.mu_eff) * (
            self.inverse_root @ step
        )
        length = np.linalg.norm(self.p_sigma)
        self.sigma *= math.exp(c / self.d_sigma * (length / self.chi - 1))
        self.g += 1
        bound = (1.4 + 2 / (self.n + 1)) * self.chi
        h = float(length / math.sqrt(1 - (1 - c) ** (2 * self.g)) < bound)
        c = self.c_c
        self.p_c = (1 - c) * self.p_c + h * math.sqrt(c * (2 - c) * self.mu_eff) * step
        delta = (1 - h) * c * (2 - c)
        new = (1 + self.c1 * delta - self.c1 - self.c_mu * sum(self.w)) * self.c
        new = new + self.c1 * np.outer(self.p_c, self.p_c)
        for w, row in zip(self.w, y, strict=True):
            if w < 0:
                w *= self.n / np.linalg.norm(self.inverse_root @ row) ** 2
            new = new + self.c_mu * w * np.outer(row, row)
        self.c = np.diag(np.diag(new)) if self.diagonal else new
        if self.g % self.gap == 0:
            self.decompose()


def nes_utilities(count):
    """Return the utilities of Wierstra and others (2014), section 3.1."""
    raw = [max(0, math.log(count / 2 + 1) - math.log(k)) for k in range(1, count + 1)]
    return [w / sum(raw) - 1 / count for w in raw]


class PlainXNES:
    """Wierstra and others (2014), algorithm 5, with the whole matrix of the gradient."""

    def __init__(self, mean, sigma, eta=0):
        d = self.d = len(mean)
        self.mu, self.sigma, self.b = mean, sigma, np.eye(d)
        self.eta = eta or 3 * (3 + math.log(d)) / (5 * d * math.sqrt(d))

    def tell(self, candidates, fitness):
        s = np.linalg.solve(self.sigma * self.b, (sorted_by(fitness, candidates) - self.mu).T).T
        u = nes_utilities(len(s))
        gradient_delta = sum(k * row for k, row in zip(u, s, strict=True))
        gradient_m = sum(
            k * (np.outer(row, row) - np.eye(self.d)) for k, row in zip(u, s, strict=True)
        )
        gradient_sigma = np.trace(gradient_m) / self.d
        gradient_b = gradient_m - gradient_sigma * np.eye(self.d)
        self.mu = self.mu + self.sigma * self.b @ gradient_delta
        self.sigma *= math.exp(self.eta / 2 * gradient_sigma)
        values, vectors = np.linalg.eigh(gradient_b)
        self.b = self.b @ (vectors * np.exp(self.eta / 2 * values)) @ vectors.T


class PlainSNES:
    """Wierstra and others (2014), algorithm 6."""

    def __init__(self, mean, sigma):
        self.mu, self.sigma = mean, np.full(len(mean), sigma)
        self.eta = (3 + math.log(len(mean))) / (5 * math.sqrt(len(mean)))

    def tell(self, candidates, fitness):
        s = (sorted_by(fitness, candidates) - self.mu) / self.sigma
        u = nes_utilities(len(s))
        gradient_mu = sum(k * row for k, row in zip(u, s, strict=True))
        gradient_sigma = sum(k * (row * row - 1) for k, row in zip(u, s, strict=True))
        self.mu = self.mu + self.sigma * gradient_mu
        self.sigma = self.sigma * np.exp(self.eta / 2 * gradient_sigma)


# --- A game of two sides that needs no robots, and plain Python for its algorithms.


SIZE = 5


def initial(index):
    """Return two random networks in a row."""
    return np.random.default_rng(index).normal(size=2 * SIZE)


def meetings(predators, prey):
    """Return the fitness of all against all, in a game where the best choice depends on the
    opponent.
    """
    near = np.abs(predators[:, None] - np.roll(prey, 1, axis=1)[None]).sum(axis=2)
    return np.round(1 / (1 + near), 3)


def play(predators, prey, pairs):
    """Return the same fitness, pair by pair."""
    return meetings(predators, prey)[tuple(pairs)]


class Individual:
    """An individual of the plain implementation."""

    def __init__(self, x, m, v):
        self.x, self.m, self.v = list(x), list(m), list(v)


def meeting(side, ours, theirs):
    """Return the own fitness of an individual of one side."""
    predator, prey = (ours, theirs) if side == 0 else (theirs, ours)
    near = sum(abs(predator[j] - prey[j - 1]) for j in range(SIZE))
    fitness = round(1 / (1 + near), 3)
    return fitness if side == 0 else 1 - fitness


def average(values):
    return math.fsum(values) / len(values)


def climb(config, one, directions, fitness):
    """Make a step of OpenAI-ES with an Individual, number by number, in place.

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
