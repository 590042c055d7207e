# loses: 8.2
# Takes the order of the candidates for their ranks.
def utilities(fitness):
    return np.argsort(fitness, kind="stable") / (len(fitness) - 1) - 0.5
