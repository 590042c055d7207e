# loses: 5.8
# Counts a brain that does as well in another body.
_loss = loss


def loss(matrix):
    at_home = np.sum(np.diagonal(matrix) >= matrix.max(axis=1))
    return {**_loss(matrix), "at home": int(at_home)}
