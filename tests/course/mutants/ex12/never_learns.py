# loses: 12.8
# Returns the parameters of the beginning.
_train = train


def train(environment, seed):
    return _train(environment, seed, iterations=1, attempts=1)
