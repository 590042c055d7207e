# loses: 8.7
# The smoothed curve keeps its length, with zeros from beyond its ends.
def smooth(curve, width):
    return np.convolve(curve, np.full(width, 1 / width), mode="same")
