# loses: 11.7
# Leaves out the patterns that do not fill a minibatch.
def minibatches(n, batch_size, rng):
    order = rng.permutation(n)
    return [order[i : i + batch_size] for i in range(0, n - batch_size + 1, batch_size)]
