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
