# loses: 12.7
# Takes the parameter for the logarithm of the variance.
def gaussian_action(mean, log_deviation, rng):
    return mean + np.exp(log_deviation / 2) * rng.standard_normal(len(mean))
