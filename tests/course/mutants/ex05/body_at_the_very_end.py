# loses: 5.6
# Forgets the means and deviations that follow the body.
def body_of(genotype):
    return genotype[-BODY:]


def transplant(brain, body):
    chimera = brain.copy()
    chimera[-BODY:] = body[-BODY:]
    return chimera
