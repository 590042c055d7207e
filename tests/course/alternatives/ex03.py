"""Right solutions of exercise 3 in other styles; building.py describes how a case is written."""

# %% other_strategy_for_training
# A class with a generator of generations; `train` uses a strategy of its own with a moving centre.
from itertools import islice

evaluate_pendulum = Robot("Pendulum-v1").evaluate  # kept since the file was loaded
evaluate_cartpole = Robot("CartPole-v0").evaluate


def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng(seed)
    columns = [np.zeros(popsize)] * nbiases + [rng.normal(0, 0.1, popsize) for _ in range(nweights)]
    return np.column_stack(columns)


def rank(fitness):
    left, order = list(fitness), []
    while len(order) < len(left):
        best = None
        for i, value in enumerate(left):
            if i not in order and (best is None or value > left[best]):
                best = i
        order.append(best)
    return tuple(order)


def next_population(population, fitness, mutrate, rng):
    order = list(rank(fitness))
    half = len(order) // 2
    parents = population[order[:half]]
    children = rng.normal(loc=parents, scale=mutrate)
    return np.concatenate([children, parents])[rng.permutation(2 * half)]


class SteadyState:
    def __init__(self, evaluate, population, mutrate, seed):
        self.evaluate, self.mutrate, self.seed = evaluate, mutrate, seed
        self.population = np.array(population)
        self.rng = np.random.default_rng(seed)

    def __iter__(self):
        seed = self.seed
        while True:
            fitness = self.evaluate(self.population, seed)
            i = int(np.argmax(fitness))
            met = float(fitness[i]), self.population[i].copy()
            self.population = next_population(self.population, fitness, self.mutrate, self.rng)
            yield met
            seed += 1


def evolve(evaluate, population, generations, mutrate, seed):
    run = SteadyState(evaluate, population, mutrate, seed)
    met = list(islice(run, generations))
    highest = max(met, key=lambda each: each[0])
    return {
        "history": [fitness for fitness, _ in met],
        "fitness": highest[0],
        "best": highest[1],
        "population": run.population,
    }


def hill_climb(evaluate, start, generations, mutrate, seed):
    return evolve(evaluate, [start] * 2, generations, mutrate, seed)


def replicate(experiment, seeds):
    found = {seed: experiment(seed) for seed in seeds}
    table = np.array([found[seed]["history"] for seed in seeds])
    centred = table - table.mean(0)
    with np.errstate(divide="ignore", invalid="ignore"):
        variance = np.einsum("rg,rg->g", centred, centred) / np.float64(len(seeds) - 1)
    return {
        "mean": table.mean(0),
        "deviation": np.nan_to_num(np.sqrt(variance)),
        "best": tuple(found[seed]["fitness"] for seed in seeds),
    }


def train(environment, seed):
    """The mean of the best quarter becomes the centre of the next generation; three attempts."""
    robot = Robot(environment)
    evaluate = evaluate_cartpole if environment == "CartPole-v0" else evaluate_pendulum
    rng = np.random.default_rng(seed)
    generations = 30 if environment == "CartPole-v0" else 300
    found = []
    for attempt in range(3):
        centre, spread = np.zeros(robot.nbiases + robot.nweights), 1.0
        for g in range(generations):
            population = rng.normal(centre, spread, size=(80, len(centre)))
            fitness = evaluate(population, int(rng.integers(2**31)), episodes=8)
            elite = population[np.argsort(fitness)[-20:]]
            centre, spread = elite.mean(axis=0), np.maximum(elite.std(axis=0), 0.3)
        found += [centre, *elite]
    return found[evaluate(np.array(found), seed, episodes=100).argmax()]


# %% single_precision
# Single precision; index arithmetic in place of fancy indexing; noise drawn for everybody.
def initial_population(popsize, nbiases, nweights, seed):
    random = np.random.RandomState(seed)
    population = np.zeros((popsize, nbiases + nweights), dtype=np.float32)
    population[:, nbiases:] = random.normal(scale=0.1, size=(popsize, nweights))
    return population


def rank(fitness):
    order = np.lexsort((np.arange(len(fitness)), -np.asarray(fitness)))
    return order.astype(np.int32)


def next_population(population, fitness, mutrate, rng):
    noise = rng.standard_normal(population.shape, dtype=np.float32)
    after = np.array(population, dtype=np.float32)
    order = rank(fitness)
    for good, bad in zip(order, order[::-1]):
        if list(order).index(good) < len(order) // 2:
            after[bad] = population[good] + np.float32(mutrate) * noise[bad]
    return after


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    population = np.float32(population)
    history = np.zeros(generations, dtype=np.float32)
    bests = []
    for g in range(generations):
        fitness = np.float32(evaluate(population, seed + g))
        bests.append(population[fitness.argmax()].copy())
        history[g] = fitness.max()
        population = next_population(population, fitness, mutrate, rng)
    return {
        "best": bests[history.argmax()],
        "fitness": history.max(),
        "history": history,
        "population": population,
    }


def hill_climb(evaluate, start, generations, mutrate, seed):
    return evolve(evaluate, np.tile(start, (2, 1)), generations, mutrate, seed)


def replicate(experiment, seeds):
    runs = [experiment(int(seed)) for seed in np.array(seeds)]
    table = np.stack([run["history"] for run in runs]).astype(np.float64)
    n = len(runs)
    squares = ((table - table.sum(0) / n) ** 2).sum(0)
    return {
        "mean": table.sum(0) / n,
        "deviation": np.sqrt(squares / max(n - 1, 1)),
        "best": np.array([run["fitness"] for run in runs]),
    }


def train(environment, seed):
    robot = Robot(environment)
    start = initial_population(40, robot.nbiases, robot.nweights, seed)
    cartpole = environment.startswith("CartPole")
    run = evolve(robot.evaluate, start, 30 if cartpole else 700, 0.3 if cartpole else 0.8, seed)
    again = robot.evaluate(run["population"], seed + 777_777, episodes=20)
    return run["population"][again.argmax()]


# %% survivors_first
# Lists of rows, best first, then the children; noise child by child; plain sorting and statistics.
import statistics


def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng(seed)
    return [[0.0] * nbiases + [rng.normal(0, 0.1) for _ in range(nweights)] for _ in range(popsize)]


def rank(fitness):
    return sorted(range(len(fitness)), key=lambda i: fitness[i], reverse=True)


def next_population(population, fitness, mutrate, rng):
    order = rank(fitness)
    survivors = [population[i] for i in order[: len(order) // 2]]
    children = []
    for parent in survivors:
        children.append(np.array([value + mutrate * rng.standard_normal() for value in parent]))
    return survivors + children


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    report = {"best": None, "fitness": float("-inf"), "history": []}
    for g in range(generations):
        fitness = evaluate(np.array(population), seed + g)
        top = max(range(len(fitness)), key=lambda i: fitness[i])
        report["history"] += [fitness[top]]
        if fitness[top] > report["fitness"]:
            report["best"], report["fitness"] = list(population[top]), fitness[top]
        population = next_population(population, fitness, mutrate, rng)
    report["population"] = population
    return report


def hill_climb(evaluate, start, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    old, new = start, start
    best, history = (-np.inf, None), []
    for g in range(generations):
        first, second = evaluate(np.stack([old, new]), seed + g)
        history.append(max(first, second))
        if second > first:
            old = new
        if history[-1] > best[0]:
            best = (history[-1], old)
        new = old + rng.normal(0, mutrate, size=len(start))
    return {"best": best[1], "fitness": best[0], "history": history, "population": [old, new]}


def replicate(experiment, seeds):
    runs = list(map(experiment, seeds))
    columns = list(zip(*(run["history"] for run in runs)))
    return {
        "mean": [statistics.fmean(column) for column in columns],
        "deviation": [statistics.stdev(column) if len(runs) > 1 else 0 for column in columns],
        "best": [run["fitness"] for run in runs],
    }


def train(environment, seed):
    robot = Robot(environment)
    size, rate, generations = (10, 0.2, 60) if environment == "CartPole-v0" else (30, 0.6, 900)
    population = np.array(initial_population(size, robot.nbiases, robot.nweights, seed))
    rng = np.random.default_rng(seed)
    for g in range(generations):
        fitness = robot.evaluate(population, seed * 1000 + g)
        population = np.array(next_population(population, fitness, rate, rng))
    return population[int(np.argmax(robot.evaluate(population, seed + 999, episodes=30)))].tolist()


# %% seed_sequences
# Children of a SeedSequence; argpartition to select; the best is found after the loop.
def initial_population(popsize, nbiases, nweights, seed):
    rows = []
    for child in np.random.SeedSequence(seed).spawn(popsize):
        rows.append(np.r_[np.zeros(nbiases), np.random.default_rng(child).normal(0, 0.1, nweights)])
    return np.vstack(rows)


def next_population(population, fitness, mutrate, rng):
    population = np.asarray(population)
    half = len(population) // 2
    better = np.argpartition(-np.asarray(fitness), half - 1)[:half]
    worse = np.setdiff1d(np.arange(len(population)), better)
    following = np.empty_like(population)
    following[better] = population[better]
    following[worse] = rng.normal(population[rng.permutation(better)], mutrate)
    return following


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    table, populations = [], []
    for s in range(seed, seed + generations):
        populations.append(np.array(population))
        table.append(np.asarray(evaluate(population, s)))
        population = next_population(population, table[-1], mutrate, rng)
    g, i = np.unravel_index(np.argmax(table), np.shape(table))
    return dict(
        best=populations[g][i],
        fitness=table[g][i],
        history=np.max(table, axis=1),
        population=population,
    )


# %% heap_of_rows
# A heap for the ranks, tuples for rows, deques for histories, Welford's sums for the deviation.
import heapq
from collections import deque


def rank(fitness):
    heap = [(-float(value), i) for i, value in enumerate(fitness)]
    heapq.heapify(heap)
    return [heapq.heappop(heap)[1] for _ in range(len(heap))]


def evolve(evaluate, population, generations, mutrate, seed):
    rng, history, record = np.random.default_rng(seed), deque(), (None, None)
    for g in range(generations):
        fitness = np.asarray(evaluate(population, seed + g), dtype=float)
        history.append(np.amax(fitness))
        if record[1] is None or fitness.max() >= record[1]:
            record = tuple(population[int(fitness.argmax())]), fitness.max()
        population = next_population(population, fitness, mutrate, rng)
    return {
        "best": list(record[0]),
        "fitness": np.float64(record[1]),
        "history": list(history),
        "population": np.ascontiguousarray(population),
        "generations": generations,
    }


def hill_climb(evaluate, start, generations, mutrate, seed):
    return evolve(evaluate, np.repeat(start[None, :], 2, axis=0), generations, mutrate, seed)


def replicate(experiment, seeds):
    best, n, mean, squares = [], 0, 0.0, 0.0
    for seed in seeds:
        run = experiment(seed)
        n += 1
        away = np.asarray(run["history"]) - mean
        mean = mean + away / n
        squares = squares + away * (np.asarray(run["history"]) - mean)
        best.append(run["fitness"])
    deviation = np.sqrt(squares / (n - 1)) if n > 1 else 0 * mean
    return {"mean": mean, "deviation": deviation, "best": best}


# %% training_in_two_rounds
# Several short evolutions compete; the winner's relatives are evolved on; integers as seeds of numpy.
def train(environment, seed):
    robot = Robot(environment)
    cartpole = environment == "CartPole-v0"
    rate, first, second = (0.1, 10, 60) if cartpole else (0.5, 100, 800)
    tribes = []
    for tribe in range(3):
        s = np.int64(10 * seed + tribe)
        start = initial_population(30, robot.nbiases, robot.nweights, s)
        population = evolve(robot.evaluate, start, first, rate, int(s))["population"]
        tribes.append((robot.evaluate(population, 77, episodes=20).mean(), tribe, population))
    population = max(tribes)[2]
    population = evolve(robot.evaluate, population, second, rate, 10 * seed + 9)["population"]
    scores = sum(robot.evaluate(population, seed + k, episodes=20) for k in (501, 502, 503))
    return np.asarray(population[int(np.argmax(scores))], dtype=np.float32)


# %% plain_python
# Python's random and recursion; rows are lists, histories tuples; Fractions for the statistics.
import functools
import math
import random
from collections import OrderedDict
from fractions import Fraction


def initial_population(popsize, nbiases, nweights, seed):
    draw = random.Random(seed)
    return tuple(
        (0,) * nbiases + tuple(draw.gauss(0, 0.1) for _ in range(nweights)) for _ in range(popsize)
    )


def rank(fitness):
    def before(i, j):
        return float(fitness[j] > fitness[i]) - float(fitness[j] < fitness[i]) or i - j

    return sorted(range(len(fitness)), key=functools.cmp_to_key(before))


def next_population(population, fitness, mutrate, rng):
    order = rank(fitness)
    half = len(order) // 2
    better = [tuple(population[i]) for i in order[:half]]
    children = [tuple(rng.normal(value, mutrate) for value in parent) for parent in better]
    return children[::-1] + better


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)

    history, met = (), []
    for g in range(generations):
        fitness = [float(value) for value in evaluate(np.array(population), seed + g)]
        i = fitness.index(max(fitness))
        history += (fitness[i],)
        met.append((fitness[i], -g, population[i]))
        population = next_population(population, fitness, mutrate, rng)
    fitness, _, best = max(met, key=lambda each: each[:2])
    return OrderedDict(best=best, fitness=fitness, history=history, population=population)


def hill_climb(evaluate, start, generations, mutrate, seed):
    return evolve(evaluate, (tuple(start), tuple(start)), generations, mutrate, seed)


def replicate(experiment, seeds):
    runs = [experiment(seed) for seed in tuple(seeds)]
    n = len(runs)
    means, deviations = [], []
    for values in zip(*(run["history"] for run in runs)):
        exact = [Fraction(float(value)) for value in values]
        mean = sum(exact) / n
        means.append(float(mean))
        deviations.append(math.sqrt(sum((x - mean) ** 2 for x in exact) / (n - 1)) if n > 1 else 0)
    return OrderedDict(mean=means, deviation=deviations, best=tuple(run["fitness"] for run in runs))


# %% selection_matrices
# Single precision; selection by a matrix of zeros and ones; noise for all, masked; a class for the run.
def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.Generator(np.random.Philox(seed))
    mask = np.r_[np.zeros(nbiases), np.ones(nweights)].astype(np.float32)
    return np.einsum(
        "pw,w->pw",
        rng.standard_normal((popsize, nbiases + nweights), dtype=np.float32),
        mask * np.float32(0.1),
    )


def rank(fitness):
    values = np.asarray(fitness)
    i = np.arange(len(values))
    ahead = (values[None] > values[:, None]) | (
        (values[None] == values[:, None]) & (i[None] < i[:, None])
    )
    order = np.empty(len(values), dtype=np.uint16)
    order[ahead.sum(axis=1)] = i
    return order


def next_population(population, fitness, mutrate, rng):
    population = np.asarray(population, dtype=np.float32)
    n = len(population)
    order = np.asarray(rank(fitness), dtype=int)
    pick = np.zeros((n, n), dtype=np.float32)
    pick[order[: n // 2], order[: n // 2]] = 1
    pick[order[n // 2 :], order[: n // 2][::-1]] = 1
    keep = np.zeros((n, 1), dtype=np.float32)
    keep[order[n // 2 :]] = mutrate
    return np.einsum("ij,jk->ik", pick, population) + keep * rng.standard_normal(
        population.shape
    ).astype(np.float32)


class Run:
    def __init__(self, evaluate, population, mutrate, seed):
        self.evaluate, self.mutrate, self.seed, self.rng = (
            evaluate,
            mutrate,
            seed,
            np.random.default_rng(seed),
        )
        self.population = np.array(population, dtype=np.float32)
        self.history = np.array([], dtype=np.float32)
        self.record = None

    def generation(self):
        fitness = np.asarray(
            self.evaluate(self.population, self.seed + len(self.history)), dtype=np.float32
        )
        if self.record is None or fitness.max() > self.record[0]:
            self.record = fitness.max(), self.population[fitness.argmax()]
        self.history = np.append(self.history, fitness.max())
        self.population = next_population(self.population, fitness, self.mutrate, self.rng)

    def report(self):
        return dict(
            best=self.record[1],
            fitness=self.record[0],
            history=self.history,
            population=self.population,
        )


def evolve(evaluate, population, generations, mutrate, seed):
    run = Run(evaluate, population, mutrate, seed)
    for _ in range(generations):
        run.generation()
    return run.report()


def hill_climb(evaluate, start, generations, mutrate, seed):
    run = Run(evaluate, np.broadcast_to(start, (2, len(start))), mutrate, seed)
    [run.generation() for _ in range(generations)]
    return run.report()


def replicate(experiment, seeds):
    runs = [experiment(seed) for seed in iter(seeds)]
    table = np.array([run["history"] for run in runs], dtype=np.float32)
    deviation = np.std(table, axis=0, ddof=1) if len(runs) != 1 else 0.0 * table[0]
    return {
        "mean": table.mean(axis=0),
        "deviation": deviation,
        "best": np.float32([run["fitness"] for run in runs]),
    }


# %% antithetic_training
# Trains with pairs of opposite noise and a moving centre that is evaluated as well; SeedSequence for all.
def train(environment, seed):
    robot = Robot(environment)
    sequence = np.random.SeedSequence(seed)
    rng = np.random.default_rng(sequence)
    n = robot.nbiases + robot.nweights
    best = (-np.inf, None)
    for attempt in range(3):
        centre = rng.normal(0, 0.1, n)
        rate = 0.3 if environment == "CartPole-v0" else 0.6
        for g in range(40 if environment == "CartPole-v0" else 350):
            noise = rng.standard_normal((30, n))
            candidates = np.vstack([centre + rate * noise, centre - rate * noise])
            fitness = robot.evaluate(candidates, int(rng.integers(1 << 30)))
            centre = candidates[np.argsort(fitness)[-12:]].mean(axis=0)
        value = robot.evaluate(centre[None], 12345, episodes=60)[0]
        if value > best[0]:
            best = (value, centre)
    return best[1]


# %% plain_python_again
# Sorted lists and loops.
def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng([seed, 7])
    return np.array(
        [
            [0.0] * nbiases + [0.1 * rng.standard_normal() for _ in range(nweights)]
            for _ in range(popsize)
        ]
    ).reshape(popsize, nbiases + nweights)


def rank(fitness):
    return sorted(range(len(fitness)), key=lambda i: (-fitness[i], i))


def next_population(population, fitness, mutrate, rng):
    order = rank(fitness)[: len(population) // 2]
    kept = np.array([population[i] for i in order])
    return np.concatenate([rng.normal(kept, mutrate), kept])


def evolve(evaluate, population, generations, mutrate, seed):
    rng, met, history = np.random.default_rng(seed), [], []
    for g in range(generations):
        f = np.array(evaluate(population, seed + g), dtype=float)
        k = int(f.argmax())
        met.append((float(f[k]), population[k].copy()))
        history.append(float(f.max()))
        population = next_population(population, f, mutrate, rng)
    top = max(range(generations), key=lambda g: (met[g][0], -g))
    return {
        "best": met[top][1],
        "fitness": met[top][0],
        "history": np.array(history),
        "population": population,
    }


def hill_climb(evaluate, start, generations, mutrate, seed):
    return evolve(evaluate, np.tile(start, (2, 1)), generations, mutrate, seed)


def replicate(experiment, seeds):
    runs = list(map(experiment, seeds))
    n = len(runs)
    columns = list(zip(*(run["history"] for run in runs)))
    means = [sum(c) / n for c in columns]
    spread = [
        (sum((x - m) ** 2 for x in c) / (n - 1)) ** 0.5 if n > 1 else 0.0
        for c, m in zip(columns, means)
    ]
    return {"mean": means, "deviation": spread, "best": [run["fitness"] for run in runs]}


# %% read_only_population
# Nobody can write into the population that is returned.
def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng(seed)
    population = np.zeros((popsize, nbiases + nweights), dtype=np.float32, order="F")
    population[:, nbiases:] = rng.standard_normal((popsize, nweights), dtype=np.float32)
    population *= np.float32(0.1)
    population.flags.writeable = False
    return population
