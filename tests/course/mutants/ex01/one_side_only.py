# loses: 1.3
# Forgets that the pole can fall to the left, too.
def fallen(observation):
    return bool(observation[0] > 2.4 or observation[2] > np.deg2rad(12))
