# loses: 7.3
# Computes the change in the array of the states, which the next arrow begins with.
def arrows(before, after):
    kept = before.copy()
    after -= before
    after[:, 0] = (after[:, 0] + np.pi) % (2 * np.pi) - np.pi
    return np.hstack([kept, after])
