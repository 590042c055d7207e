# loses: 2.1
# Seeds again for the second layer, which gets the numbers of the first.
def parameters(ninputs, nhiddens, noutputs, seed):
    return {
        "W1": 0.1 * np.random.default_rng(seed).standard_normal((nhiddens, ninputs)),
        "b1": np.zeros(nhiddens),
        "W2": 0.1 * np.random.default_rng(seed).standard_normal((noutputs, nhiddens)),
        "b2": np.zeros(noutputs),
    }
