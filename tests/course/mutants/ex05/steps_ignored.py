# loses: 5.5
# Does not end the runs after the steps asked for.
_evolve_walkers = evolve_walkers


def evolve_walkers(experiment_file, seeds, folder, steps=None):
    return _evolve_walkers(experiment_file, seeds, folder)
