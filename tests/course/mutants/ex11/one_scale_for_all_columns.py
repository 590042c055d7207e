# loses: 11.6
# All columns share one mean and one deviation.
def normalise(inputs):
    mean = np.full(inputs.shape[1], inputs.mean())
    deviation = np.full(inputs.shape[1], inputs.std() or 1.0)
    return (inputs - mean) / deviation, mean, deviation
