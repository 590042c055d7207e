# loses: 6.4
# Gives NaN where no step belongs to the search or to the time near the cylinder.
def mean(values):
    return float(np.sum(values)) / len(values) if len(values) else float("nan")
