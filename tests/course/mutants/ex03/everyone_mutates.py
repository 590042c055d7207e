# loses: 3.3
# The better half is mutated too, so that good solutions get lost.
def next_population(population, fitness, mutrate, rng):
    ranking = rank(fitness)
    half = len(population) // 2
    following = population.copy()
    following[ranking[half:]] = population[ranking[:half]]
    return following + mutrate * rng.standard_normal(population.shape)
