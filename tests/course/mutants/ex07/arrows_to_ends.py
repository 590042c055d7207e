# loses: 7.3
# Gives where the arrows end instead of how far they go.
_arrows = arrows


def arrows(before, after):
    return np.hstack([before, before + _arrows(before, after)[:, 2:]])
