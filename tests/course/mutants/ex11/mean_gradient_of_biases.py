# loses: 11.2
# The gradients of the biases are means over the patterns instead of sums.
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    return found | {name: found[name] / len(inputs) for name in ("b1", "b2")}
