# loses: 5.6
# Puts the body into the brain's own genotype.
def transplant(brain, body):
    brain[-2 * OBSERVATIONS - BODY : -2 * OBSERVATIONS] = body_of(body)
    return brain
