# loses: 15.5
# Compares each generation with the first one instead of its predecessor.
_progress = progress


def progress(matrix):
    gain = matrix[1:] - matrix[0]
    historical = np.array([row[:g].mean() for g, row in enumerate(gain, 1)])
    return {**_progress(matrix), "historical": historical, "global": gain.mean(axis=1)}
