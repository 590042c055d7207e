# loses: 5.8
# Counts the bodies that do best with their own brain, instead of the brains.
_loss = loss


def loss(matrix):
    return _loss(matrix) | {"at home": _loss(matrix.T)["at home"]}
