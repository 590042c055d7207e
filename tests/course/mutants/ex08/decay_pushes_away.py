# loses: 8.4
# Decay with the wrong sign.
def descent(gradient, centre, wdecay):
    pull = {0: np.zeros(len(centre)), 1: centre, 2: np.sign(centre)}[wdecay]
    return -gradient - 0.005 * pull
