# loses: 6.2
# Does not ask what is to be remembered.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    return _episode(brain, start, cylinder, seed, keep, maxsteps)
