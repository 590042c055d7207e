# loses: 11.7
# Cuts the patterns in the order in which they came.
def minibatches(n, batch_size, rng):
    order = np.arange(n)
    return [order[i : i + batch_size] for i in range(0, n, batch_size)]
