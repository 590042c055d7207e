# loses: 3.4
# Reports the best of the last generation instead of the best of all.
def evolve(evaluate, population, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    history = []
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        winner = rank(fitness)[0]
        best = population[winner].copy()
        history.append(float(fitness[winner]))
        population = next_population(population, fitness, mutrate, rng)
    return {"best": best, "fitness": history[-1], "history": history, "population": population}
