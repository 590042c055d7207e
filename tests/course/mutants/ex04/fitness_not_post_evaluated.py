# loses: 4.3
# Returns the best fitness of each run instead of the best post-evaluated one.
def run_replications(experiment_file, seeds, folder, steps=None):
    Path(folder).mkdir(parents=True, exist_ok=True)
    fitness = {}
    for seed in seeds:
        run = Run(config.load(experiment_file), seed)
        evolve(run, Path(folder), steps)
        fitness[seed] = float(run.record.best_fitness)
    return fitness
