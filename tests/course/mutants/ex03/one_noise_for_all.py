# loses: 3.3
# One vector of noise is added to all copies.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    following = population.copy()
    noise = rng.standard_normal(population.shape[1])
    following[ranking[half:]] = population[ranking[:half]] + mutrate * noise
    return following
