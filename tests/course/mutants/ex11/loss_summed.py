# loses: 11.2
# The loss is the sum of the squares, not their mean.
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    return found | {"loss": found["loss"] * targets.size}
