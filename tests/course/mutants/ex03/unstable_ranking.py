# loses: 3.2
# The rising order turned around: of equals the one with the higher number comes first.
def rank(fitness):
    return np.argsort(fitness, kind="stable")[::-1]
