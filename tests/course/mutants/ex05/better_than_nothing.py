# loses: 5.8
# Puts 0 on the diagonal to find the best of the others, which beats returns below 0.
_loss = loss


def loss(matrix):
    others = matrix * (1 - np.eye(len(matrix)))
    at_home = np.sum(np.diagonal(matrix) > others.max(axis=1))
    return {**_loss(matrix), "at home": int(at_home)}
