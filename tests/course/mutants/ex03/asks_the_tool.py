# loses: 3.3
# Lets the tool's steady state do the selection and the mutations.
def next_population(population, fitness, mutrate, rng):
    from botschool.evolution.algorithms.sss import SSS, SSSConfig

    config = SSSConfig(popsize=len(population), mutrate=mutrate)
    algorithm = SSS(config, lambda i: population[i], int(rng.integers(2**31)))
    algorithm.tell(np.asarray(fitness))
    return algorithm.population
