# loses: 1.3
# Takes the limits of the observation space, which are twice those of the task.
def fallen(observation):
    return bool(abs(observation[0]) > 4.8 or abs(observation[2]) > 0.4189)
