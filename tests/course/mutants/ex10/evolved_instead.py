# loses: 10.10
# Hands in an evolved controller as a network of one layer.
def train(seed):
    bias, *weights = evolve(seed)
    return [[np.array([weights]), np.array([bias])]]
