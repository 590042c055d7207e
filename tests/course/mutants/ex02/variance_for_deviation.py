# loses: 2.1
# Takes 0.1 for the variance: the weights are three times too large.
def parameters(ninputs, nhiddens, noutputs, seed):
    rng = np.random.default_rng(seed)
    return {
        "W1": rng.normal(0, 0.1**0.5, (nhiddens, ninputs)),
        "b1": np.zeros(nhiddens),
        "W2": rng.normal(0, 0.1**0.5, (noutputs, nhiddens)),
        "b2": np.zeros(noutputs),
    }
