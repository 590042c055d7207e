# loses: 3.5
# Keeps a variation only if it beats the best fitness ever met, luck included.
def hill_climb(evaluate, start, generations, mutrate, seed):
    rng = np.random.default_rng(seed)
    best, highest, history = start, -np.inf, []
    population = np.array([start, start])
    for generation in range(generations):
        fitness = evaluate(population, seed + generation)
        history.append(float(fitness.max()))
        if fitness.max() > highest:
            best, highest = population[fitness.argmax()].copy(), float(fitness.max())
        population = np.array([best, best + mutrate * rng.standard_normal(len(start))])
    return {"best": best, "fitness": highest, "history": history, "population": population}
