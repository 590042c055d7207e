# loses: 11.6
# Takes a column for one that changes if its deviation is a rounding error.
def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    deviation = np.where(deviation == 0, 1.0, deviation)
    return (inputs - mean) / deviation, mean, deviation
