# loses: 3.1
# Uniform weights with the right deviation, and random biases.
def initial_population(popsize, nbiases, nweights, seed):
    limit = 0.1 * np.sqrt(3)
    return np.random.default_rng(seed).uniform(-limit, limit, (popsize, nbiases + nweights))
