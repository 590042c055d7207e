# loses: 5.1, 5.2, 5.3
# Lets the environment's own code take the body apart.
def sizes(parameters):
    from botschool.envs.morphology import decode

    body = decode(parameters)
    masses = body.lengths * body.thicknesses * body.densities
    return {"lengths": body.lengths, "thicknesses": body.thicknesses, "masses": masses}


def joints(parameters):
    from botschool.envs.morphology import decode

    body = decode(parameters)
    return {"angles": body.angles, "lower": body.limits[:, 0], "upper": body.limits[:, 1]}


def outline(parameters):
    from botschool.envs import morphology

    return morphology.decode(parameters).corners()
