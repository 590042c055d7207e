# loses: 2.1
# Draws the biases, too.
_parameters = parameters


def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed + 1)
    biases = {"b1": 0.1 * rng.normal(size=nhiddens), "b2": 0.1 * rng.normal(size=noutputs)}
    return {**_parameters(ninputs, nhiddens, noutputs, seed), **biases}
