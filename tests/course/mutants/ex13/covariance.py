# loses: 13.7
# The covariance, which depends on the units.
def responses(activations, observations):
    h, x = activations - activations.mean(axis=0), observations - observations.mean(axis=0)
    return h.T @ x / len(h)
