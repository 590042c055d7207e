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
