# loses: 8.2
# Equals share their mean rank.
_utilities = utilities


def utilities(fitness):
    first = _utilities(np.asarray(fitness))
    return np.array([first[fitness == value].mean() for value in fitness])
