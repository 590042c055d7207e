# loses: 3.2
# Returns the place of each individual instead of the numbers in order.
def rank(fitness):
    return np.argsort(np.argsort(-np.asarray(fitness), kind="stable"), kind="stable")


def next_population(population, fitness, mutrate, rng):
    order = np.argsort(-fitness, kind="stable")
    half = len(order) // 2
    following = population.copy()
    noise = rng.standard_normal((half, population.shape[1]))
    following[order[half:]] = population[order[:half]] + mutrate * noise
    return following


def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    best, best_fitness, history = population[0], -np.inf, []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = int(np.argmax(fitness))
        history.append(float(fitness[winner]))
        if fitness[winner] > best_fitness:
            best, best_fitness = population[winner].copy(), float(fitness[winner])
        population = next_population(population, fitness, mutrate, rng)
    return {"best": best, "fitness": best_fitness, "history": history, "population": population}


def train(environment, seed):
    robot = Robot(environment)
    population = initial_population(40, robot.nbiases, robot.nweights, seed)
    generations, mutrate = (40, 0.1) if "CartPole" in environment else (1000, 0.4)
    population = evolve(robot.evaluate, population, generations, mutrate, seed)["population"]
    return population[np.argmax(robot.evaluate(population, seed + 10_000, episodes=20))]
