# loses: 6.2
# Records the memory after each step, not the one that the network was given.
_episode = episode


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    recording = _episode(brain, start, cylinder, seed, remember, maxsteps)
    last = think(brain, recording["observations"][-1], recording["memories"][-1])[1]
    recording["memories"] = np.concatenate([recording["memories"][1:], last[None]])
    return recording
