# loses: 8.5
# Leaves out the small number that stands below the fraction, and divides by 0.
def adam(centre, d, m, v, t, stepsize):
    m = 0.9 * m + 0.1 * d
    v = 0.999 * v + 0.001 * d**2
    return centre - stepsize * (m / (1 - 0.9**t)) / np.sqrt(v / (1 - 0.999**t)), m, v
