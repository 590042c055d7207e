# loses: 6.5
# Compares steps, millimetres and radians.
_families = families


def families(table, threshold):
    global standardise
    proper, standardise = standardise, lambda table: np.asarray(table)
    try:
        return _families(table, threshold)
    finally:
        standardise = proper
