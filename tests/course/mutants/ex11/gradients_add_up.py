# loses: 11.3
# Goes backward twice: torch adds the second gradient to the first.
_gradient_by_torch = gradient_by_torch


def gradient_by_torch(inputs, targets, *parameters):
    found = _gradient_by_torch(inputs, targets, *parameters)
    return found | {name: 2 * found[name] for name in ("w1", "b1", "w2", "b2")}
