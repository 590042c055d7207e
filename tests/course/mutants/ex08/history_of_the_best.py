# loses: 8.6
# The history holds the fitness of the best candidate instead of the mean.
_evolve = evolve


def evolve(evaluate, centre, generations, seed, **hyperparameters):
    best = []

    def watched(candidates, seed):
        fitness = evaluate(candidates, seed)
        best.append(float(np.max(fitness)))
        return fitness

    return {**_evolve(watched, centre, generations, seed, **hyperparameters), "history": best}
