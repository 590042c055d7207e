# loses: 8.5
# Hands the corrected m and v on to the next generation.
def adam(centre, d, m, v, t, stepsize):
    m = (0.9 * m + 0.1 * d) / (1 - 0.9**t)
    v = (0.999 * v + 0.001 * d**2) / (1 - 0.999**t)
    return centre - stepsize * m / (np.sqrt(v) + 1e-8), m, v
