# loses: 1.5
# Brakes the pole but lets it lean: 180 of 200 steps.
def balance(observation):
    return int(observation[3] > 0)
