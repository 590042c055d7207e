# loses: 15.2
# Gives what the prey gets.
_tournament = tournament


def tournament(predators, prey, maxsteps=2000):
    return 1 - _tournament(predators, prey, maxsteps)
