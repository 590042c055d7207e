# loses: 11.6
# A column that never changes is divided by 0.
def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    return (inputs - mean) / deviation, mean, deviation
