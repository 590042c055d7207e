# loses: 7.6
# Takes the stage in the middle of the run, when the pendulum is up already.
def three_stages(seed):
    robot = Robot("Pendulum-v1")

    def evaluate(candidates, generation):
        return robot.evaluate(candidates, seed + generation, episodes=10)

    parameters = evolve(openai_es(robot, seed), evaluate, generations=600, every=300)["parameters"]
    return parameters[[0, 1, 2]]
