# loses: 3.7
# Returns a random controller.
def train(environment, seed):
    robot = Robot(environment)
    return initial_population(1, robot.nbiases, robot.nweights, seed)[0]
