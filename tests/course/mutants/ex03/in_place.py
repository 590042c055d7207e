# loses: 3.3
# The population given is changed in place.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    noise = rng.standard_normal((half, population.shape[1]))
    population[ranking[half:]] = population[ranking[:half]] + mutrate * noise
    return population
