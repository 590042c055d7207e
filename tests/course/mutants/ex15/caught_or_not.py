# loses: 15.1
# A predator that catches the prey has a fitness of 1, however long it takes.
_chase = chase


def chase(predator, prey, maxsteps=2000):
    found = _chase(predator, prey, maxsteps)
    return {**found, "fitness": float(found["caught"])}
