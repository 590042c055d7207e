# loses: 4.3
# Runs the first seed and those after it, instead of the seeds given.
_replicate = run_replications


def run_replications(experiment_file, seeds, folder, steps=None):
    return _replicate(experiment_file, list(range(seeds[0], seeds[0] + len(seeds))), folder, steps)
