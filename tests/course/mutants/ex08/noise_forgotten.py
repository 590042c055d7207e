# loses: 8.1
# Forgets noiseStdDev, so that candidates lie far from the centre.
def candidates_around(centre, samples, noiseStdDev):
    both = np.stack([centre + samples, centre - samples], axis=1)
    return both.reshape(-1, len(centre))
