# loses: 15.2
# Puts both generations first, then both individuals.
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return _tournament(predators, prey, maxsteps).swapaxes(1, 2)
