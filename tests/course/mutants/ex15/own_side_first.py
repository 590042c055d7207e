# loses: 15.6
# Lets the side itself change first, and does not look at the other order.
_red_queen = red_queen


def red_queen(matrix):
    parts, own = _red_queen(matrix), np.diag(matrix, -1) - np.diag(matrix)[:-1]
    return {**parts, "own": own, "others": parts["change"] - own}
