# loses: 4.2
# Gives 1 instead of 0 for reaching the line.
def reward(observation):
    return 1.0 if height(observation) > 1 else -1.0
