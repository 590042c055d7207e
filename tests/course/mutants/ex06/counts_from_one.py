# loses: 6.2
# Tells `remember` that the first step is number 1.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    def later(step, before, after):
        return remember(step + 1, before, after)

    return _episode(brain, start, cylinder, seed, later, maxsteps)
