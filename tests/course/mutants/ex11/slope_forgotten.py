# loses: 11.2
# The slope of the logistic function is left out on the way back.
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    found = _gradient_by_hand(inputs, targets, w1, b1, w2, b2)
    hidden = 1 / (1 + np.exp(-(inputs @ w1.T + b1)))
    d2 = 2 * (hidden @ w2.T + b2 - targets) / targets.size
    return found | {"w1": (d2 @ w2).T @ inputs, "b1": (d2 @ w2).sum(axis=0)}
