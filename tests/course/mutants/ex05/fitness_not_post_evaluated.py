# loses: 5.5
# Returns the genotype with the best fitness, not the one with the best post-evaluated fitness.
def evolve_walkers(experiment_file, seeds, folder, steps=None):
    Path(folder).mkdir(parents=True, exist_ok=True)
    walkers = []
    for seed in seeds:
        run = Run(config.load(experiment_file), seed)
        evolve(run, Path(folder), steps)
        walkers.append(run.record.best)
    return np.array(walkers)
