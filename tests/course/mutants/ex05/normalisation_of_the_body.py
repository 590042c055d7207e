# loses: 5.6
# Lets the means and deviations move along with the body.
def transplant(brain, body):
    chimera = brain.copy()
    chimera[-2 * OBSERVATIONS - BODY :] = body[-2 * OBSERVATIONS - BODY :]
    return chimera
