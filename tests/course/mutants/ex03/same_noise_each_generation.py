# loses: 3.4
# The generator of random numbers is made anew in each generation.
def evolve(evaluate, population, generations, mutrate, seed):
    best, best_fitness, history = population[0], -np.inf, []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = rank(fitness)[0]
        history.append(float(fitness[winner]))
        if fitness[winner] > best_fitness:
            best, best_fitness = population[winner].copy(), float(fitness[winner])
        population = next_population(population, fitness, mutrate, np.random.default_rng(seed))
    return {"best": best, "fitness": best_fitness, "history": history, "population": population}
