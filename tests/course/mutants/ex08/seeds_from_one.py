# loses: 8.6
# Counts the generations from 1, so that each meets the starting conditions of the next.
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    def later(candidates, seed):
        return evaluate(candidates, seed + 1)

    return _evolve(later, centre, generations, seed, **hyperparameters)
