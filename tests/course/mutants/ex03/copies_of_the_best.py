# loses: 3.3
# All the worse half become copies of the single best individual.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    following = population.copy()
    noise = rng.standard_normal((half, population.shape[1]))
    following[ranking[half:]] = population[ranking[0]] + mutrate * noise
    return following
