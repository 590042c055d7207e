# loses: 9.6
# Plays the same episode over and over.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    return _compare(robot, genotypes, seed, 1)
