# loses: 8.2
# The best candidate gets the lowest utility.
_utilities = utilities


def utilities(fitness):
    return -_utilities(fitness)
