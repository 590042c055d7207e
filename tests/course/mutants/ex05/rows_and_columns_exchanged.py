# loses: 5.7
# Has a row for each body and a column for each brain.
_cross_evaluate = cross_evaluate


def cross_evaluate(experiment_file, walkers, seed, episodes):
    return _cross_evaluate(experiment_file, walkers, seed, episodes).T
