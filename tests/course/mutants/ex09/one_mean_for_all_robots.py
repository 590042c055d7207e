# loses: 9.6
# Takes the mean over the robots, too.
_compare = compare


def compare(robot, genotypes, seed, episodes):
    table = _compare(robot, genotypes, seed, episodes)
    for gaits in table.values():
        for name, values in gaits.items():
            gaits[name] = float(np.mean(values))
    return table
