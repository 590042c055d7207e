# loses: 15.2
# Lets only those of the same generation meet.
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    table = _tournament(predators, prey, maxsteps)
    same = np.arange(len(predators))[:, None] == np.arange(len(prey))
    return table * same[:, None, :, None]
