# loses: 8.8
# Gives up after one generation.
_evolve_8 = evolve


def train(environment, seed):
    robot = Robot(environment)
    centre = np.random.default_rng(seed).normal(scale=0.1, size=robot.nbiases + robot.nweights)
    return _evolve_8(robot.evaluate, centre, 1, seed)["centre"]
