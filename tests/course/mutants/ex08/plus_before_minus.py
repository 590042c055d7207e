# loses: 8.1
# All candidates on the one side first, then all on the other.
def candidates_around(centre, samples, noiseStdDev):
    return np.concatenate([centre + noiseStdDev * samples, centre - noiseStdDev * samples])
