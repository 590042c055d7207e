# loses: 11.6
# The deviation divides by n - 1.
def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0, ddof=1)
    deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
    return (inputs - mean) / deviation, mean, deviation
