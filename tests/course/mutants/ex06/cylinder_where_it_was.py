# loses: 6.2
# Leaves the cylinder where the seed has put it.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim")
    arena.reset(seed)
    return _episode(brain, start, arena.objects[0, :2], seed, remember, maxsteps)
