# loses: 1.5
# Follows the angle and not its speed: swings up and falls after some 40 steps.
def balance(observation):
    return int(observation[2] > 0)
