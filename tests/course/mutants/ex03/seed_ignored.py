# loses: 3.1
# The seed is ignored: the same seed gives another population each time.
def initial_population(popsize, nbiases, nweights, seed):
    rng = np.random.default_rng()
    weights = 0.1 * rng.standard_normal((popsize, nweights))
    return np.hstack([np.zeros((popsize, nbiases)), weights])
