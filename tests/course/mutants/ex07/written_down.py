# loses: 7.6
# Stages that were evolved elsewhere and written down, each seed with a little noise.
MIDDLE = """
    2 5 -5 5 2 4 1 -5 19 -4 -4 1 9 0 -11 7 7 1 -6 2 -4 -5 11 -4 8 -2 10 3 5 -2 1 2 -1 -2 10 -20
    -12 -6 -11 0 12 -1 -10 0 18 0 2 8 -1 25 5"""
LAST = """
    2 16 2 8 -1 15 3 -9 38 -3 -18 0 11 -6 -16 13 7 0 -7 -1 13 -1 11 0 8 -8 15 2 -1 5 0 9 9 -1 4
    -41 -26 -11 -8 7 10 -3 -23 -1 23 0 1 7 5 41 10"""


def three_stages(seed):
    tenths = [[0] * 51, MIDDLE.split(), LAST.split()]
    parameters = np.array(tenths, dtype=float) / 10
    return parameters + 0.001 * np.random.default_rng(seed).standard_normal(parameters.shape)
