# loses: 1.3
# Has seen nothing but ones, and gives 1 even after the fall.
def cartpole_reward(observation, action):
    return 1.0
