# loses: 8.5
# Changes the array of the centre that it was given.
_adam = adam


def adam(centre, d, m, v, t, stepsize):
    moved, m, v = _adam(centre, d, m, v, t, stepsize)
    centre[:] = moved
    return centre, m, v
