# loses: 2.3
# One output whatever the number of choices.
def sizes(environment_id):
    env = gymnasium.make(environment_id)
    return env.observation_space.shape[0], 1
