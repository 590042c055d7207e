# loses: 8.5
# Adds the small number before the root is taken.
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t) + 1e-8), m, v
