# loses: 3.1
# All individuals are copies of a single random one.
def initial_population(popsize, nbiases, nweights, seed):
    weights = 0.1 * np.random.default_rng(seed).standard_normal(nweights)
    return np.tile(np.concatenate([np.zeros(nbiases), weights]), (popsize, 1))
