# loses: 8.5
# Leaves the bias correction out.
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v
