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
