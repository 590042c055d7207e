# loses: 8.6
# Hands no weight decay on to the optimiser.
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    return _evolve(evaluate, centre, generations, seed, **{**hyperparameters, "wdecay": 0})
