# loses: 15.1
# Keeps a window on the arena instead of the poses of each step.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    found["poses"] = np.tile(found["poses"][-1], (len(found["poses"]), 1, 1))
    return found
