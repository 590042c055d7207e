# loses: 5.7
# Evaluates each pair with another seed.
def cross_evaluate(experiment_file, walkers, seed, episodes):
    n = len(walkers)
    matrix = np.zeros((n, n))
    for i, j in np.ndindex(n, n):
        robot = SavedRobot(experiment_file, transplant(walkers[i], walkers[j]))
        matrix[i, j] = robot.evaluate(seed + n * i + j, episodes).mean()
    return matrix
