# loses: 6.6
# Adds the returns of all episodes.
_memory_test = memory_test


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    returns = _memory_test(brain, starts, cylinder, seed, since, maxsteps)
    return {name: value * len(starts) for name, value in returns.items()}
