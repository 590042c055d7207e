# loses: 5.8
# Takes the loss of the bodies for that of the brains.
_loss = loss


def loss(matrix):
    found = _loss(matrix)
    return found | {"brains": found["bodies"], "bodies": found["brains"]}
