# loses: 7.5
# Keeps every n-th generation, but not the last one.
_evolve = evolve


def evolve(algorithm, evaluate, generations, every):
    run = _evolve(algorithm, evaluate, generations, every)
    regular = [i for i, generation in enumerate(run["generations"]) if generation % every == 0]
    kept = [run["generations"][i] for i in regular]
    return {**run, "generations": kept, "parameters": run["parameters"][regular]}
